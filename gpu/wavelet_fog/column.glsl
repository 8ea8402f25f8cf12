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

#if VARIANT == VARIANT_TELE || VARIANT == VARIANT_PAPER
// Detail m counts that far (eq. 12): |OP| mu^m.
double reach_of(int m, double length_) {
  for (int i = 0; i < m; ++i) length_ *= fog.mu;
  return length_;
}
#endif

#if VARIANT == VARIANT_BOUND
// Level of the block around a cell that is passed at once, and whether there is nothing in it.
int block_around(ivec2 cell, float most, out bool empty) {
  int nothing = empty_around(cell), level = fog.levels;
  empty = nothing >= 0;
  if (empty) return nothing;
  while (level > 0 && !(value_in(grids[fog.errors + level - 1], cell >> level) <= most)) --level;
  return level;
}

// bounded_depth of methods/wavelet_fog/blocks.cpp.
float bounded(Line line, dvec2 t, float most) {
  t = clip_to_support(grids[0], line, t);
  ivec2 least = lo_of(grids[0]), last = least + size_of(grids[0]) + DEGREE - 1;
  dvec2 run = dvec2(1, 0);  // of blocks of one level
  int run_level = 0;
  float sum = 0;
  double from = t.x;
  while (true) {
    bool ends = !(from < t.y) || sum > fog.enough, empty = false;
    int level = 0;
    double to = from;
    if (!ends) {
      // The next grid lines behind `from`, the cell before them, and the block around it.
      dvec2 met = dvec2(t.y);
      for (int a = 0; a < 2; ++a) {
        if (line.along[a] == 0) continue;
        double here = line.start[a] + from * line.along[a], towards = sign(line.along[a]);
        double next = towards > 0 ? floor(here) + 1 : ceil(here) - 1;
        met[a] = (next - line.start[a]) / line.along[a];
        while (!(met[a] > from)) {
          next += towards;
          met[a] = (next - line.start[a]) / line.along[a];
        }
      }
      to = min(min(met.x, met.y), t.y);
      ivec2 cell = clamp(ivec2(floor(line.start + 0.5LF * (from + to) * line.along)), least, last);
      level = block_around(cell, most, empty);
      if (level > 0) {
        double rim = t.y;
        for (int a = 0; a < 2; ++a) {
          if (line.along[a] == 0) continue;
          int block = (cell[a] >> level) + (line.along[a] > 0 ? 1 : 0);
          rim = min(rim, (double(block << level) - line.start[a]) / line.along[a]);
        }
        to = max(to, rim);
      }
    }
    if (run.y > run.x && (ends || empty || level != run_level)) {
      sum += integral_of_level(run_level, line, run);
      run = dvec2(1, 0);
    }
    if (ends) return sum;
    if (!empty) {
      run = dvec2(run.y > run.x ? run.x : from, to);
      run_level = level;
    }
    from = to;
  }
  return sum;
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
  return of_map.y > of_map.x ? bounded(line, both(of_map, done), fog.allowed / float(of_map.y - of_map.x)) : 0.0;
#elif VARIANT == VARIANT_TELE || VARIANT == VARIANT_PAPER
  // |OP| ends where the ray leaves the ground's box of the coarsest grid.
  dvec2 box = clip_to_support(grids[fog.levels], coarser(line, fog.levels), dvec2(0, length_));
  double reach = box.y > box.x ? box.y : 0.0LF, from = 0;
  float sum = 0;
#if VARIANT == VARIANT_PAPER
  for (int m = 0; m <= fog.levels; ++m) {
    int level = fog.levels - m, grid = m == 0 ? fog.levels : fog.details + level;
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
#elif VARIANT == VARIANT_DIST
  float sum = 0;
  double from = 0;
  for (int level = 0; level <= fog.levels && from < length_ && !(sum > fog.enough); ++level) {
    double to = level == fog.levels ? length_ : min(length_, fog.least_near * double(1 << level));
    sum += integral_of_level(level, line, both(done, dvec2(from, to)));
    from = to;
  }
  return sum;
#else
  return integral_of_level(0, line, done);
#endif
}
