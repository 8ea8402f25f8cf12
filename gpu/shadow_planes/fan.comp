// Sorts silhouette edges into the sectors of a fan, one edge per invocation. FILL 0 counts those of every sector; FILL 1 writes
// them where fan_starts.comp has put its list, and counts back to 0, where the next sorting begins.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "shadow_planes/edge.glsl"
#include "shadow_planes/fan.glsl"
#include "shadow_planes/light_state.glsl"

layout(std430, binding = AT_EDGES) readonly buffer Edges { Edge edges[]; };
layout(std430, binding = AT_SECTORS) buffer Sectors { int listed, sector_count[]; };
layout(std430, binding = AT_LISTS) buffer Lists {
  ivec2 sector_list[FAN_SECTORS];
  int lists[];
};

void main() {
  int e = int(gl_GlobalInvocationID.x);
  if (e >= edge_count) return;
  ivec3 range = sector_range(dvec3(edges[e].a[0], edges[e].a[1], edges[e].a[2]),
                             dvec3(edges[e].b[0], edges[e].b[1], edges[e].b[2]));
  int sectors = sectors_of(range.x);
  for (int s = range.y; s <= range.z; ++s) {
    int sector = first_sector(range.x) + (s + sectors) % sectors;
#if FILL
    lists[sector_list[sector].x + atomicAdd(sector_count[sector], -1) - 1] = e;
#else
    atomicAdd(sector_count[sector], 1);
#endif
  }
#if FILL
  if (e == 0) listed = 0;
#endif
}
