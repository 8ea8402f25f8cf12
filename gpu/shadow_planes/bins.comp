// Which silhouette edges the rays of a block of pixels may cross: methods/shadow_planes/tile_edges.h. A work group does one
// block; candidates are all edges, or those of the greater block around it (PARENT > 0: how many times greater). Lists are
// written where there is room; the space that all would need comes back.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "raster/view.glsl"
#include "shadow_planes/edge.glsl"

layout(std430, binding = 0) readonly buffer Edges { Edge edges[]; };
layout(std430, binding = 1) readonly buffer ParentRanges { ivec2 parent_ranges[]; };  // first, count
layout(std430, binding = 2) readonly buffer ParentLists { int parent_lists[]; };
layout(std430, binding = 3) writeonly buffer Ranges { ivec2 ranges[]; };
layout(std430, binding = 4) writeonly buffer Lists { int lists[]; };
layout(std430, binding = 6) buffer Needed { int needed; };
uniform int edge_count, columns, block_side, list_room;
uniform dvec3 light;  // [m]

shared vec3 normals[4];  // of the planes through the light and the rays of the corners
shared int found, first;

void main() {
  ivec2 at = ivec2(gl_WorkGroupID.xy);
  int block = at.y * columns + at.x, thread = int(gl_LocalInvocationID.x);
  if (thread < 4) {
    ivec2 corner = min(ivec2(view_width, view_height), block_side * (at + ivec2(thread & 1, thread >> 1)));
    dvec3 origin, direction;
    view_ray(dvec2(corner), origin, direction);
    dvec3 side = cross(direction, light - origin);
    normals[thread] = vec3(side / max(length(side), 1e-300LF));
  }
  if (thread == 0) found = 0;
  barrier();
  ivec2 candidates = ivec2(0, edge_count);
#if PARENT
  int parent_columns = (columns + PARENT - 1) / PARENT;
  candidates = parent_ranges[(at.y / PARENT) * parent_columns + at.x / PARENT];
#endif
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = thread; i < candidates.y; i += LOCAL_SIZE_X) {
#if PARENT
      int e = parent_lists[candidates.x + i];
#else
      int e = i;
#endif
      vec4 a = edges[e].near_a, b = edges[e].near_b;
      float slack = 1e-6 * max(a.w, b.w);
      int above = 0, below = 0;
      for (int k = 0; k < 4; ++k) {
        float sa = dot(normals[k], a.xyz), sb = dot(normals[k], b.xyz);
        above += int(sa > slack && sb > slack);
        below += int(sa < -slack && sb < -slack);
      }
      if (above == 4 || below == 4) continue;
      int place = atomicAdd(found, 1);
      if (pass == 1 && first + place < list_room) lists[first + place] = e;
    }
    barrier();
    if (thread == 0 && pass == 0) {
      first = atomicAdd(needed, found);
      ranges[block] = ivec2(first, found);
      found = 0;
    }
    barrier();
  }
}
