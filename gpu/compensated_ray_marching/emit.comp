// Light that the source sends into each direction of the ordinates.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/smoke_state.glsl"
layout(std430, binding = AT_SOURCE) readonly buffer Source { float source[]; };           // [light][band][cell]
layout(std430, binding = AT_HARMONICS) readonly buffer Harmonics { float harmonics[]; };  // [direction][BANDS]
layout(std430, binding = AT_EMITTED) writeonly buffer Emitted { float emitted[]; };       // [direction][light of the solve][cell]
uniform int first_light, lights, cells;

void main() {
  int cell = int(gl_GlobalInvocationID.x), d = int(gl_GlobalInvocationID.y) / lights, l = int(gl_GlobalInvocationID.y) % lights;
  if (done != 0 || cell >= cells) return;
  float sum = 0;
  for (int b = 0; b < BANDS; ++b) sum += harmonics[d * BANDS + b] * source[((first_light + l) * BANDS + b) * cells + cell];
  emitted[int(gl_GlobalInvocationID.y) * cells + cell] = sum;
}
