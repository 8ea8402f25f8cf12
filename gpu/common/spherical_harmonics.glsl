// Real spherical harmonics of SH_ORDER bands for a unit direction, like scene/math/spherical_harmonics.h: orthonormal, Condon-Shortley,
// index l(l+1)+m, polar axis z. The recurrence runs upwards in l, pair by pair, so that they need not all be stored:
//
//   for (ShPair y = first_pair(w); y.m < sh_order; next_pair(y, w)) // y.plus of index y.l * (y.l + 1) + y.m, y.minus of - y.m
//
// Loops run to a uniform: with a constant, Mesa unrolls all of them, and order 12 takes a minute and a half to compile.
uniform int sh_order;  // SH_ORDER
struct ShPair {
  int l, m;
  float plus, minus;  // the latter is 0 where m is
  float q, before;    // at this l; at the last, over its factor below
  float diagonal;     // (2m+1)!! / ((2m)!! 4 pi)
  vec2 turn;          // of (x + iy)^m
};

ShPair pair_at(int m, float q, float diagonal, vec2 turn) {
  return ShPair(m, m, q * turn.x, q * turn.y, q, 0, diagonal, turn);
}
ShPair first_pair(vec3 direction) { return pair_at(0, 0.282094791773878, 0.0795774715459477, vec2(1, 0)); }
// Steps through the bands below `order`.
void next_pair(inout ShPair y, vec3 direction, int order) {
  float l = float(++y.l), m = float(y.m);
  if (y.l < order) {
    // P_l = f_l z P_(l-1) - f_l / f_(l-1) P_(l-2), f_l = sqrt((4 l^2 - 1) / (l^2 - m^2)).
    float square = (l - m) * (l + m) / (4 * l * l - 1), factor = inversesqrt(square);
    float q = factor * (direction.z * y.q - y.before);
    y.before = y.q * square * factor;
    y.q = q;
    y.plus = q * y.turn.x;
    y.minus = q * y.turn.y;
  } else {  // the first of the next m: sqrt((2 - delta_m0) (2m+1)!! / (2m)!! / (4 pi)), signs alternating
    float diagonal = y.diagonal * ((2 * m + 3) / (2 * m + 2)), sign = (y.m & 1) == 0 ? -1 : 1;
    vec2 turn = vec2(y.turn.x * direction.x - y.turn.y * direction.y, y.turn.x * direction.y + y.turn.y * direction.x);
    y = pair_at(y.m + 1, sign * sqrt(2 * diagonal), diagonal, turn);
  }
}
void next_pair(inout ShPair y, vec3 direction) { next_pair(y, direction, sh_order); }
