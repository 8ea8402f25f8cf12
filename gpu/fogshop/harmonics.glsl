// Light and reflectance in harmonics: Zhou et al. 2007, Eqs. 20 to 27 (methods/fogshop/surface_lighting.h). Needs `tables`.
#include "common/turn_harmonics.glsl"

uniform int cosine_at;                                       // bands of the clamped cosine
uniform int point_bands_at, point_depths;                    // g_l of a point light's PSF, [depth][l]; one depth: for all
uniform int environment_bands_at, environment_depths;        // of an environment's
uniform int environment_at;                                  // its radiance L_lm, rgb
uniform int average_at, average_nodes;                       // of average_depth
uniform float least_depth, greatest_depth;                   // of the bands, even in log T
#if TRANSFER
layout(std430, binding = 13) readonly buffer Transfer { float transfer[]; };  // SH_SIZE for every vertex
uniform int product_at;  // for every coefficient the first of its (i, j, integral of three), SH_SIZE + 1 of them, then these
#endif

// Turns g_l of a function about z into the factor of Y_lm of its axis: Eqs. 21 and 23.
float zonal_factor(int l) { return sqrt(4 * pi / float(2 * l + 1)); }

// B_pv in the world's axes. The place of the function.
int reflectance_harmonics(Material m, vec3 normal, vec3 to_view) {
  float cosine = dot(normal, to_view);
  if (!(cosine > 0)) {
    for (int i = 0; i < sh_order * sh_order; ++i) functions[i] = vec3(0);
  } else if (m.diffuse.w == 0) {
    evaluate_sh(normal);
    for (int l = 0; l < sh_order; ++l) {
      vec3 factor = m.diffuse.rgb / pi * (zonal_factor(l) * tables[cosine_at + l]);
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) functions[i] = factor * sh[i];
    }
  } else {
    vec3 aside = to_view - cosine * normal;
    float sine = length(aside);
    float place = min(angle_of(sine, cosine) / (0.5 * pi), 1.0) * float(m.places.y - 1);
    int entry = min(m.places.y - 2, int(place)), low = m.places.x + 3 * SH_SIZE * entry;
    for (int i = 0; i < sh_order * sh_order; ++i)
      functions[i] = mix(rgb_at(low + 3 * i), rgb_at(low + 3 * (SH_SIZE + i)), place - float(entry));
    // At the pole nothing depends on the azimuth.
    vec3 other = abs(normal.x) < 0.5 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    turn_harmonics(sine > 1e-6 ? aside / sine : normalize(cross(normal, other)), normal);
  }
  return 0;
}

#if TRANSFER
// The first function times V_p of a mesh; its inner side has none. The place of the product.
int shadow_harmonics(ivec4 corners, dvec3 point, dvec3 normal) {
  dvec3 p = mesh_vertex(corners.x) - point, q = mesh_vertex(corners.y) - point, r = mesh_vertex(corners.z) - point;
  dvec3 face = cross(q - p, r - p);
  if (!(dot(face, normal) > 0)) return 0;
  dvec3 areas = dvec3(dot(cross(q, r), face), dot(cross(r, p), face), dot(cross(p, q), face));
  vec3 weight = vec3(max(areas / dot(face, face), 0.0LF));
  weight /= weight.x + weight.y + weight.z;
  for (int i = 0; i < sh_order * sh_order; ++i)
    sh[i] = weight.x * transfer[corners.x * SH_SIZE + i] + weight.y * transfer[corners.y * SH_SIZE + i] +
            weight.z * transfer[corners.z * SH_SIZE + i];
  int terms_at = product_at + SH_SIZE + 1, k = 0;
  for (int n = 0; n < sh_order * sh_order; ++n) {
    vec3 sum = vec3(0);
    for (int end = int(tables[product_at + n + 1]); k < end; ++k) {
      int i = int(tables[terms_at + 3 * k]), j = int(tables[terms_at + 3 * k + 1]);
      vec3 both = sh[i] * functions[j];
      if (i != j) both += sh[j] * functions[i];
      sum += tables[terms_at + 3 * k + 2] * both;
    }
    functions[SH_SIZE + n] = sum;
  }
  return SH_SIZE;
}
#endif

// Where depths lie among those of the bands.
vec3 band_place(vec3 T, int depths) {
  return clamp(log(max(T, 1e-30) / least_depth) / log(greatest_depth / least_depth), 0, 1) * float(depths - 1);
}
// g_l at each channel's.
vec3 band(int at, int depths, int l, vec3 place) {
  if (depths == 1) return vec3(tables[at + l]);
  ivec3 k = min(ivec3(depths - 2), ivec3(place));
  vec3 g;
  for (int c = 0; c < 3; ++c) {
    float low = tables[at + k[c] * SH_ORDER + l];
    g[c] = low + (place[c] - float(k[c])) * (tables[at + (k[c] + 1) * SH_ORDER + l] - low);
  }
  return g;
}

// What the medium at depth T from a light scatters onto the surface, reflected, per unit of I/d^2 and albedo: Eq. 25.
vec3 reflect_point(int reflectance, vec3 to_light, vec3 T) {
  evaluate_sh(to_light);
  vec3 place = band_place(T, point_depths), sum = vec3(0);
  for (int l = 0; l < sh_order; ++l) {
    vec3 value = vec3(0);
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) value += sh[i] * functions[reflectance + i];
    sum += zonal_factor(l) * band(point_bands_at, point_depths, l, place) * value;
  }
  return sum * max(T, vec3(0)) * exp(-T);
}

// Depth of the Gaussians around a point, averaged over all directions: Eq. 26.
float average_depth(vec3 point) {
  const float end = 10;
  float sum = 0;
  for (int i = 0; i < gaussian_count; ++i) {
    Gaussian g = gaussians[i];
    float u = g.a * length(g.center - point), f;
    if (u >= end) {
      float w = 0.5 / (u * u);
      f = 0.25 * sqrt(pi) / (u * u) * (1 + w * (1 + w * (3 + w * (15 + w * 105))));
    } else {
      float place = u / end * float(average_nodes - 1);
      int k = min(int(place), average_nodes - 2), at = average_at + 2 * k;
      float s = place - float(k), r = 1 - s;
      f = r * r * (tables[at] * (1 + 2 * s) + tables[at + 1] * s) + s * s * (tables[at + 2] * (1 + 2 * r) - tables[at + 3] * r);
    }
    sum += g.half_depth * f;
  }
  return 2 / sqrt(pi) * sum;
}

// The environment's light that arrives and is reflected, and that which the medium scattered on the way (per unit of albedo):
// Eq. 27 for the average depth T.
void reflect_environment(int reflectance, vec3 T, out vec3 direct, out vec3 scattered) {
  vec3 place = band_place(T, environment_depths);
  direct = scattered = vec3(0);
  for (int l = 0; l < sh_order; ++l) {
    vec3 value = vec3(0);
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) value += rgb_at(environment_at + 3 * i) * functions[reflectance + i];
    direct += value;
    if (has_scattered != 0) scattered += zonal_factor(l) * band(environment_bands_at, environment_depths, l, place) * value;
  }
  direct = max(direct * exp(-T), vec3(0));
  scattered = max(scattered * max(T, vec3(0)) * exp(-T), vec3(0));
}
