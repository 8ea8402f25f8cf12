// J_ss and what is scattered again, from the mean radiance of diffusion on a grid and its flux, of every light of a solve.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/p1.glsl"
#include "compensated_ray_marching/p1_source.glsl"
#include "compensated_ray_marching/diffusion_vectors.glsl"
layout(std430, binding = AT_RESULT) writeonly buffer Result { float result[]; };  // [light][band][cell]
uniform double mean_cosine;

// The flux of a cell along an axis: the mean of its two faces; without ends that of the source alone.
double flux_along(int light, int axis, Cell cell) {
  if (!ends_on(axis)) return source_along(light, axis, cell.at) / transport;
  int solution = vector_at(light, SOLUTION);
  double sum = 0;
  for (int side = -1; side < 2; side += 2) {
    int other = beside(cell, axis, side);
    double fall = vectors[solution + cell.at] - (other < 0 ? 0.0LF : vectors[solution + other]);
    sum += (double(side) * fall + pushed(light, cell, axis, side)) / resistance(cell, axis, side);
  }
  return 0.5LF * sum;
}

void main() {
  int at = int(gl_GlobalInvocationID.x), light = int(gl_GlobalInvocationID.z);
  if (at >= cell_count()) return;
  Cell cell = cell_of(at);
  bool lit = states[first_system + light].whole > 0;
  for (int band = 0; band < BANDS; ++band) {
    double again = 0;
    if (band == 0 && lit) again = vectors[vector_at(light, SOLUTION) + at] / 0.28209479177387814LF;
    if (band > 0 && band < 4 && lit) {
      int axis = band == 3 ? 0 : band;
      again = mean_cosine * sign_on(axis) * 3 * flux_along(light, axis, cell) / 0.48860251190291992LF;
    }
    int here = source_at(light, band, at);
    result[here] = float(double(single_source[here]) + albedo * again);
  }
}
