// Is anything between a point and a light? Needs primitive_blocks.
#include "raster/tree.glsl"

bool tree_blocks(int own, dvec3 point, dvec3 to_light, double end) {
  for (int i = 0; i < solid_count; ++i)
    if (triangle_count + i != own && primitive_blocks(triangle_count + i, false, point, to_light, end)) return true;
  TreeRay ray = tree_ray_of(point, to_light);
  float until = float(end) * (1 + 1e-6);
  for (int node = 0; node < tree_nodes;) {
    bool met = meets_box(ray, node, until);
    int leaf = tree[4 * node + 1].w;
    if (met && leaf >= 0)
      for (int k = leaf >> 3; k < (leaf >> 3) + (leaf & 7); ++k) {
        int triangle = triangle_to_meet(ray, k);
        if (triangle >= 0 && triangle != own && primitive_blocks(triangle, false, point, to_light, end)) return true;
      }
    node = next_node(ray, node, leaf, met);
  }
  return false;
}
