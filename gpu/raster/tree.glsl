// A tree of boxes over all triangles of a scene, walked without a stack (gpu/raster/shadow_tree.h). Its places are floats, relative
// to its middle; what their rounding leaves open counts as met, and is decided elsewhere in doubles.
//
// Ten entries a node: lowest corner and highest corner of its box, 21 bits a coordinate; then for each octant of directions two
// ints: the child that comes first (or of a leaf -1 - (8 * first triangle + their number)), and the node that comes when this one,
// with all below it, is done with. Six entries a triangle: its corners, 4 floats each, the first with its number among all
// triangles. Doubles hold nothing but bits: llvmpipe fetches 64 as fast as 32.
layout(std430, binding = 14) readonly buffer Tree { double tree[]; };
uniform int tree_nodes;     // 0: there is no triangle
uniform int solid_count;    // of the scene, which are not in the tree
uniform dvec3 tree_middle;  // [m]
uniform float tree_reach;   // [m] greatest coordinate, from the middle
uniform vec3 tree_low;      // [m] where boxes are counted from
uniform float tree_cell;    // [m] their unit
#ifndef COUNT_NODE
#define COUNT_NODE
#endif

struct TreeRay {
  vec3 origin, inverse;  // from the middle [m]; 1 over the direction
  float rounding;        // more than that of places [m]
  int octant;            // bit a: towards lower coordinates
  ivec3 axis;            // z: the largest component of the direction; handedness kept
  vec2 shear;            // that turns the ray into that axis: Woop, Benthin and Wald 2013
};
// From `origin`, relative to the middle.
TreeRay tree_ray_of(vec3 origin, vec3 direction) {
  TreeRay ray;
  ray.origin = origin;
  ray.octant = 0;
  vec3 m = abs(origin), size = abs(direction);
  for (int a = 0; a < 3; ++a) {
    ray.inverse[a] = 1 / (size[a] < 1e-20 ? 1e-20 : direction[a]);
    if (ray.inverse[a] < 0) ray.octant |= 1 << a;
  }
  ray.rounding = 1e-6 * (max(m.x, max(m.y, m.z)) + tree_reach);
  int z = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  ray.axis = ivec3((z + 1) % 3, (z + 2) % 3, z);
  if (direction[z] < 0) ray.axis.xy = ray.axis.yx;
  ray.shear = vec2(direction[ray.axis.x], direction[ray.axis.y]) / direction[z];
  return ray;
}

vec3 box_corner(int place) {
  uvec2 bits = unpackDouble2x32(tree[place]);
  return tree_low + tree_cell * vec3(uvec3(bits.x, bits.x >> 21 | bits.y << 11, bits.y >> 10) & 0x1fffffu);
}
// Between the origin and `until` [m]?
bool meets_box(TreeRay ray, int node, float until) {
  vec3 s = (box_corner(10 * node) - ray.rounding - ray.origin) * ray.inverse,
       e = (box_corner(10 * node + 1) + ray.rounding - ray.origin) * ray.inverse;
  vec3 first = min(s, e), last = max(s, e);
  return max(max(first.x, first.y), max(first.z, 0)) <= min(min(last.x, last.y), min(last.z, until));
}

// Walks on from `node` to a leaf before node `last` that the ray meets before `until` [m]. Returns 8 * first triangle + their number,
// or 0 if there is no leaf among the next 16 nodes. Leaves are processed after this loop, not in it: llvmpipe runs through the body of
// a condition that no invocation meets. COUNT_NODE, if defined, is done about as often as a loop goes round.
int next_leaf(TreeRay ray, inout int node, int last, float until) {
  int leaf = 0;
  COUNT_NODE
  for (int n = 0; n < 16 && node < last && leaf == 0; ++n) {
    COUNT_NODE
    bool met = meets_box(ray, node, until);
    ivec2 next = ivec2(unpackDouble2x32(tree[10 * node + 2 + ray.octant]));
    if (met && next.x < 0) leaf = -1 - next.x;
    node = met && next.x >= 0 ? next.x : next.y;
  }
  return leaf;
}

// A corner of the triangle in a place of the leaves, from the ray's origin, turned: z along the ray.
vec3 corner_of(TreeRay ray, int place, int corner) {
  int at = 10 * tree_nodes + 6 * place + 2 * corner;
  vec3 v = vec3(uintBitsToFloat(unpackDouble2x32(tree[at])), uintBitsToFloat(unpackDouble2x32(tree[at + 1]).x)) - ray.origin;
  return vec3(v[ray.axis.x], v[ray.axis.y], v[ray.axis.z]);
}
int triangle_at(int place) { return int(unpackDouble2x32(tree[10 * tree_nodes + 6 * place + 1]).y); }
// Does the ray perhaps meet the triangle in a place of the leaves? Edge functions within their rounding count.
bool may_meet(TreeRay ray, int place) {
  vec3 a = corner_of(ray, place, 0), b = corner_of(ray, place, 1), c = corner_of(ray, place, 2);
  vec2 p = a.xy - ray.shear * a.z, q = b.xy - ray.shear * b.z, r = c.xy - ray.shear * c.z, m = max(max(abs(p), abs(q)), abs(r));
  float slack = ray.rounding * (4 * max(m.x, m.y) + 2 * ray.rounding);
  float u = q.x * r.y - q.y * r.x, v = r.x * p.y - r.y * p.x, w = p.x * q.y - p.y * q.x;
  return !(min(min(u, v), w) < -slack && max(max(u, v), w) > slack);
}
// By bits, those of the triangles of a leaf.
int may_be_met(TreeRay ray, int leaf) {
  int bits = 0;
  for (int i = 0; i < (leaf & 7); ++i)
    if (may_meet(ray, (leaf >> 3) + i)) bits |= 1 << i;
  return bits;
}
