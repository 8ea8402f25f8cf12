// The processor's tables for SH_ORDER bands of real spherical harmonics, in double precision. Definitions by centre_tables.cpp say
// where each table begins.
layout(std430, binding = AT_CENTRE_TABLES) readonly buffer CentreTables { double tables[]; };
uniform int sh_order;  // SH_ORDER: loops run to a uniform, or Mesa unrolls them

// Harmonics of a unit direction w, as scene/math/spherical_harmonics.cpp; index l (l + 1) + m has q turn.x, and - m has q turn.y:
//   for (Harmonic y = first_harmonic(); y.m < sh_order; next_harmonic(y, w))
struct Harmonic {
  int l, m;
  double q, before;  // at this l and the last
  dvec2 turn;        // of (x + iy)^m
};
Harmonic first_harmonic() { return Harmonic(0, 0, tables[FIRST_AT], 0.0LF, dvec2(1, 0)); }
void next_harmonic(inout Harmonic y, dvec3 w) {
  ++y.l;
  if (y.l < sh_order) {
    int at = y.l * SH_ORDER + y.m;
    double q = tables[UP_AT + at] * w.z * y.q - tables[BACK_AT + at] * y.before;
    y.before = y.q;
    y.q = q;
  } else {
    ++y.m;
    y.l = y.m;
    y.turn = dvec2(y.turn.x * w.x - y.turn.y * w.y, y.turn.x * w.y + y.turn.y * w.x);
    y.q = tables[FIRST_AT + y.m];
    y.before = 0;
  }
}

// Between samples of a table of `last` + 1 of them, `stride` apart.
double between(int at, int stride, int last, double place) {
  int i = clamp(int(place), 0, last - 1);
  double lower = tables[at + i * stride], upper = tables[at + (i + 1) * stride];
  return lower + (place - double(i)) * (upper - lower);
}
