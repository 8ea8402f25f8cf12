// Functions in real spherical harmonics turned in space, as scene/math/sh_rotation.h: Rz(a + pi) X Rz(b + pi) X Rz(c), X a
// quarter turn about x. Needs `tables`: X row by row, SH_ORDER^2 + 1 first entries, then (column, value) pairs.
#include "common/spherical_harmonics.glsl"

const int SH_SIZE = SH_ORDER * SH_ORDER;
uniform int turn_at;  // its place in the tables

// Two functions, one after the other: places for what a step reads and what it writes. Not arguments: each call would copy
// them whole, and llvmpipe compiles for minutes.
vec3 functions[2 * SH_SIZE];

void turn_about_z(int at, float cosine, float sine) {
  float c = 1, s = 0;  // of m times the angle
  for (int m = 1; m < sh_order; ++m) {
    float next = c * cosine - s * sine;
    s = c * sine + s * cosine;
    c = next;
    for (int l = m; l < sh_order; ++l) {
      int middle = at + l * (l + 1);
      vec3 even = functions[middle + m], odd = functions[middle - m];
      functions[middle + m] = c * even - s * odd;
      functions[middle - m] = s * even + c * odd;
    }
  }
}

void quarter_turn(int from, int to) {
  int pairs_at = turn_at + SH_SIZE + 1, k = 0;
  for (int i = 0; i < sh_order * sh_order; ++i) {
    vec3 sum = vec3(0);
    for (int end = int(tables[turn_at + i + 1]); k < end; ++k)
      sum += tables[pairs_at + 2 * k + 1] * functions[from + int(tables[pairs_at + 2 * k])];
    functions[to + i] = sum;
  }
}

// The first function by the rotation that takes the axes x and z to these; the second is lost.
void turn_harmonics(vec3 x, vec3 z) {
  float sine = length(z.xy);
  vec2 a = sine > 0 ? z.xy / sine : vec2(1, 0);
  turn_about_z(0, dot(x, vec3(z.z * a, -sine)), dot(x, vec3(-a.y, a.x, 0)));
  quarter_turn(0, SH_SIZE);
  turn_about_z(SH_SIZE, -z.z, -sine);
  quarter_turn(SH_SIZE, 0);
  turn_about_z(0, -a.x, -a.y);
}
