// The ends of the rays of a view, one invocation per ray (gpu/raster/first_hits.h).
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "raster/triangles.glsl"
#include "raster/solids.glsl"
#include "raster/tree.glsl"

layout(std430, binding = 0) buffer Distances { float distances[]; };
layout(std430, binding = 1) writeonly buffer Primitives { int primitives[]; };
uniform int columns, rows, first_ray, keeps_primitives;
uniform double cell_width, cell_height;  // [pixels]
uniform int cut;                         // 1: cells end at the film's edge
uniform double cell_x, cell_y;           // where rays go through, from 0 to 1 of a cell
#if RESUMES
// Groups of each dispatch; then of each ray its next node and what it has met so far.
layout(std430, binding = 2) buffer Unfinished { int unfinished[]; };
uniform int dispatch, dispatches, leaves_at_once;
#endif
uniform int triangle_count, ball_count;  // balls of lights come behind the other solids

struct First {
  float t;  // [m]
  int primitive;
};

int order_of(int primitive) {
  int surface = primitive < triangle_count ? triangles[primitive].w : solids[primitive - triangle_count].surface;
  return surface < 0 ? 0x7fffffff : surface;
}
void keep_nearer(inout First best, double t, int primitive) {
  float rounded = float(min(t, 1e37LF));
  if (!(t > 0) || !(rounded <= best.t)) return;
  if (rounded == best.t) {
    if (best.primitive < 0) return;
    int mine = order_of(primitive), other = order_of(best.primitive);
    if (mine > other || (mine == other && primitive > best.primitive)) return;
  }
  best = First(rounded, primitive);
}

// Twice the area of (0, p, q). `side` is its sign; a tie is broken by moving the origin by (e, e^2), e -> 0. The triangles at an edge
// must get values of equal size and opposite sign, therefore the products are computed exactly as written.
double edge(dvec3 p, dvec3 q, out int side) {
  precise double left = p.x * q.y, right = p.y * q.x;
  precise double value = left - right;
  side = value > 0 ? 1 : -1;
  if (value == 0) {
    side = p.y != q.y ? (p.y > q.y ? 1 : -1) : int(q.x > p.x) - int(q.x < p.x);
  }
  return value;
}
// A vertex from the ray's origin, which has its coordinates in the order of `axis` already.
dvec3 sheared(ivec3 axis, dvec3 shear, dvec3 origin, int vertex) {
  ivec3 at = 3 * vertex + axis;
  dvec3 v = dvec3(vertex_coordinate[at.x], vertex_coordinate[at.y], vertex_coordinate[at.z]) - origin;
  precise dvec3 result = dvec3(v.xy - shear.xy * v.z, shear.z * v.z);
  return result;
}
// scene/geometry/ray_primitive.cpp; 0: it is not met.
double meet_triangle(int triangle, ivec3 axis, dvec3 shear, dvec3 origin) {
  ivec4 corners = triangles[triangle];
  dvec3 p = sheared(axis, shear, origin, corners.x), q = sheared(axis, shear, origin, corners.y),
        r = sheared(axis, shear, origin, corners.z);
  int side_u, side_v, side_w;
  double u = edge(q, r, side_u), v = edge(r, p, side_v), w = edge(p, q, side_w), whole = u + v + w;
  double t = 0;
  if (side_u != 0 && side_u == side_v && side_u == side_w && whole != 0) {
    t = p.z + (v * (q.z - p.z) + w * (r.z - p.z)) / whole;
  }
  return t;
}

void main() {
  int i = int(gl_LocalInvocationIndex);  // neighbours side by side: 8 are 4 x 2, 32 are 8 x 4
  ivec2 at = 8 * ivec2(gl_WorkGroupID.xy) + ivec2(i & 3 | i >> 1 & 4, i >> 2 & 1 | i >> 3 & 6);
  if (at.x >= columns || at.y >= rows) return;
  dvec3 origin, direction, normal;
  dvec2 cell = dvec2(cell_width, cell_height), begin = cell * dvec2(at);
  if (cut != 0) cell = min(cell, dvec2(view_width, view_height) - begin);
  view_ray(begin + dvec2(cell_x, cell_y) * cell, origin, direction);
  int place = at.y * columns + at.x, node = 0;
  First best = First(1e37, -1);
#if RESUMES
  int kept = 3 * dispatches + 2 * place;
  if (dispatch > 0) {
    node = unfinished[kept];
    best = First(distances[first_ray + place], unfinished[kept + 1]);
  }
#endif
  if (node == 0)
    for (int i = 0; i < solid_count + ball_count; ++i)
      keep_nearer(best, meet_solid(solids[i], origin, direction, normal), triangle_count + i);

  TreeRay ray = tree_ray_of(vec3(origin - tree_middle), vec3(direction));
  dvec3 turned_origin = dvec3(origin[ray.axis.x], origin[ray.axis.y], origin[ray.axis.z]);
  dvec3 shear = dvec3(direction[ray.axis.x], direction[ray.axis.y], 1) / direction[ray.axis.z];
#if RESUMES
  for (int leaves = 0; leaves < leaves_at_once && node < tree_end; ++leaves) {
#else
  while (node < tree_end) {
#endif
    int leaf = next_leaf(ray, node, tree_end, best.t * (1 + 1e-6));
    for (int bits = may_be_met(ray, leaf); bits != 0; bits &= bits - 1) {
      int triangle = triangle_at((leaf >> 3) + findLSB(bits));
      keep_nearer(best, meet_triangle(triangle, ray.axis, shear, turned_origin), triangle);
    }
  }
#if RESUMES
  unfinished[kept] = node;
  unfinished[kept + 1] = best.primitive;
  if (node < tree_end && dispatch + 1 < dispatches)
    for (int a = 0; a < 3; ++a) unfinished[3 * (dispatch + 1) + a] = int(gl_NumWorkGroups[a]);
#endif
  distances[first_ray + place] = best.t;
  if (keeps_primitives != 0) primitives[first_ray + place] = best.primitive;
}
