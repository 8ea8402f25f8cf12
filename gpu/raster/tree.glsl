// A tree of boxes over all triangles of a scene, walked without a stack (gpu/raster/shadow_tree.h). Its places are floats, relative
// to its middle; what their rounding leaves open counts as met, and is decided elsewhere in doubles.
//
// Nodes are known by their first entries. Eleven entries a node: the lowest and the highest corner of its box, six floats; then for
// each octant of directions two ints: the child that comes first (or of a leaf -1 - (8 * first triangle + their number)), and the node
// that comes when this one, with all below it, is done with. Six entries a triangle: its corners, 4 floats each, the first with its
// number among all triangles. Doubles hold nothing but bits: llvmpipe fetches 64 as fast as 32.
layout(std430, binding = 14) readonly buffer Tree { double tree[]; };
const int NODE_ENTRIES = 11;
uniform int tree_end;       // entries of all nodes; 0: there is no triangle
uniform int solid_count;    // of the scene, which are not in the tree
uniform dvec3 tree_middle;  // [m]
uniform float tree_reach;   // [m] greatest coordinate, from the middle
#ifndef COUNT_NODE
#define COUNT_NODE
#endif

struct TreeRay {
  vec3 origin, inverse;  // from the middle [m]; 1 over the direction
  vec3 before, behind;   // where 0 of each axis is on the ray, less and more the rounding [m]
  float rounding;        // more than that of places [m]
  int octant;            // bit a: towards lower coordinates
  ivec3 axis;            // z: the largest component of the direction; handedness kept
  vec2 shear;            // that turns the ray into that axis: Woop, Benthin and Wald 2013
  vec3 across, upwards;  // rows of this shear
  vec2 beside;           // the origin, sheared
};
// From `origin`, relative to the middle.
TreeRay tree_ray_of(vec3 origin, vec3 direction) {
  TreeRay ray;
  ray.origin = origin;
  vec3 m = abs(origin), size = abs(direction);
  ray.inverse = 1 / mix(direction, vec3(1e-20), lessThan(size, vec3(1e-20)));
  ray.octant = int(ray.inverse.x < 0) | int(ray.inverse.y < 0) << 1 | int(ray.inverse.z < 0) << 2;
  ray.rounding = 1e-6 * (max(m.x, max(m.y, m.z)) + tree_reach);
  ray.before = (-ray.rounding - origin) * ray.inverse;
  ray.behind = (ray.rounding - origin) * ray.inverse;
  int z = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  ray.axis = ivec3((z + 1) % 3, (z + 2) % 3, z);
  if (direction[z] < 0) ray.axis.xy = ray.axis.yx;
  ray.shear = vec2(direction[ray.axis.x], direction[ray.axis.y]) / direction[z];
  const ivec3 axes = ivec3(0, 1, 2);
  vec3 along = vec3(equal(axes, ivec3(z)));
  ray.across = vec3(equal(axes, ivec3(ray.axis.x))) - ray.shear.x * along;
  ray.upwards = vec3(equal(axes, ivec3(ray.axis.y))) - ray.shear.y * along;
  ray.beside = vec2(dot(ray.across, origin), dot(ray.upwards, origin));
  return ray;
}

vec2 floats_of(int place) { return uintBitsToFloat(unpackDouble2x32(tree[place])); }
// Between the origin and `until` [m]?
bool meets_box(TreeRay ray, int node, float until) {
  vec2 a = floats_of(node), b = floats_of(node + 1), c = floats_of(node + 2);
  vec3 s = vec3(a, b.x) * ray.inverse + ray.before, e = vec3(b.y, c) * ray.inverse + ray.behind;
  vec3 first = min(s, e), last = max(s, e);
  return max(max(first.x, first.y), max(first.z, 0)) <= min(min(last.x, last.y), min(last.z, until));
}

// Walks on from `node` to a leaf before node `last` that the ray meets before `until` [m]. Returns 8 * first triangle + their number,
// or 0 if there is no leaf among the next 16 nodes. Leaves are processed after this loop, not in it: llvmpipe runs through the body of
// a condition that no invocation meets. COUNT_NODE, if defined, is done about as often as a loop goes round.
int next_leaf(TreeRay ray, inout int node, int last, float until) {
  int found = 0;  // -1 - leaf
  COUNT_NODE
  for (int n = 0; n < 16 && node < last && found == 0; ++n) {
    COUNT_NODE
    ivec2 next = ivec2(unpackDouble2x32(tree[node + 3 + ray.octant]));
    int to = meets_box(ray, node, until) ? next.x : next.y;
    found = min(found, to);
    node = to < 0 ? next.y : to;
  }
  return found < 0 ? -1 - found : 0;
}

// A corner of the triangle in a place of the leaves, from the middle.
vec3 corner_at(int place, int corner) {
  int at = tree_end + 6 * place + 2 * corner;
  return vec3(floats_of(at), floats_of(at + 1).x);
}
// From the ray's origin, turned: z along the ray.
vec3 corner_of(TreeRay ray, int place, int corner) {
  vec3 v = corner_at(place, corner) - ray.origin;
  return vec3(v[ray.axis.x], v[ray.axis.y], v[ray.axis.z]);
}
// Sheared, so that the ray is at 0. Its rounding is less than half of `rounding`.
vec2 corner_beside(TreeRay ray, int place, int corner) {
  vec3 v = corner_at(place, corner);
  return vec2(dot(ray.across, v), dot(ray.upwards, v)) - ray.beside;
}
int triangle_at(int place) { return int(unpackDouble2x32(tree[tree_end + 6 * place + 1]).y); }
// Does the ray perhaps meet the triangle in a place of the leaves? Edge functions within their rounding count.
bool may_meet(TreeRay ray, int place) {
  vec2 p = corner_beside(ray, place, 0), q = corner_beside(ray, place, 1), r = corner_beside(ray, place, 2),
       m = max(max(abs(p), abs(q)), abs(r));
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
