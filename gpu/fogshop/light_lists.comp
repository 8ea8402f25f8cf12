// Lists the Gaussians that rays from a light in or beside a cell of directions may meet, in their order. A cell is one work group, each
// invocation tests a stretch of the Gaussians. First the numbers alone, then (FILL) the lists from where they begin.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "fogshop/fog.glsl"
#include "fogshop/light.glsl"
#include "fogshop/cone.glsl"
#include "fogshop/light_cells.glsl"

layout(std430, binding = AT_LIGHT_LISTS) buffer LightLists { int light_list[]; };
const int group_size = int(LOCAL_SIZE_X);
#include "fogshop/ranks.glsl"

void main() {
  int cell = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x), local = int(gl_LocalInvocationIndex);
  if (cell >= light_count * cells * cells) return;
  vec2 corner = vec2(cell % cells, cell / cells % cells) * (2 / float(cells)) - 1;
  vec3 axis = direction_at(corner + 1 / float(cells));
  float spread = 0;
  for (int k = 0; k < 4; ++k) spread = max(spread, length(direction_at(corner + vec2(k & 1, k >> 1) * (2 / float(cells))) - axis));
  Cone cone = cone_of(lights[cell / (cells * cells)].position, axis, 0, spread + list_margin);

  int each = (gaussian_count + group_size - 1) / group_size;
  int begin = local * each, end = min(begin + each, gaussian_count), count = 0;
  for (int i = begin; i < end; ++i)
    if (touches(cone, gaussians[i], far_away)) ++count;
  int rank = rank_of(local, count);
#if FILL
  int at = light_list[cell] + rank;
  for (int i = begin; i < end; ++i)
    if (touches(cone, gaussians[i], far_away)) light_list[at++] = i;
#else
  if (local == group_size - 1) light_list[cell] = rank + count;
#endif
}
