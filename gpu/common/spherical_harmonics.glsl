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
  float q, before;    // at this l and the last
  vec2 turn;          // of (x + iy)^m
};

ShPair pair_at(int m, float q, vec2 turn) { return ShPair(m, m, q * turn.x, m > 0 ? q * turn.y : 0, q, 0, turn); }
ShPair first_pair(vec3 direction) { return pair_at(0, 0.282094791773878, vec2(1, 0)); }
void next_pair(inout ShPair y, vec3 direction) {
  float l = float(++y.l), m = float(y.m);
  if (y.l < sh_order) {
    float span = (l - m) * (l + m), q = sqrt((2 * l - 1) * (2 * l + 1) / span) * direction.z * y.q;
    if (y.l > y.m + 1) q -= sqrt((2 * l + 1) * (l - 1 - m) * (l - 1 + m) / ((2 * l - 3) * span)) * y.before;
    y.before = y.q;
    y.q = q;
    y.plus = q * y.turn.x;
    if (y.m > 0) y.minus = q * y.turn.y;
    return;
  }
  // The first of the next m: sqrt((2 - delta_m0) (2m+1)!! / (2m)!! / (4 pi)), signs alternating.
  int next = y.m + 1;
  float diagonal = 0.0795774715459477;
  for (int k = 1; k <= next; ++k) diagonal *= (2 * float(k) + 1) / (2 * float(k));
  vec2 turn = vec2(y.turn.x * direction.x - y.turn.y * direction.y, y.turn.x * direction.y + y.turn.y * direction.x);
  y = pair_at(next, (next % 2 != 0 ? -1 : 1) * sqrt(2 * diagonal), turn);
}
