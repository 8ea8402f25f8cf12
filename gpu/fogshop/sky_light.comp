// environment_airlight = volume: light of the environment that the Gaussians scatter towards the eye, added to every pixel of
// a strip (RayAirlight::sky of methods/fogshop), from the depths of slices of equal length.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/tile.glsl"
#include "fogshop/ray_values.glsl"
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

void main() {
  ivec2 pixel = pixel_of_strip();
  if (near_count() < 0 || pixel.x >= grid_width) return;
  int ray = ray_of_strip();
  float lo = ray_value[value_at(reach_from, ray)], hi = ray_value[value_at(reach_to, ray)];
  if (!(lo < hi)) return;
  vec3 origin, direction, sum = vec3(0);
  camera_ray(film_position(pixel), origin, direction);
  float step_ = (hi - lo) / float(slice_count), before = ray_value[value_at(slices, ray)];
  for (int k = 0; k < slice_count; ++k) {
    vec3 x = origin + (lo + step_ * (float(k) + 0.5)) * direction;
    float depth = ray_value[value_at(slices + 1 + k, ray)];
    sum += sky_at(x) * exp(-extinction_ratio * before) * opacity_of(extinction_ratio * depth);
    before += depth;
  }
  pixels[place_of(pixel)].rgb += sum * albedo;
}
