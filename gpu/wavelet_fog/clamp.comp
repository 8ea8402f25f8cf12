// The copy of a grid that can be rendered alone (`clamped` of methods/wavelet_fog/decomposition.h): STAGE 0 sums its rows, a group
// each, with and without what is negative; 1 sums those and leaves the factor that restores the sum; 2 writes the copy.
layout(local_size_x = LOCAL_SIZE_X) in;
#define VALUES_ACCESS
#include "wavelet_fog/grids.glsl"
uniform int from, to, sums;  // grids; sums: a row for each of from's with two columns, at index 0
#if STAGE < 2
shared vec2 partial[LOCAL_SIZE_X];

vec2 entry(int row, int i) {
#if STAGE == 0
  Grid g = grids[from];
  float value = values[place_of(g, lo_of(g) + ivec2(i, row))];
  return vec2(value, max(value, 0));
#else
  Grid g = grids[sums];
  return vec2(values[place_of(g, ivec2(0, i))], values[place_of(g, ivec2(1, i))]);
#endif
}

void main() {
  int row = int(gl_WorkGroupID.x), me = int(gl_LocalInvocationID.x);
  int count = STAGE == 0 ? grids[from].size_u : grids[from].size_v;
  vec2 sum = vec2(0);
  for (int i = me; i < count; i += LOCAL_SIZE_X) sum += entry(row, i);
  partial[me] = sum;
  for (int half_ = LOCAL_SIZE_X / 2; half_ > 0; half_ /= 2) {
    barrier();
    if (me < half_) partial[me] += partial[me + half_];
  }
  if (me != 0 || row >= grids[from].size_v) return;
  Grid g = grids[sums];
#if STAGE == 0
  values[place_of(g, ivec2(0, row))] = partial[0].x;
  values[place_of(g, ivec2(1, row))] = partial[0].y;
#else
  values[place_of(g, ivec2(0, 0))] = partial[0].y > 0 ? max(partial[0].x, 0) / partial[0].y : 0;
#endif
}
#else
void main() {
  Grid g = grids[to];
  int i = int(gl_GlobalInvocationID.x), j = int(gl_GlobalInvocationID.y);
  if (i >= g.size_u || j >= g.size_v) return;
  ivec2 at = lo_of(g) + ivec2(i, j);
  values[place_of(g, at)] = max(values[place_of(grids[from], at)], 0) * values[grids[sums].offset];
}
#endif
