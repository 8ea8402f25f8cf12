// The integral of a grid's splines times the factor of the height along a line: scene/media/spline_integral.h, with the walk through
// cells of spline_map.h or, with SKIPS, of methods/wavelet_fog/blocks.cpp.
//
// The walk is in single precision, from an anchor that is computed in double every 32 cells or so: places are rounded to 4e-6
// of a cell however large the map and however far away the eye (with bound 256, and 3e-5).
#ifndef FALL_BASE  // height and scale height where the factor falls [m]
#define FALL_BASE knot_height(0)
#define FALL_SCALE double(fog.scale_height)
#endif
#include "wavelet_fog/heights.glsl"
#include "wavelet_fog/cell.glsl"
#if SKIPS || VARIANT == VARIANT_BOUND
#include "wavelet_fog/empty_cells.glsl"
#endif
#if VARIANT == VARIANT_PRE
#include "wavelet_fog/wavelet_cell.glsl"
#else
const int wavelets = -1;
#endif
#ifndef TABLE
#define TABLE 0
#endif
#if TABLE > 0
#include "wavelet_fog/path_table.glsl"
#endif
#if VARIANT == VARIANT_BOUND || TABLE > 0  // a walk that begins anew may cut a block or a cell that it would have taken as a whole
const double cells_at_once = 256;
#else
const double cells_at_once = 32;
#endif

uint cells_read = 0u;

#define KNOWS_EMPTY (SKIPS || VARIANT == VARIANT_BOUND)
#define BLOCKS (KNOWS_EMPTY || (TABLE > 0 && VARIANT == VARIANT_PRE))
#if VARIANT == VARIANT_BOUND
float allowed_error;  // of the ray in hand, in f

// Level of the block around a cell that may be taken from its coarser grid.
int coarse_level(ivec2 cell) {
  int level = fog.levels;
  while (level > 0 && !(value_in(grids[fog.errors + level - 1], cell >> level) <= allowed_error)) --level;
  return level;
}
#endif

// Integral over the line from `t` on, over a length of `end`, by cells of the grid or by blocks of them: empty blocks, and blocks where
// a coarser grid is accurate enough. Ends once the sum is above `enough_`.
float walk(Grid g, Line line, double t, float end, Factor factor, float enough_) {
  dvec2 exact = line.start + t * line.along, corner = floor(exact);
  ivec2 anchor = ivec2(corner), first = lo_of(g), last = first + size_of(g) + DEGREE - 1;
  vec2 at = vec2(exact - corner), along = vec2(line.along);
  float height = 0, fall = 0;
  if (PROFILE == PROFILE_EXPONENTIAL) {
    height = float((line.height + t * line.rise - FALL_BASE) / FALL_SCALE);
    fall = float(line.rise / FALL_SCALE);
  }
  vec2 linear = vec2(factor.value + t * factor.slope, factor.slope);
  // A cell's rim is met at (rim - at) / along, never where the line does not move.
  bvec2 moves = greaterThan(abs(along), vec2(1e-30)), falls_back = lessThan(along, vec2(0));
  vec2 inverse = mix(vec2(0), 1 / along, moves), never = mix(vec2(1e37), vec2(0), moves);
  ivec2 ahead = ivec2(greaterThan(along, vec2(0)));
  ivec2 cell = clamp(anchor + ivec2(mix(floor(at), ceil(at) - 1, falls_back)), first, last);
#if KNOWS_EMPTY
  Grid all = grids[fog.cells];
#endif
#if VARIANT == VARIANT_PRE
  ivec2 whole = ivec2(0x7fffffff);  // cell of the wavelets that was read last
#endif
  float s = 0, sum = 0;
  while (s < end) {
    COUNT_LOOP
    int level = 0;
    bool empty = false;
#if KNOWS_EMPTY
    int nothing = empty_around(all, cell);
    empty = nothing >= 0;
    level = max(nothing, 0);
#if VARIANT == VARIANT_BOUND
    if (!empty) level = coarse_level(cell);
#endif
#endif
#if TABLE > 0
    // A cell that the ray passes from side to side; of wavelets a whole cell of theirs.
    int size = int(wavelets >= 0);
    ivec2 passed = cell >> size;
    vec2 sides = (vec2(((passed + ahead) << size) - anchor) - at) * inverse + never;
    float leaves = max(s, min(min(sides.x, sides.y), end));
    vec2 over_cell = along * exp2(-float(size)), entry = (at + vec2(anchor - (passed << size))) * exp2(-float(size)) + s * over_cell,
         exit = entry + (leaves - s) * over_cell;
    vec2 straight = vec2(linear.x + s * linear.y, (leaves - s) * linear.y);
    bool looks = distance(entry, exit) > 0.1 * on_line && on_perimeter(entry) && on_perimeter(exit);
#if FALLS
    if (factor.falls) {
      looks = looks && abs(fall) * (leaves - s) <= MOST_FALL;
      straight = straight_fall(height + s * fall, fall * (leaves - s));
    }
#endif
    if (looks) {
      Way way = way_between(entry, exit);
      empty = true;  // nothing is left in it
      level = size;
#if VARIANT == VARIANT_PRE
      cells_read += uint(wavelets < 0);
      wavelet_cells += uint(wavelets >= 0);
#else
      ++cells_read;
#endif
#if VARIANT == VARIANT_PRE && WAVELET_PIECES > 0
      float found = wavelets < 0 ? splines_looked_up(g, cell, way, straight) : wavelets_looked_up(wavelets, passed, way, straight);
#else
      float found = splines_looked_up(g, cell, way, straight);
#endif
      sum += found / length(over_cell);
    }
#endif
    ivec2 block = cell >> level;
    vec2 met = (vec2(((block + ahead) << level) - anchor) - at) * inverse + never;
    float to = max(s, min(min(met.x, met.y), end));
    if (!empty && to > s) {
#if VARIANT == VARIANT_PRE
      cells_read += uint(wavelets < 0);
#else
      ++cells_read;
#endif
      vec2 local = at + vec2(anchor - (block << level)), over = along, piece = vec2(s, to);
#if VARIANT == VARIANT_BOUND
      Grid grid = grids[level];
      float scale = exp2(-float(level));
      local *= scale;
      over *= scale;
      Cell c = cell_at(place_of(grid, block), grid.stride);
#elif VARIANT == VARIANT_PRE
      if (wavelets >= 0 && (cell >> 1) != whole) {
        whole = cell >> 1;
        ++wavelet_cells;
      }
      Cell c = wavelets < 0 ? cell_at(place_of(g, cell), g.stride) : cell_of_wavelets(cell);
#else
      Cell c = cell_at(place_of(g, cell), g.stride);
#endif
#if FALLS
      if (factor.falls)
        sum += falling_in_cell(c, local, over, piece, height, fall);
      else
#endif
        sum += PROFILE == PROFILE_LAYERS ? dot(linear, moments_in_cell(c, local, over, piece))
                                         : linear.x * moments_in_cell(c, local, over, piece).x;
      if (sum > enough_) return sum;
    }
    ivec2 next = cell;
#if BLOCKS
    ivec2 low = block << level;
    next = clamp(anchor + ivec2(floor(at + to * along)), low, low + (1 << level) - 1);
#endif
    cell = mix(next, ((block + ahead) << level) + ahead - 1, lessThanEqual(met, vec2(to)));
    if (any(lessThan(cell, first)) || any(greaterThan(cell, last))) return sum;  // the rest is rounding
    s = to;
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
