// Variant S, last pass: airlight of every ray from the depths of its slices and those from the lights at their edges
// (methods/fogshop/ray_airlight.cpp, slices.cpp). LIGHT_DEPTH, of the Gaussians: 0 none, 1 by maps, 2 by exact sums.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/tile.glsl"
#include "fogshop/ray_values.glsl"
#include "fogshop/light.glsl"
#include "fogshop/light_lookup.glsl"

uniform int extrapolate;

// The triangle from the light to both ends of the slices, in the slab and the half spaces of near_triangle
// (methods/fogshop/kernels.cpp). Where the light stands on the ray all normals are 0, and nothing is beyond.
struct Triangle {
  vec3 begin, end, light;  // corners [m]
  vec3 normal, beside_ray, beside_end, beside_begin;
};
Triangle triangle_of(vec3 begin, vec3 end, vec3 light, vec3 direction) {
  vec3 across = cross(direction, light - begin);
  float h = length(across);
  Triangle t = Triangle(begin, end, light, vec3(0), vec3(0), vec3(0), vec3(0));
  // Below this single precision does not know the plane.
  if (!(h > 1e-5 * (length(light - begin) + length(light - end)))) return t;
  t.normal = across / h;
  t.beside_ray = normalize(cross(end - begin, t.normal));
  t.beside_end = normalize(cross(light - end, t.normal));
  t.beside_begin = normalize(cross(begin - light, t.normal));
  return t;
}
bool is_near(Triangle t, Gaussian g) {
  float beyond = abs(dot(t.normal, g.center - t.begin));
  beyond = max(beyond, dot(t.beside_ray, g.center - t.begin));
  beyond = max(beyond, dot(t.beside_end, g.center - t.end));
  beyond = max(beyond, dot(t.beside_begin, g.center - t.light));
  return beyond * beyond <= g.radius_squared;
}

// Optical depth between the light and a point of the ray, of the Gaussians near the triangle.
float gaussian_depth(Triangle t, vec3 to) {
  float length_ = length(to - t.light), sum = 0;
  vec3 direction = length_ > 0 ? (to - t.light) / length_ : vec3(0, 0, 1);
  for (int i = 0; i < gaussian_count; ++i) {
    Gaussian g = gaussians[i];
    if (!is_near(t, g)) continue;
    Crossing c = cross_line(g, t.light, direction, length_);
    sum += depth_at(c, length_);  // whole: what lies beyond its radius counts, as on the CPU
  }
  return sum;
}

// Values where a slice begins or ends: the ray parameter [m], depths from there to the camera and to the light.
struct Edge {
  float t, depth, shadow;  // the depth of both ways with the constant; that of the Gaussians towards the light alone
};

// The angle of a slice, seen from the light that passes at h, and that times the mean of the phase function over it (Boole's rule).
struct Angle {
  float plain, weighted;
};
Angle angle_of_slice(LightFromRay seen, float h, float begin, float end) {
  float xa = begin - seen.along, xb = end - seen.along, beside = max(seen.h, least_h);
  float plain = angle_of(h * (end - begin), h * h + xa * xb);
  if (phase_g == 0) return Angle(plain, plain);
  vec2 a = normalize(vec2(xa, beside)), b = normalize(vec2(xb, beside)), middle = normalize(a + b);
  float ends = phase_of(a.x) + phase_of(b.x);
  float quarters = phase_of(normalize(a + middle).x) + phase_of(normalize(middle + b).x);
  return Angle(plain, plain * (7 * ends + 32 * quarters + 12 * phase_of(middle.x)) / 90);
}

// Light that a slice scatters, per channel; `scattered` is its optical depth, coloured.
vec3 light_of_slice(float angle, float h, Edge begin, Edge end, vec3 scattered) {
  float length_ = end.t - begin.t;
  if (!(length_ > 0)) return vec3(0);
  float mean_inverse_square = angle / (h * length_);
  vec3 e0 = exp(-extinction_ratio * begin.depth), q = extinction_ratio * (end.depth - begin.depth), mean;
  vec3 series = 1 + q * (-0.5 + q * (1.0 / 6 + q * (-1.0 / 24 + q / 120)));
  for (int c = 0; c < 3; ++c) mean[c] = abs(q[c]) < 0.1 ? e0[c] * series[c] : (e0[c] - exp(-extinction_ratio[c] * end.depth)) / q[c];
  return mean_inverse_square * extinction_ratio * scattered * mean;
}

vec3 scattered_by(int slice, int ray, float depth) {
#if COLOURED
  int at = scattering + 3 * slice;
  return vec3(ray_value[value_at(at, ray)], ray_value[value_at(at + 1, ray)], ray_value[value_at(at + 2, ray)]);
#else
  return vec3(depth);
#endif
}

void main() {
  ivec2 pixel = pixel_of_strip();
  if (near_count() < 0 || pixel.x >= grid_width) return;
  int ray = ray_of_strip();
  float lo = ray_value[value_at(slices_from, ray)], hi = ray_value[value_at(slices_to, ray)];
  if (!(lo < hi)) return;
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = ray_length(pixel), before = ray_value[value_at(slices, ray)];
  vec3 airlight = vec3(0);
  for (int l = 0; l < light_count; ++l) {
    Light light = lights[l];
    LightFromRay seen = light_from_ray(light, origin, direction);
#if LIGHT_DEPTH == 2
    Triangle triangle = triangle_of(origin + lo * direction, origin + hi * direction, light.position, direction);
#endif
    float h = max(length(vec2(seen.h, source_radius)), least_h), view_depth = before;
    vec3 sum = vec3(0), half_sum = vec3(0), pair_scattered = vec3(0);
    Edge last = Edge(0, 0, 0), pair = last;
    float pair_angle = 0, pair_phase = 0;
    for (int k = 0; k <= slice_count; ++k) {
      float t = ray_value[value_at(edges + k, ray)], depth = k > 0 ? ray_value[value_at(slices + k, ray)] : 0;
      view_depth += depth;
      vec3 x = origin + t * direction;
#if LIGHT_DEPTH == 0
      float shadow = 0;
#elif LIGHT_DEPTH == 1
      float shadow = light_depth(light, x);
#else
      float shadow = gaussian_depth(triangle, x);
#endif
      Edge here = Edge(t, view_depth + (shadow + constant * length(vec2(t - seen.along, seen.h))), shadow);
      if (k > 0) {
        vec3 scattered = scattered_by(k - 1, ray, depth);
        Angle angle = angle_of_slice(seen, h, last.t, here.t);
        sum += light_of_slice(angle.weighted, h, last, here, scattered);
        pair_scattered += scattered;
        pair_phase += angle.weighted;
        pair_angle += angle.plain;
      }
      if (extrapolate != 0 && k % 2 == 0) {  // light of two slices at a time
        if (k > 0) {
          float angle = angle_of_slice(seen, h, pair.t, here.t).plain;
          half_sum += light_of_slice(phase_g == 0 ? angle : angle * pair_phase / max(pair_angle, 1e-30), h, pair, here,
                                     pair_scattered);
        }
        pair = here;
        pair_scattered = vec3(0);
        pair_phase = pair_angle = 0;
      }
      last = here;
    }
    if (extrapolate != 0) sum = max(sum + (sum - half_sum) / 3, 0);
    sum /= 4 * pi;
    if (constant > 0 && hi < end)
      sum += exp(-extinction_ratio * (view_depth + last.shadow)) * homogeneous_airlight(LightFromRay(seen.along - hi, seen.h), end - hi);
    airlight += light.intensity * sum;
  }
  pixels[place_of(pixel)].rgb = airlight * albedo;
}
