// The source that the next iteration begins with: the result less shares of the last steps; `begins`: J_ss itself.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/smoke_state.glsl"
layout(std430, binding = AT_RESULT) readonly buffer Result { float result[]; };
layout(std430, binding = AT_STEPS) readonly buffer Steps { float steps[]; };
layout(std430, binding = AT_SOURCE) writeonly buffer Source { float source[]; };
uniform int first_light, lights, cells;

void main() {
  int i = int(gl_GlobalInvocationID.x), plane = lights * BANDS * cells;
  if (is_over() || i >= plane) return;
  int used = min(iteration - 1, KEPT);
  double sum = double(result[first_light * BANDS * cells + i]);
  for (int j = 0; j < used; ++j) sum -= shares[j] * double(steps[j * plane + i]);
  source[first_light * BANDS * cells + i] = float(sum);
}
