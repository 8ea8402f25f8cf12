// The integral of a grid's splines times the factor of the height along a line: scene/media/spline_integral.h, with the walk through
// cells of spline_map.h or, with SKIPS, of methods/wavelet_fog/blocks.cpp.
//
// The walk is in single precision, from an anchor that is computed in double every 32 cells or so: places are rounded to 4e-6
// of a cell however large the map and however far away the eye.
#ifndef FALL_BASE  // height and scale height where the factor falls [m]
#define FALL_BASE knot_height(0)
#define FALL_SCALE double(fog.scale_height)
#endif
#include "wavelet_fog/heights.glsl"
#include "wavelet_fog/cell.glsl"
#if SKIPS || VARIANT == VARIANT_BOUND
#include "wavelet_fog/empty_cells.glsl"
#endif
const double cells_at_once = 32;

uint cells_read = 0u;

// Where a line crosses the next grid line of an axis.
float crossing(float at, float along, float next) { return along == 0 ? 1e37 : (next - at) / along; }

// Of the line from `t` on, `end` long, over cells of the grid; ends once it is above `enough`.
float walk(Grid g, Line line, double t, float end, Factor factor, float enough_) {
  dvec2 exact = line.start + t * line.along, corner = floor(exact);
  ivec2 anchor = ivec2(corner), last = lo_of(g) + size_of(g) + DEGREE - 1;
  vec2 at = vec2(exact - corner), along = vec2(line.along);
  float height = 0, fall = 0;
  if (PROFILE == PROFILE_EXPONENTIAL) {
    height = float((line.height + t * line.rise - FALL_BASE) / FALL_SCALE);
    fall = float(line.rise / FALL_SCALE);
  }
  vec2 linear = vec2(factor.value + t * factor.slope, factor.slope);
  float s = 0, sum = 0;
  vec2 towards = sign(along), next = mix(ceil(at) - 1, floor(at) + 1, greaterThan(along, vec2(0)));
  vec2 met = vec2(crossing(at.x, along.x, next.x), crossing(at.y, along.y, next.y));
  while (s < end) {
    COUNT_LOOP
    float to = min(min(met.x, met.y), end);
    ivec2 cell = clamp(anchor + ivec2(floor(at + 0.5 * (s + to) * along)), lo_of(g), last);
    bool passed = false;
    if (to > s) {
#if SKIPS
      int empty = empty_around(cell);
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
#if FALLS
        if (factor.falls)
          sum += falling_in_cell(c, local, along, piece, height, fall);
        else
#endif
          sum += PROFILE == PROFILE_LAYERS ? dot(linear, moments_in_cell(c, local, along, piece))
                                           : linear.x * moments_in_cell(c, local, along, piece).x;
        if (sum > enough_) return sum;
      }
      s = to;
    }
    if (met.x <= s) next.x += towards.x, met.x = crossing(at.x, along.x, next.x);
    if (met.y <= s) next.y += towards.y, met.y = crossing(at.y, along.y, next.y);
  }
  return sum;
}

// Integral of f h over t [m], which is a part of the grid's support; ends once it is above `enough_`.
float integral_of(Grid g, Line line, dvec2 t, float enough_) {
  float sum = 0;
  for (int k = 0; k < pieces_of(line); ++k) {
    COUNT_LOOP
    int below;
    dvec2 part = between_knots(line, t, k, below);
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
