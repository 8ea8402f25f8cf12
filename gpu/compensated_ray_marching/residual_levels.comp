// Levels of all samples of a frame, or between them at points that are given: what the parity with the processor is measured by.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/residual.glsl"
#if BETWEEN
layout(std430, binding = AT_RESIDUAL_POINTS) readonly buffer Points { vec4 points[]; };  // in samples
layout(std430, binding = AT_RESIDUAL_RESULT) writeonly buffer Result { float result[]; };
#else
layout(std430, binding = AT_RESIDUAL_RESULT) writeonly buffer Result { int result[]; };
uniform vec3 first, box;  // samples from `first` on, x fastest: also outside the frame
#endif
uniform int count;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= count) return;
#if BETWEEN
  result[i] = residual_between(points[i].xyz);
#else
  ivec3 n = ivec3(box);
  result[i] = residual_level(ivec3(first) + ivec3(i % n.x, i / n.x % n.y, i / n.x / n.y));
#endif
}
