// Reflectances, and what they make of light that the medium scatters onto a surface (methods/fogshop/scattered_reflection.cpp;
// Zhou et al. 2007, Eqs. 20 to 25).
struct Material {
  vec4 diffuse;   // albedo of Lambert; w: 0 Lambert, 1 Phong
  vec4 specular;  // w: exponent
};
layout(std430, binding = 2) readonly buffer Materials { Material materials[]; };  // by surface
// Quadrature over cosines (nodes, weights), bands of the clamped cosine, then sh_order bands of the NPSF for each depth.
layout(std430, binding = 9) readonly buffer Harmonics { float harmonics[]; };
uniform int sh_order, depth_entries;        // entries even in log T; one: for every depth
uniform float least_depth, greatest_depth;  // of the first and the last

const int cosines = 16, around = 32, most_bands = 12;
const int first_band = 2 * cosines + most_bands;

vec3 brdf(Material m, vec3 normal, vec3 to_light, vec3 to_view) {
  if (!(dot(normal, to_light) > 0) || !(dot(normal, to_view) > 0)) return vec3(0);
  if (m.diffuse.w == 0) return m.diffuse.rgb / pi;
  vec3 mirrored = 2 * dot(normal, to_light) * normal - to_light;
  float cosine = max(0.0, dot(mirrored, to_view)), n = m.specular.w;
  float power = n == 0 ? 1.0 : (cosine > 0 ? pow(cosine, n) : 0.0);
  return m.diffuse.rgb / pi + m.specular.rgb * ((n + 2) / (2 * pi) * power);
}

// sum_l weights_l P_l(x), per channel.
vec3 legendre_sum(vec3 weights[most_bands], float x) {
  float before = 1, value = x;
  vec3 sum = weights[0];
  for (int l = 1; l < sh_order; ++l) {
    sum += weights[l] * value;
    float next = (float(2 * l + 1) * x * value - float(l) * before) / float(l + 1);
    before = value;
    value = next;
  }
  return sum;
}

// g_l at the depth of each channel.
vec3 band(int l, vec3 T) {
  if (depth_entries == 1) return vec3(harmonics[first_band + l]);
  vec3 g;
  for (int c = 0; c < 3; ++c) {
    float place = clamp(log(T[c] / least_depth) / log(greatest_depth / least_depth), 0.0, 1.0) * float(depth_entries - 1);
    int k = min(depth_entries - 2, int(place)), at = first_band + k * sh_order + l;
    g[c] = mix(harmonics[at], harmonics[at + sh_order], place - float(k));
  }
  return g;
}

// The reflected part of what the medium at depth T from the light scatters onto the surface, per unit of I/d^2, without its
// albedo. A channel of depth 0 gets none.
vec3 scattered_reflection(Material m, dvec3 exact_normal, vec3 to_view, vec3 to_light, vec3 T) {
  vec3 normal = vec3(exact_normal), weights[most_bands], amount = max(T, vec3(0)) * exp(-T), sum = vec3(0);
  for (int l = 0; l < sh_order; ++l) weights[l] = band(l, max(T, vec3(1e-30)));
  if (m.diffuse.w == 0) {
    if (!(dot(normal, to_view) > 0)) return vec3(0);
    for (int l = 0; l < sh_order; ++l) weights[l] *= harmonics[2 * cosines + l];
    return m.diffuse.rgb * amount * legendre_sum(weights, dot(normal, to_light)) / pi;
  }
  for (int l = 0; l < sh_order; ++l) weights[l] *= sqrt(float(2 * l + 1) / (4 * pi));
  // The same frame as the CPU's (Eigen's unitOrthogonal): its directions are the same.
  dvec3 e = exact_normal;
  bool up = abs(e.x) <= 1e-12LF * abs(e.z) && abs(e.y) <= 1e-12LF * abs(e.z);
  vec3 a = vec3(normalize(up ? dvec3(0, -e.z, e.y) : dvec3(-e.y, e.x, 0))), b = cross(normal, a);
  for (int i = 0; i < cosines; ++i) {
    float c = harmonics[i], s = sqrt((1 - c) * (1 + c));
    vec3 ring = vec3(0);
    for (int k = 0; k < around; ++k) {
      float phi = 2 * pi * (float(k) + 0.5) / float(around);
      vec3 from = c * normal + s * (cos(phi) * a + sin(phi) * b);
      ring += brdf(m, normal, from, to_view) * legendre_sum(weights, dot(from, to_light));
    }
    sum += harmonics[cosines + i] * (2 * pi / float(around)) * c * ring;
  }
  return sum * amount;
}
