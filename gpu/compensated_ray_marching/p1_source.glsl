// J_ss(w) = J0 + J1.w of a cell: of J1 the component along an axis.
layout(std430, binding = AT_SINGLE) readonly buffer Single { float single_source[]; };  // [light][band][cell]
uniform int first_light;

int source_at(int light, int band, int cell) { return ((first_light + light) * BANDS + band) * cell_count() + cell; }
double mean_source(int light, int cell) { return 0.28209479177387814LF * double(single_source[source_at(light, 0, cell)]); }
// Harmonics 3, 1 and 2 are -x, -y and z times sqrt(3 / 4 pi).
int band_on(int axis) { return axis == 0 ? 3 : axis; }
double sign_on(int axis) { return axis == 2 ? 1.0LF : -1.0LF; }
double source_along(int light, int axis, int cell) {
#if BANDS > 1
  return 0.48860251190291992LF * sign_on(axis) * double(single_source[source_at(light, band_on(axis), cell)]);
#else
  return 0;
#endif
}
// The push of a face: half a cell's extinction times J1 on either side.
double pushed(int light, Cell cell, int axis, int side) {
  int other = beside(cell, axis, side);
  double push = extinction_of(cell.at) * source_along(light, axis, cell.at);
  if (other >= 0) push += extinction_of(other) * source_along(light, axis, other);
  return 0.5LF * edge_on(axis) * push;
}
