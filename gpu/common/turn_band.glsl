// A band of a function in real spherical harmonics, turned in space, as scene/math/sh_rotation.h: Rz(a + pi) X Rz(b + pi) X Rz(c),
// X a quarter turn about x. Bands do not mix: one at a time, so that no more than its coefficients are held. Needs `tables`: X row
// by row, SH_ORDER^2 + 1 first entries, then (column, value) pairs.
uniform int turn_at;  // its place in the tables

// Coefficient m in row l + m, what a step reads and what it writes.
const int band_size = 2 * SH_ORDER - 1;

void turn_about_z(int at, int l, float cosine, float sine) {
  float c = cosine, s = sine;  // of m times the angle
  for (int m = 1; m <= l; ++m) {
    vec3 even = row_at(at + l + m), odd = row_at(at + l - m);
    set_row(at + l + m, c * even - s * odd);
    set_row(at + l - m, s * even + c * odd);
    float next = c * cosine - s * sine;
    s = c * sine + s * cosine;
    c = next;
  }
}

void quarter_turn(int l, int from, int to) {
  int pairs_at = turn_at + SH_ORDER * SH_ORDER + 1, first = l * l;
  int k = int(tables[turn_at + first]);
  for (int i = 0; i <= 2 * l; ++i) {
    vec3 sum = vec3(0);
    for (int end = int(tables[turn_at + first + i + 1]); k < end; ++k)
      sum += tables[pairs_at + 2 * k + 1] * row_at(from + int(tables[pairs_at + 2 * k]) - first);
    set_row(to + i, sum);
  }
}

// By the rotation that takes the axes x and z to these; the result is where the band was.
void turn_band(int l, vec3 x, vec3 z) {
  float sine = length(z.xy);
  vec2 a = sine > 0 ? z.xy / sine : vec2(1, 0);
  turn_about_z(0, l, dot(x, vec3(z.z * a, -sine)), dot(x, vec3(-a.y, a.x, 0)));
  quarter_turn(l, 0, band_size);
  turn_about_z(band_size, l, -z.z, -sine);
  quarter_turn(l, band_size, 0);
  turn_about_z(0, l, -a.x, -a.y);
}
