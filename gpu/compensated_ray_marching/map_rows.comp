// Fourier sums along the rows of a lat-long map: a row and a frequency a work group.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/map_sums.glsl"
layout(std430, binding = AT_MAP_TEXELS) readonly buffer MapTexels { float texels[]; };  // rgb, row 0 at the pole
layout(std430, binding = AT_CIRCLE) readonly buffer Circle { dvec2 circle[]; };         // by half a texel's angle
layout(std430, binding = AT_FOURIER) writeonly buffer Fourier { double fourier[]; };    // [frequency][row][6]
uniform int width, height;

void main() {
  int row = int(gl_WorkGroupID.x), m = int(gl_WorkGroupID.y);
  dvec3 even = dvec3(0), odd = dvec3(0);
  for (int i = lane; i < width; i += LOCAL_SIZE_X) {
    int texel = 3 * (row * width + i);
    dvec3 rgb = dvec3(texels[texel], texels[texel + 1], texels[texel + 2]);
    dvec2 turn = circle[m * (2 * i + 1) % (2 * width)];
    even += turn.x * rgb;
    odd += turn.y * rgb;
  }
  double sum = sum_of_lanes(even, odd);
  if (lane < 6) fourier[6 * (m * height + row) + lane] = sum;
}
