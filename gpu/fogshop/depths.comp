// Optical depths between pairs of points, the constant included: T(s,b_i) - T_i(s,b_i) and T(v,b_i) - T_i(v,b_i) of Eqs. 12
// and 13, without ever subtracting.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "fogshop/fog.glsl"

struct Segment {
  vec3 from;
  int without;  // the Gaussian that does not count, or -1
  vec3 to;
  float constant_part;  // 1: the constant counts, 0: the Gaussians alone
};
layout(std430, binding = 7) readonly buffer Segments { Segment segments[]; };
layout(std430, binding = 8) writeonly buffer Depths { float segment_depth[]; };
uniform int segment_count, first_depth;

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= segment_count) return;
  Segment s = segments[index];
  segment_depth[first_depth + index] =
      depth_between(s.from, s.to, s.without) + s.constant_part * constant * length(s.to - s.from);
}
