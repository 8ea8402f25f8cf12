// One axis of a step of Mallat's decomposition or back, zero beyond the grids (methods/wavelet_fog/decomposition.h):
//   down  to_k = sum_i taps_{i-2k} from_i      UP  to_i = sign sum_k taps_{i-2k} from_k, added to another grid where there is one
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define VALUES_ACCESS
#include "wavelet_fog/grids.glsl"
uniform int from, to, added;  // grids; -1: none
uniform float sign_;
const float taps[TAPS] = float[](TAP_VALUES);

void main() {
  Grid source = grids[from], target = grids[to];
  ivec2 index = ivec2(gl_GlobalInvocationID.xy), at = index + lo_of(target), other = at;
  if (index.x >= target.size_u || index.y >= target.size_v) return;
  float sum = 0;
#if UP
  int ahead = at[AXIS] - FIRST_TAP;
  for (int t = ahead & 1; t < TAPS; t += 2) {
    other[AXIS] = (ahead - t) >> 1;
    sum += taps[t] * value_in(source, other);
  }
#else
  for (int t = 0; t < TAPS; ++t) {
    other[AXIS] = 2 * at[AXIS] + FIRST_TAP + t;
    sum += taps[t] * value_in(source, other);
  }
#endif
  values[place_of(target, at)] = (added >= 0 ? value_in(grids[added], at) : 0) + sign_ * sum;
}
