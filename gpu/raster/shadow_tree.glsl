// Is anything between a point and a light? A tree of boxes over all triangles without a stack (gpu/raster/occluders.h): boxes in
// single precision, widened by its rounding, triangles in double. Needs primitive_blocks.
layout(std430, binding = 14) readonly buffer ShadowTree { ivec4 shadow_tree[]; };  // two a node; then numbers of triangles
uniform int tree_nodes;     // 0: there is no triangle
uniform dvec3 tree_middle;  // [m] boxes are relative to it
uniform int solid_count;

int triangle_in_leaf(int k) { return shadow_tree[2 * tree_nodes + (k >> 2)][k & 3]; }

bool tree_blocks(int own, dvec3 point, dvec3 to_light, double end) {
  for (int i = 0; i < solid_count; ++i)
    if (triangle_count + i != own && primitive_blocks(triangle_count + i, false, point, to_light, end)) return true;
  vec3 origin = vec3(point - tree_middle), inverse;
  for (int a = 0; a < 3; ++a) inverse[a] = float(1 / (abs(to_light[a]) < 1e-20LF ? 1e-20LF : to_light[a]));
  vec3 m = abs(origin);
  float pad = 1e-6 * max(m.x, max(m.y, m.z)), until = float(end) * (1 + 1e-6);
  for (int i = 0; i < tree_nodes;) {
    ivec4 low = shadow_tree[2 * i], high = shadow_tree[2 * i + 1];
    vec3 s = (intBitsToFloat(low.xyz) - pad - origin) * inverse, e = (intBitsToFloat(high.xyz) + pad - origin) * inverse;
    vec3 first = min(s, e), last = max(s, e);
    float enter = max(max(first.x, first.y), max(first.z, 0)), leave = min(min(last.x, last.y), min(last.z, until));
    if (!(enter <= leave)) {
      i = low.w;
      continue;
    }
    int leaf = high.w;
    if (leaf >= 0)
      for (int k = leaf >> 3; k < (leaf >> 3) + (leaf & 7); ++k) {
        int triangle = triangle_in_leaf(k);
        if (triangle != own && primitive_blocks(triangle, false, point, to_light, end)) return true;
      }
    ++i;
  }
  return false;
}
