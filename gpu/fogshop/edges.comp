// Variant S, third pass: the edges of the slices, where the shares of the nodes reach equal steps.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "fogshop/pixels.glsl"
uniform int gaussian_count;
#include "fogshop/tile.glsl"
#include "fogshop/ray_values.glsl"

void main() {
  ivec2 pixel = pixel_of_strip();
  if (near_count() < 0 || pixel.x >= grid_width) return;
  int ray = ray_of_strip();
  float lo = ray_value[value_at(slices_from, ray)], hi = ray_value[value_at(slices_to, ray)];
  if (!(lo < hi)) return;
  float node0 = lo, node1 = ray_value[value_at(nodes + 1, ray)];
  float share0 = ray_value[value_at(shares, ray)], share1 = ray_value[value_at(shares + 1, ray)];
  float first = share0, total = ray_value[value_at(shares + node_count - 1, ray)] - first;
  ray_value[value_at(edges, ray)] = lo;
  int at = 1;
  for (int i = 1; i < slice_count; ++i) {
    float wanted = first + total * float(i) / float(slice_count);
    while (at + 1 < node_count && share1 < wanted) {
      ++at;
      node0 = node1, share0 = share1;
      node1 = ray_value[value_at(nodes + at, ray)], share1 = ray_value[value_at(shares + at, ray)];
    }
    float s = share1 > share0 ? clamp((wanted - share0) / (share1 - share0), 0, 1) : 0;
    ray_value[value_at(edges + i, ray)] = node0 + s * (node1 - node0);
  }
  ray_value[value_at(edges + slice_count, ray)] = hi;
}
