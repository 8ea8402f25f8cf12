// The paper's tables of path integrals (methods/wavelet_fog/path_table.h), with TABLE places on each side of a cell: integrals of each
// piece of a basis function over a straight way through the cell.
layout(std430, binding = AT_TABLE) readonly buffer PathTable { float path[]; };  // [entry][exit][channel][piece over u][piece over v]
const float on_line = 1e-4;  // [cells] rounding of places in walk()

bool on_perimeter(vec2 x) {
  vec2 away = min(abs(x), abs(1 - x));
  return min(away.x, away.y) < on_line;
}

// Bottom, right, top and left side in turn, 0 to 4.
float place_on_perimeter(vec2 x) {
  vec4 away = vec4(abs(x.y), abs(1 - x.x), abs(1 - x.y), abs(x.x)), along = vec4(x, 1 - x);
  float least = min(min(away.x, away.y), min(away.z, away.w));
  int side = away.x == least ? 0 : away.y == least ? 1 : away.z == least ? 2 : 3;
  return float(side) + clamp(along[side], 0, 1);
}

// Where a way's tables begin, at the nearest places or at four around it, and the weights of these.
struct Way {
  ivec4 at;
  vec4 weight;
};
int tables_at(float entry, float exit) {
  return (int(entry) % (4 * TABLE) * (4 * TABLE) + int(exit) % (4 * TABLE)) * (CHANNELS * PIECES * PIECES);
}
Way way_between(vec2 entry, vec2 exit) {
  vec2 at = vec2(TABLE) * vec2(place_on_perimeter(entry), place_on_perimeter(exit));
  if (BILINEAR == 0) return Way(ivec4(tables_at(floor(at.x + 0.5), floor(at.y + 0.5))), vec4(1, 0, 0, 0));
  vec2 low = floor(at), s = at - low;
  return Way(ivec4(tables_at(low.x, low.y), tables_at(low.x, low.y + 1), tables_at(low.x + 1, low.y), tables_at(low.x + 1, low.y + 1)),
             vec4((1 - s.x) * (1 - s.y), (1 - s.x) * s.y, s.x * (1 - s.y), s.x * s.y));
}
float in_table(Way way, int place) {
  float sum = 0;
  for (int k = 0; k < (BILINEAR == 0 ? 1 : 4); ++k) sum += way.weight[k] * path[way.at[k] + place];
  return sum;
}

// Integral [cells] of pieces a along u and b along v; `factor` of the height at the entry, and what it gains until the exit.
float looked_up(Way way, vec2 factor, int a, int b) {
  int place = a * PIECES + b;
#if CHANNELS == 1
  return factor.x * in_table(way, place);
#else
  return factor.x * in_table(way, place) + factor.y * in_table(way, PIECES * PIECES + place);
#endif
}

// Integral of a grid's splines over a way through a cell.
float splines_looked_up(Grid g, ivec2 cell, Way way, vec2 factor) {
  int first = place_of(g, cell);
  float sum = 0;
  for (int b = 0; b <= DEGREE; ++b)
    for (int a = 0; a <= DEGREE; ++a) sum += looked_up(way, factor, a, b) * values[first - a - b * g.stride];
  return sum;
}

#if WAVELET_PIECES > 0
// Integral of the three bands of wavelets over a way through a whole cell of theirs.
float wavelets_looked_up(int bands, ivec2 cell, Way way, vec2 factor) {
  float sum = 0;
  for (int band = 0; band < 3; ++band) {
    bvec2 wavelet = bvec2(band != 0, band != 1);  // ad, da, dd: along u, along v
    ivec2 from = mix(ivec2(0), ivec2(DEGREE + 1), wavelet), count = mix(ivec2(DEGREE + 1), ivec2(WAVELET_PIECES), wavelet);
    ivec2 first = mix(ivec2(0), ivec2(WAVELET_FIRST), wavelet);
    for (int b = 0; b < count.y; ++b)
      for (int a = 0; a < count.x; ++a)
        sum += looked_up(way, factor, from.x + a, from.y + b) * value_in(grids[bands + band], cell - first - ivec2(a, b));
  }
  return sum;
}
#endif

// The factor of the height as a straight line, along a way on which it falls: at the entry, and what it gains (two Gauss points).
vec2 straight_fall(float height, float change) {
  const float off = 0.288675135;
  float first = exp(-(height + (0.5 - off) * change)), second = exp(-(height + (0.5 + off) * change)), gain = (second - first) / (2 * off);
  return vec2(0.5 * (first + second - gain), gain);
}
