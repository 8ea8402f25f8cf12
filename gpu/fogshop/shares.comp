// Variant S, second pass: how many of the slices end before each node, as the sum of three equal parts: even in length, even in angle
// for each light, even over the boxes of the Gaussians. An invocation does the nodes of a ray in blocks of eight.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "common/opacity.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/near.glsl"
#include "fogshop/ray_values.glsl"
#include "fogshop/noise.glsl"
#include "fogshop/light.glsl"

uniform int boxes;
#define EACH_BLOCK(DO) DO(0) DO(1) DO(2) DO(3)
#define EACH_OF_EIGHT(b, DO) \
  DO(8 * b) DO(8 * b + 1) DO(8 * b + 2) DO(8 * b + 3) DO(8 * b + 4) DO(8 * b + 5) DO(8 * b + 6) DO(8 * b + 7)
const int nodes_each = 32;  // as gpu/fogshop/airlight_pass.cpp

void main() {
  ivec2 pixel = pixel_of_strip();
  int count = near_count();
  if (count < 0) return;
  int ray = ray_of_strip(), first_node = nodes_each * int(gl_WorkGroupID.z);
  bool wanted = pixel.x < grid_width;
  float lo = wanted ? ray_value[value_at(slices_from, ray)] : 0, hi = wanted ? ray_value[value_at(slices_to, ray)] : 0;
  wanted = lo < hi;
  float taken = wanted ? ray_value[value_at(opacity_sum, ray)] : 0;
  bool boxed = boxes != 0 && taken > 0;
  if (!any_of_group(boxed)) count = 0;
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = wanted ? ray_length(pixel) : 0, parts = boxed ? 3 : 2;

  float node[nodes_each], share[nodes_each], whole[nodes_each / 8];  // the last of the boxes that end before a block
  for (int k = 0; k < nodes_each; ++k) {
    node[k] = wanted ? ray_value[value_at(nodes + min(first_node + k, node_count - 1), ray)] : 0;
    share[k] = wanted ? (node[k] - lo) / ((hi - lo) * parts) : 0;
  }
#define NONE(b) whole[b] = 0;
  EACH_BLOCK(NONE)
  for (int l = 0; l < light_count; ++l) {
    LightFromRay seen = light_from_ray(lights[l], origin, direction);
    float h = max(seen.h, least_h), xa = lo - seen.along, xb = hi - seen.along;
    float span = angle_of(h * (hi - lo), h * h + xa * xb);
    if (!(span > 0)) continue;
    for (int k = 0; k < nodes_each; ++k)  // the angle from `lo`, without cancelling
      share[k] += angle_of(h * (node[k] - lo), h * h + xa * (node[k] - seen.along)) / (span * parts * float(light_count));
  }
  for (int first = 0; first < count; first += group_size) {
    int loaded = load_near(first, count);
    for (int i = 0; i < loaded; ++i) {
      Gaussian g = near_block[i];
      Crossing c = cross_geometry(g, origin, direction, end);
      // Half a box is 1.6 widths.
      float slope = c.a / 3.2, offset = 0.5 - c.middle * slope;
      if (!boxed || !c.met || node[nodes_each - 1] * slope + offset <= 0) continue;
      add_view_depth(g, origin, direction, end, c);
      float weight = opacity(2 * c.depth) / (parts * taken);
#define ADD_SHARE(k) share[k] += weight * clamp(node[k] * slope + offset, 0, 1);
#define ADD_BLOCK(b)                                                                          \
  if (node[8 * b] * slope + offset >= 1) {                                                    \
    whole[b] += weight;                                                                       \
  } else if (node[8 * b + 7] * slope + offset > 0) {                                          \
    EACH_OF_EIGHT(b, ADD_SHARE)                                                               \
  }
      EACH_BLOCK(ADD_BLOCK)
    }
  }
  if (!wanted) return;
#define WRITE(k) \
  if (first_node + k < node_count) ray_value[value_at(shares + first_node + k, ray)] = share[k] + whole[(k) / 8];
  EACH_OF_EIGHT(0, WRITE) EACH_OF_EIGHT(1, WRITE) EACH_OF_EIGHT(2, WRITE) EACH_OF_EIGHT(3, WRITE)
}
