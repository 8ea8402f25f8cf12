// Harmonics of a lat-long map about its pole, from Fourier sums of the rows: a pair (l, m), (l, -m) a work group.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/map_sums.glsl"
layout(std430, binding = AT_FOURIER) readonly buffer Fourier { double fourier[]; };          // [frequency][row][6]
layout(std430, binding = AT_ROW_WEIGHTS) readonly buffer RowWeights { double weights[]; };  // [pair][row]
layout(std430, binding = AT_PROJECTED) writeonly buffer Projected { double projected[]; };  // [pair][6]
uniform int height;

void main() {
  int pair = int(gl_WorkGroupID.x), l = 0;
  while ((l + 1) * (l + 2) / 2 <= pair) ++l;
  int m = pair - l * (l + 1) / 2;
  dvec3 even = dvec3(0), odd = dvec3(0);
  for (int row = lane; row < height; row += LOCAL_SIZE_X) {
    double weight = weights[pair * height + row];
    int at = 6 * (m * height + row);
    even += weight * dvec3(fourier[at], fourier[at + 1], fourier[at + 2]);
    odd += weight * dvec3(fourier[at + 3], fourier[at + 4], fourier[at + 5]);
  }
  double sum = sum_of_lanes(even, odd);
  if (lane < 6) projected[6 * pair + lane] = sum;
}
