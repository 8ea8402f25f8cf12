// Radiance to moments, and J_ss plus what they scatter: an iteration's result, its residual, and the differences to the last.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/smoke_state.glsl"
#include "compensated_ray_marching/scatterer.glsl"
layout(std430, binding = AT_LIGHT) readonly buffer Light { float light[]; };             // [direction][light of the solve][cell]
layout(std430, binding = AT_WEIGHTED) readonly buffer Weighted { vec4 weighted[]; };     // [direction][band / 4]
layout(std430, binding = AT_SINGLE) readonly buffer Single { float single_source[]; };   // [light][band][cell]
layout(std430, binding = AT_SOURCE) readonly buffer Source { float source[]; };
layout(std430, binding = AT_RESULT) buffer Result { float result[]; };
layout(std430, binding = AT_STEPS) writeonly buffer Steps { float steps[]; };            // [slot][light of the solve][band][cell]
// Band 0 of the iterates: [at, residual, moved, residual steps by slot][light of the solve][cell].
layout(std430, binding = AT_MEANS) buffer Means { float means[]; };
layout(std430, binding = AT_BALANCE) readonly buffer Balance { float balance[]; };       // [channel][cell]
uniform int directions, cells;

void main() {
  int cell = int(gl_GlobalInvocationID.x), l = int(gl_GlobalInvocationID.y);
  if (done != 0 || cell >= cells) return;
  vec4 sum[ROWS];  // as in single.comp
  for (int r = 0; r < ROWS; ++r) sum[r] = vec4(0);
  for (int d = 0; d < directions; ++d) {
    float here = light[(d * lights + l) * cells + cell];
    for (int r = 0; r < ROWS; ++r) sum[r] += weighted[d * ROWS + r] * here;
  }
  float scattered = balance[channel[l] * cells + cell] * albedo[channel[l]];
  int slot = (iteration - 2) % KEPT, first = (first_light + l) * BANDS;
  for (int b = 0; b < BANDS; ++b) {
    int at = (first + b) * cells + cell;
    float now = single_source[at] + scattered * moment[b] * sum[b / 4][b % 4];
    if (iteration > 1) steps[((slot * lights + l) * BANDS + b) * cells + cell] = now - result[at];
    result[at] = now;
  }
  int plane = lights * cells, mean = l * cells + cell;
  float at = source[first * cells + cell], residual = result[first * cells + cell] - at;
  if (iteration > 1) {
    means[2 * plane + mean] = at - means[mean];
    means[(3 + slot) * plane + mean] = residual - means[plane + mean];
  }
  means[mean] = at;
  means[plane + mean] = residual;
}
