// The integral of a grid's splines times the factor of the height along a line: scene/media/spline_integral.h, with the walk through
// cells of spline_map.h or, with SKIPS, of methods/wavelet_fog/blocks.cpp.
//
// The walk is in single precision, from an anchor that is computed in double every 32 cells or so: places are rounded to 4e-6
// of a cell however large the map and however far away the eye.
#include "wavelet_fog/cell.glsl"
#ifndef FALL_BASE  // height and scale height where the factor falls [m]
#define FALL_BASE knot_height(0)
#define FALL_SCALE double(scale_height)
#endif
#if SKIPS || VARIANT == VARIANT_BOUND
#define EMPTINESS_ACCESS readonly
#include "wavelet_fog/emptiness.glsl"
#endif
const double cells_at_once = 32;

uint cells_read = 0u;

// The factor of the height along a part of the line: value + slope t, or falling.
struct Factor {
  double value, slope;
  bool falls;
};

// Where a line crosses the next grid line of an axis.
float crossing(float at, float along, float next) { return along == 0 ? 1e37 : (next - at) / along; }

// Of the line from `t` on, `end` long, over cells of the grid; ends once it is above `enough`.
float walk(Grid g, Line line, double t, float end, Factor factor, float enough_) {
  dvec2 exact = line.start + t * line.along, corner = floor(exact);
  ivec2 anchor = ivec2(corner), last = lo_of(g) + size_of(g) + DEGREE - 1;
  vec2 at = vec2(exact - corner), along = vec2(line.along);
#if PROFILE == PROFILE_EXPONENTIAL
  float height = float((line.height + t * line.rise - FALL_BASE) / FALL_SCALE), fall = float(line.rise / FALL_SCALE);
#endif
#if PROFILE == PROFILE_LAYERS || PROFILE == PROFILE_EXPONENTIAL
  vec2 linear = vec2(factor.value + t * factor.slope, factor.slope);
#endif
  float s = 0, sum = 0;
  vec2 towards = sign(along), next = mix(ceil(at) - 1, floor(at) + 1, greaterThan(along, vec2(0)));
  vec2 met = vec2(crossing(at.x, along.x, next.x), crossing(at.y, along.y, next.y));
  while (s < end) {
    float to = min(min(met.x, met.y), end);
    ivec2 cell = clamp(anchor + ivec2(floor(at + 0.5 * (s + to) * along)), lo_of(g), last);
    bool passed = false;
    if (to > s) {
#if SKIPS
      Grid all = grids[cells];
      ivec2 index = cell - lo_of(all);
      int empty = int(emptiness[index.y * words_in_row(all) + index.x / 8] >> (4 * (index.x & 7)) & 15u) - 1;
      passed = empty >= 0;
      if (empty > 0) {
        ivec2 block = (cell >> empty) + ivec2(greaterThan(along, vec2(0)));
        vec2 rim = vec2((block << empty) - anchor);
        to = max(to, min(end, min(crossing(at.x, along.x, rim.x), crossing(at.y, along.y, rim.y))));
        next = mix(ceil(at + to * along) - 1, floor(at + to * along) + 1, greaterThan(along, vec2(0)));
        met = vec2(crossing(at.x, along.x, next.x), crossing(at.y, along.y, next.y));
      }
#endif
      if (!passed) {
        ++cells_read;
        Cell c = cell_at(place_of(g, cell), g.stride);
        vec2 local = at - vec2(cell - anchor), piece = vec2(s, to);
#if PROFILE == PROFILE_EXPONENTIAL
        sum += factor.falls ? falling_in_cell(c, local, along, piece, height, fall)
                            : linear.x * moments_in_cell(c, local, along, piece).x;
#elif PROFILE == PROFILE_LAYERS
        sum += dot(linear, moments_in_cell(c, local, along, piece));
#else
        sum += moments_in_cell(c, local, along, piece).x;
#endif
        if (sum > enough_) return sum;
      }
      s = to;
    }
    if (met.x <= s) next.x += towards.x, met.x = crossing(at.x, along.x, next.x);
    if (met.y <= s) next.y += towards.y, met.y = crossing(at.y, along.y, next.y);
  }
  return sum;
}

int breaks() { return PROFILE == PROFILE_NONE ? 0 : knots; }

// Along a line that has that many knots below it.
Factor factor_between(Line line, int below) {
#if PROFILE == PROFILE_LAYERS
  if (below == 0 || below == knots) return Factor(knot_factor(max(below - 1, 0)), 0, false);
  double lo = knot_height(below - 1), slope = (knot_factor(below) - knot_factor(below - 1)) / (knot_height(below) - lo);
  return Factor(knot_factor(below - 1) + slope * (line.height - lo), slope * line.rise, false);
#elif PROFILE == PROFILE_EXPONENTIAL
  if (below == 0) return Factor(1, 0, false);
  if (line.rise == 0) return Factor(double(exp(float((knot_height(0) - line.height) / double(scale_height)))), 0, false);
  return Factor(1, 0, true);
#else
  return Factor(1, 0, false);
#endif
}

// Integral of f h over t [m], which is a part of the grid's support; ends once it is above `enough_`.
float integral_of(Grid g, Line line, dvec2 t, float enough_) {
  float sum = 0;
  int level_below = 0;  // knots below a line that does not rise
  bool rises = line.rise != 0;
  for (int k = 0; k < breaks() && !rises; ++k)
    if (knot_height(k) < line.height || (PROFILE == PROFILE_LAYERS && knot_height(k) == line.height)) level_below = k + 1;
  for (int k = 0; k <= (rises ? breaks() : 0); ++k) {
    dvec2 part = t;
    int below = !rises ? level_below : line.rise > 0 ? k : breaks() - k;
    if (rises) {
      double lo = below > 0 ? knot_height(below - 1) : -1e37LF, hi = below < breaks() ? knot_height(below) : 1e37LF;
      part = clip_axis(line.height, line.rise, lo, hi, t);
    }
    if (!(part.y > part.x)) continue;
    Factor factor = factor_between(line, below);
    if (factor.value == 0 && factor.slope == 0) continue;
    double length_ = part.y - part.x;
    double spans = max(1.0LF, ceil((abs(line.along.x) + abs(line.along.y)) * length_ / cells_at_once));
    for (double i = 0; i < spans && !(sum > enough_); ++i)
      sum += walk(g, line, part.x + length_ * (i / spans), float(length_ / spans), factor, enough_ - sum);
  }
  return sum;
}
