// The smoke's density at points that are given, relative to its middle: what oracle vectors are compared with.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/smoke_density.glsl"
layout(std430, binding = AT_NODES) readonly buffer Points { vec4 points[]; };
layout(std430, binding = AT_RESULT) writeonly buffer Result { float result[]; };
uniform int count;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i < count) result[i] = density_at(points[i].xyz);
}
