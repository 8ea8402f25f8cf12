// (cos, sin) of an angle in [-2 pi, 2 pi], to 1e-14. GLSL allows its own functions an absolute error of 2^-11.
dvec2 unit_vector(double angle) {
  double quarters = floor(angle * 0.63661977236758134LF + 0.5LF), x = angle - quarters * 1.5707963267948966LF, w = x * x;
  double c = 1 - w / 2 * (1 - w / 12 * (1 - w / 30 * (1 - w / 56 * (1 - w / 90 * (1 - w / 132 * (1 - w / 182))))));
  double s = x * (1 - w / 6 * (1 - w / 20 * (1 - w / 42 * (1 - w / 72 * (1 - w / 110 * (1 - w / 156 * (1 - w / 210)))))));
  int turns = int(quarters) & 3;
  return turns == 0 ? dvec2(c, s) : turns == 1 ? dvec2(-s, c) : turns == 2 ? dvec2(-c, -s) : dvec2(s, -c);
}
// (cosine, sine) of a number of turns in [0, 1], to 1e-7.
vec2 unit_vector(float turns) {
  float quarters = floor(turns * 4 + 0.5), x = (turns - 0.25 * quarters) * 6.283185307, w = x * x;
  float c = 1 - w / 2 * (1 - w / 12 * (1 - w / 30 * (1 - w / 56 * (1 - w / 90))));
  float s = x * (1 - w / 6 * (1 - w / 20 * (1 - w / 42 * (1 - w / 72))));
  int q = int(quarters) & 3;
  return q == 0 ? vec2(c, s) : q == 1 ? vec2(-s, c) : q == 2 ? vec2(-c, -s) : vec2(s, -c);
}
