// The factor of the height of the medium in hand: scene/media/height_profile.h. Needs fog.glsl.
#ifndef COUNT_LOOP  // done about as often as a loop goes round
#define COUNT_LOOP
#endif
int breaks() { return PROFILE == PROFILE_NONE ? 0 : fog.knots; }

// Knots below a line that does not rise.
int knots_below(Line line) {
  int below = 0;
  for (int k = 0; k < breaks(); ++k) {
    COUNT_LOOP
    if (knot_height(k) < line.height || (PROFILE == PROFILE_LAYERS && knot_height(k) == line.height)) below = k + 1;
  }
  return below;
}
// The k-th piece of t between knots, in the order that the line meets them, and how many knots lie below it. Lines that do not rise
// have one, k = 0.
dvec2 between_knots(Line line, dvec2 t, int k, out int below) {
  if (line.rise == 0) {
    below = knots_below(line);
    return t;
  }
  below = line.rise > 0 ? k : breaks() - k;
  double lo = below > 0 ? knot_height(below - 1) : -1e37LF, hi = below < breaks() ? knot_height(below) : 1e37LF;
  return clip_axis(line.height, line.rise, lo, hi, t);
}
int pieces_of(Line line) { return line.rise != 0 ? breaks() + 1 : 1; }

// The factor of the height along a part of the line: value + slope t, or falling.
struct Factor {
  double value, slope;
  bool falls;
};

// Along a line that has that many knots below it.
Factor factor_between(Line line, int below) {
  if (PROFILE == PROFILE_LAYERS) {
    if (below == 0 || below == fog.knots) return Factor(knot_factor(max(below - 1, 0)), 0, false);
    double lo = knot_height(below - 1), slope = (knot_factor(below) - knot_factor(below - 1)) / (knot_height(below) - lo);
    return Factor(knot_factor(below - 1) + slope * (line.height - lo), slope * line.rise, false);
  }
  if (PROFILE != PROFILE_EXPONENTIAL || below == 0) return Factor(1, 0, false);
  if (line.rise == 0) return Factor(double(exp(float((knot_height(0) - line.height) / double(fog.scale_height)))), 0, false);
  return Factor(1, 0, true);
}

float factor_at(double height) {
  int below = knots_below(Line(dvec2(0), dvec2(0), height, 0));
  return float(factor_between(Line(dvec2(0), dvec2(0), height, 0), below).value);
}
