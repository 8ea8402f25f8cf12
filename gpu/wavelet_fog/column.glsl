// Integral of a medium's density along a ray by VARIANT: LeveledFog::column of methods/wavelet_fog/leveled_fog.cpp.
#define VALUES_ACCESS readonly
#include "wavelet_fog/grids.glsl"
#include "wavelet_fog/fog.glsl"
#include "wavelet_fog/walk.glsl"

// A ray may be done in several dispatches, each a part of it.
uniform int part, parts;

float integral_of_level(int level, Line line, dvec2 t) {
  Grid g = grids[level];
  Line over = coarser(line, level);
  t = clip_to_support(g, over, t);
  return t.y > t.x ? integral_of(g, over, t, fog.enough) : 0.0;
}
dvec2 both(dvec2 a, dvec2 b) { return dvec2(max(a.x, b.x), min(a.y, b.y)); }

#if VARIANT == VARIANT_TELE || VARIANT == VARIANT_PAPER || VARIANT == VARIANT_PRE
// Detail m counts that far (eq. 12): |OP| mu^m.
double reach_of(int m, double length_) {
  for (int i = 0; i < m; ++i) length_ *= fog.mu;
  return length_;
}
#endif

// From the ray's origin to `length_` [m], of the part of it that this dispatch does.
float column(dvec3 origin, dvec3 direction, double length_) {
  Line line = line_over(origin, direction);
  dvec2 inside = clip_to_region(origin, direction, dvec2(0, length_));
#if FADES
  line.height = 0;  // along the ray the vertical distance from the eye only grows
  line.rise = abs(line.rise);
#endif
  dvec2 way = clip_to_support(grids[fog.levels], coarser(line, fog.levels), inside);
  if (!(way.y > way.x)) return 0;
  dvec2 done = dvec2(way.x + (way.y - way.x) * (double(part) / parts), way.x + (way.y - way.x) * (double(part + 1) / parts));
#if VARIANT == VARIANT_BOUND
  dvec2 of_map = clip_to_support(grids[0], line, inside);
  allowed_error = fog.allowed / float(max(of_map.y - of_map.x, 0.0LF));
  return integral_of_level(0, line, both(of_map, done));
#elif VARIANT == VARIANT_TELE || VARIANT == VARIANT_PAPER || VARIANT == VARIANT_PRE
  // |OP| ends where the ray leaves the ground's box of the coarsest grid.
  dvec2 box = clip_to_support(grids[fog.levels], coarser(line, fog.levels), dvec2(0, length_));
  double reach = box.y > box.x ? box.y : 0.0LF, from = 0;
  float sum = 0;
#if VARIANT != VARIANT_TELE
  for (int m = 0; m <= fog.levels; ++m) {
#if VARIANT == VARIANT_PRE  // the grid says where the wavelets lie, in half cells; their three bands follow
    int level = fog.levels - m, grid = m == 0 ? fog.levels : fog.details + 4 * level;
    wavelets = m == 0 ? -1 : grid + 1;
#else
    int level = fog.levels - m, grid = m == 0 ? fog.levels : fog.details + level;
#endif
    Line over = coarser(line, level);
    dvec2 t = clip_to_support(grids[grid], over, both(done, dvec2(0, reach_of(m, reach))));
    if (t.y > t.x) sum += integral_of(grids[grid], over, t, 1e37);
  }
#else
  for (int m = fog.levels; m >= 0; --m) {
    double to = reach_of(m, reach);
    if (to > from) sum += integral_of_level(fog.levels - m, line, both(done, dvec2(from, to)));
    from = max(from, to);
  }
#endif
  return sum;
#else
  return integral_of_level(0, line, done);
#endif
}
