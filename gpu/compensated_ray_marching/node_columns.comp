// Columns of the smoke from the nodes towards a directional light: LitGrid::add_depths. A work group has a block of cells; of the Gaussians
// those are looked at that reach into the cylinder of its rays.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y, local_size_z = LOCAL_SIZE_Z) in;
#include "compensated_ray_marching/smoke_density.glsl"
#include "compensated_ray_marching/smoke_column.glsl"
layout(std430, binding = AT_NODE_OF_CELL) readonly buffer NodeOfCell { int node_of[]; };        // -1: no smoke there
layout(std430, binding = AT_FOUND_COLUMNS) writeonly buffer FoundColumns { float columns[]; };  // [direction][node, m]; 1e37: blocked
layout(std430, binding = AT_HIDDEN_NODES) readonly buffer HiddenNodes { uint hidden[]; };       // a bit a node
uniform int node_count, direction, has_objects;
uniform vec3 corner;  // of the grid of nodes, relative to the middle of the smoke [m]
uniform float cell_edge;
uniform vec3 cells_along;  // each axis
shared uint any_node;

#if GAUSSIANS
#define lane int(gl_LocalInvocationIndex)
const int lanes = LOCAL_SIZE_X * LOCAL_SIZE_Y * LOCAL_SIZE_Z, words = 32;
shared uint met[words];  // of 32 words of Gaussians, a bit each

float column_past_group(vec3 place, bool wanted) {
  // Not gl_WorkGroupSize: as a factor of a vector of floats it makes NVIDIA's compiler (driver 580) crash.
  const vec3 group_size = vec3(LOCAL_SIZE_X, LOCAL_SIZE_Y, LOCAL_SIZE_Z);
  vec3 middle_ = corner + cell_edge * (vec3(gl_WorkGroupID) + 0.5) * group_size;
  vec2 region = region_part(place, to_light);
  float sum = 0, spread = 0.5001 * cell_edge * length(group_size - 1);
  for (int first = 0; first < gaussian_count; first += 32 * words) {
    barrier();
    if (lane < words) met[lane] = 0u;
    barrier();
    for (int k = lane; k < 32 * words && first + k < gaussian_count; k += lanes) {
      vec3 offset = gaussians[first + k].center - middle_;
      float along = dot(offset, to_light), reach = spread + gaussians[first + k].width * sqrt(widths2);
      if (along > -reach && length(offset - along * to_light) < reach) atomicOr(met[k / 32], 1u << (k % 32));
    }
    barrier();
    if (!wanted) continue;
    for (int w = 0; w < words; ++w)
      for (uint left = met[w]; left != 0u; left &= left - 1u)
        sum += column_of(gaussians[first + 32 * w + findLSB(left)], place, region);
  }
  return sum;
}
#endif

void main() {
  ivec3 size = ivec3(cells_along), at = ivec3(gl_GlobalInvocationID);
  int i = any(greaterThanEqual(at, size)) ? -1 : node_of[at.x + size.x * (at.y + size.y * at.z)];
  if (gl_LocalInvocationIndex == 0u) any_node = 0u;
  barrier();
  if (i >= 0) atomicOr(any_node, 1u);
  barrier();
  if (any_node == 0u) return;
  vec3 place = corner + cell_edge * (vec3(at) + 0.5);
  bool blocked = i >= 0 && has_objects != 0 && (hidden[i >> 5] >> (i & 31) & 1u) != 0u;
#if GAUSSIANS
  float column = column_past_group(place, i >= 0 && !blocked);
#else
  float column = i >= 0 && !blocked ? column_from(place) : 0;
#endif
  if (loops_cut()) column = uintBitsToFloat(0x7fc00000u);  // no number, rather than a wrong one
  if (i >= 0) columns[direction * node_count + i] = blocked ? 1e37 : column;
}
