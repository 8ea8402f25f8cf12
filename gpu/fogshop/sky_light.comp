// environment_airlight = volume: light of the environment that the Gaussians scatter towards the eye, added to every pixel of
// a strip (RayAirlight::sky of methods/fogshop). One tile is one work group.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/near.glsl"
#include "fogshop/noise.glsl"
#include "fogshop/sky_volume.glsl"

// J, trilinear; beyond the grid that of its nearest point.
vec3 sky_at(vec3 x) {
  vec3 place = clamp((x - grid_corner) / grid_cell, vec3(0), grid_last);
  ivec3 low = min(ivec3(place), ivec3(grid_last) - 1);
  vec3 s = place - vec3(low), sum = vec3(0);
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 offset = ivec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    vec3 w = mix(1 - s, s, vec3(offset));
    int at = node_place(low + offset);
    sum += w.x * w.y * w.z * vec3(node_light[at], node_light[at + 1], node_light[at + 2]);
  }
  return sum;
}

// 1 - e^-q of every channel, where it is small too.
vec3 opacity_of(vec3 q) {
  vec3 series = q * (1 + q * (-0.5 + q * (1.0 / 6 + q * (-1.0 / 24 + q / 120))));
  return mix(1 - exp(-q), series, lessThan(q, vec3(0.1)));
}

// Eight at a time, as slices.comp; slices beyond the last are empty.
#define EIGHT_FROM(k, DO) DO(k) DO(k + 1) DO(k + 2) DO(k + 3) DO(k + 4) DO(k + 5) DO(k + 6) DO(k + 7)
const int slice_space = (K + 7) / 8 * 8;
float slice_depth[slice_space];

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, tile_row * int(LOCAL_SIZE_Y));
  bool visible = is_computed(pixel);  // the others still help to load
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = visible ? ray_length(pixel) : far_away;
  int count = near_count();
  if (count < 0) return;  // the whole tile

  float lo = far_away, hi = -far_away;
  for (int first = 0; first < count; first += group_size) {
    int loaded = load_near(first, count);
    for (int i = 0; i < loaded; ++i) {
      Crossing c = cross_view(near_block[i], origin, direction, end);
      if (!c.met) continue;
      lo = min(lo, c.middle - c.chord);
      hi = max(hi, c.middle + c.chord);
    }
  }
  lo = max(lo, 0);
  hi = min(hi, end);
  bool sliced = visible && lo < hi;
  if (!sliced) lo = 0, hi = 1;  // the loads below are for all

  // Slices of equal length: their depths, and that before the first.
  float step_ = (hi - lo) / float(K), depth = 0;
  for (int k = 0; k < slice_space; ++k) slice_depth[k] = 0;
  for (int first = 0; first < count; first += group_size) {
    int loaded = load_near(first, count);
    for (int i = 0; i < loaded; ++i) {
      Crossing c = cross_view(near_block[i], origin, direction, end);
      if (!c.met) continue;
      Place begin = place_at(c, lo), next;
      depth += c.depth * erf_between(c.start, begin);
#define ADD_DEPTH(k)                                              \
  next = place_at(c, (k) + 1 < K ? lo + step_ * float((k) + 1) : hi); \
  slice_depth[k] += c.depth * erf_between(begin, next);           \
  begin = next;
      for (int k = 0; k < K; k += 8) { EIGHT_FROM(k, ADD_DEPTH) }
    }
  }
  if (!sliced) return;
  vec3 sum = vec3(0);
  for (int k = 0; k < K; ++k) {
    vec3 x = origin + (lo + step_ * (float(k) + 0.5)) * direction;
    sum += sky_at(x) * exp(-hue * depth) * opacity_of(hue * slice_depth[k]);
    depth += slice_depth[k];
  }
  pixels[place_of(pixel)].rgb += sum * albedo;
}
