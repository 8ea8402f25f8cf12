// Sorts silhouette edges into the sectors of a fan, one edge per invocation. FILL 0 counts those of every sector, FILL 1 writes
// them where fan_starts.comp has put its beginning.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "shadow_planes/edge.glsl"
#include "shadow_planes/fan.glsl"

layout(std430, binding = 0) readonly buffer Edges { Edge edges[]; };
layout(std430, binding = 1) buffer SectorCounts { int sector_count[]; };
layout(std430, binding = 3) readonly buffer Starts { int starts[]; };
layout(std430, binding = 4) writeonly buffer Lists { int lists[]; };
uniform int edge_count;

void main() {
  int e = int(gl_GlobalInvocationID.x);
  if (e >= edge_count) return;
  ivec3 range = sector_range(dvec3(edges[e].a[0], edges[e].a[1], edges[e].a[2]),
                             dvec3(edges[e].b[0], edges[e].b[1], edges[e].b[2]));
  int sectors = sectors_of(range.x);
  for (int s = range.y; s <= range.z; ++s) {
    int sector = first_sector(range.x) + (s + sectors) % sectors;
    int place = atomicAdd(sector_count[sector], 1);
#if FILL
    lists[starts[sector] + place] = e;
#endif
  }
}
