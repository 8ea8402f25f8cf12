// One direction of the bilateral blur: reference/half_resolution_march/filter.cpp.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/far_away.glsl"
#include "half_resolution_march/blocks.glsl"

layout(std430, binding = AT_LOW) readonly buffer Low { LowPixel low[]; };
layout(std430, binding = AT_BLURRED) writeonly buffer Blurred { LowPixel blurred[]; };
uniform int along_columns;    // 0: along rows
uniform int radius;           // [blocks]
uniform float over_variance;  // 1 / (2 sigma^2) [1/blocks^2]

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = ivec2(block_columns, block_rows);
  ivec2 along = along_columns != 0 ? ivec2(0, 1) : ivec2(1, 0);
  if (any(greaterThanEqual(at, size))) return;
  int own = at.y * block_columns + at.x;
  LowPixel here = low[own];
  float edge = edge_length(), total = 0;
  vec3 airlight = vec3(0), transmittance = vec3(0);
  for (int k = -radius; k <= radius; ++k) {
    ivec2 there = at + k * along;
    if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) continue;
    LowPixel other = low[there.y * block_columns + there.x];
    float apart = depth_difference(other.depth, here.depth);
    apart = apart < 100 * edge ? apart / edge : apart > 0 ? 100 : 0;
    float weight = exp(-float(k * k) * over_variance - apart * apart);
    airlight += weight * other.airlight;
    transmittance += weight * other.transmittance;
    total += weight;
  }
  blurred[own] = LowPixel(airlight / total, here.depth, transmittance / total, 0);
}
