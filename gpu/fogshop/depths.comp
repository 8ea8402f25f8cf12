// Optical depths between a point and the centre of every Gaussian, the constant included and that Gaussian not: T(s,b_i) - T_i(s,b_i)
// and T(v,b_i) - T_i(v,b_i) of Eqs. 12 and 13, without ever subtracting. Then those of the Gaussians alone between every light and
// the point. One work group for each.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "fogshop/fog.glsl"
#include "fogshop/light.glsl"

layout(std430, binding = AT_DEPTHS) writeonly buffer Depths { float segment_depth[]; };
uniform vec3 from;
uniform int first_depth, target_count;
shared float part[LOCAL_SIZE_X];

void main() {
  int target = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x), local = int(gl_LocalInvocationID.x);
  if (target >= target_count) return;
  bool to_center = target < gaussian_count;
  vec3 begin = to_center ? from : lights[target - gaussian_count].position, end = to_center ? gaussians[target].center : from;
  float length_ = length(end - begin), sum = 0;
  vec3 direction = length_ > 0 ? (end - begin) / length_ : vec3(0, 0, 1);
  for (int i = local; i < gaussian_count; i += int(LOCAL_SIZE_X))
    if (i != target) sum += depth_between(gaussians[i], begin, direction, length_);
  part[local] = sum;
  for (int half_ = int(LOCAL_SIZE_X) / 2; half_ > 0; half_ /= 2) {
    barrier();
    if (local < half_) part[local] += part[local + half_];
  }
  if (local == 0) segment_depth[first_depth + target] = part[0] + (to_center ? constant * length_ : 0);
}
