// A tree of boxes over all triangles of a scene, walked without a stack (gpu/raster/shadow_tree.h). Its places are floats, relative
// to its middle; what their rounding leaves open counts as met, and is decided elsewhere in doubles.
//
// Four entries a node: lowest corner; highest corner and leaf (8 * first triangle + their number) or branch (-1 - (4 * second
// child + axis of the cut); the first child follows it); for each octant of directions the node that comes when this one, with all
// below it, is done with. Then three entries a triangle: corners, the first with its number among all triangles.
layout(std430, binding = 14) readonly buffer Tree { ivec4 tree[]; };
uniform int tree_nodes;     // 0: there is no triangle
uniform int solid_count;    // of the scene, which are not in the tree
uniform dvec3 tree_middle;  // [m]
uniform float tree_reach;   // [m] greatest coordinate, from the middle

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

// Between the origin and `until` [m]?
bool meets_box(TreeRay ray, int node, float until) {
  vec3 s = (intBitsToFloat(tree[4 * node].xyz) - ray.rounding - ray.origin) * ray.inverse,
       e = (intBitsToFloat(tree[4 * node + 1].xyz) + ray.rounding - ray.origin) * ray.inverse;
  vec3 first = min(s, e), last = max(s, e);
  return max(max(first.x, first.y), max(first.z, 0)) <= min(min(last.x, last.y), min(last.z, until));
}
// The node after this one, of which `leaf` is that entry; `below`: what is below it is wanted.
int next_node(TreeRay ray, int node, int leaf, bool below) {
  if (!below || leaf >= 0) return tree[4 * node + 2 + (ray.octant >> 2)][ray.octant & 3];
  int code = -1 - leaf;
  return (ray.octant >> (code & 3) & 1) != 0 ? code >> 2 : node + 1;
}

// The triangle in a place of the leaves if the ray may meet it, else -1: edge functions within their rounding count.
int triangle_to_meet(TreeRay ray, int place) {
  int at = 4 * tree_nodes + 3 * place;
  vec3 a = intBitsToFloat(tree[at].xyz) - ray.origin, b = intBitsToFloat(tree[at + 1].xyz) - ray.origin,
       c = intBitsToFloat(tree[at + 2].xyz) - ray.origin;
  int x = ray.axis.x, y = ray.axis.y, z = ray.axis.z;
  vec2 p = vec2(a[x], a[y]) - ray.shear * a[z], q = vec2(b[x], b[y]) - ray.shear * b[z],
       r = vec2(c[x], c[y]) - ray.shear * c[z], m = max(max(abs(p), abs(q)), abs(r));
  float slack = ray.rounding * (4 * max(m.x, m.y) + 2 * ray.rounding);
  float u = q.x * r.y - q.y * r.x, v = r.x * p.y - r.y * p.x, w = p.x * q.y - p.y * q.x;
  return min(min(u, v), w) < -slack && max(max(u, v), w) > slack ? -1 : tree[at].w;
}
