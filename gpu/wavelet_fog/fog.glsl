// Media over their maps, MEDIA of them (1 unless sun.comp takes several): where each is, its factor of the height, its grids. Everything
// in double that places depend on.
#ifndef MEDIA
#define MEDIA 1
#endif
struct Fog {
  double map_x0, map_z0, cos_over_cell, sin_over_cell;
  double region_lo[3], region_hi[3];  // of the box; centre and radius; normal and both heights [m]
  double lowest, highest;             // [m] outside there is nothing
  double mu;
  float sigma_t[3];   // [1/m]
  float enough;       // integral of the density at which a ray ends [m]
  float allowed;      // by bound: error of a ray's integral [m]
  float scale_height; // [m]
  int region, knots, levels, details, cells, errors;  // first grids of each kind; 0 is the map, up to `levels` the coarser ones
  int map, degree, profile;                           // several media: the map's grid, its degree, its kind of profile
  int first_knot, first_word, unused;                 // where its knots and its empty cells begin
};
layout(std430, binding = AT_FOG) readonly buffer Fogs {
  Fog fogs[MEDIA];
  double knot[];  // heights [m] and factors, alternating
};
#if MEDIA > 1
uniform int media;
int medium = 0;  // in hand
void take_medium(int i) { medium = i; }
#else
const int media = 1, medium = 0;
void take_medium(int i) {}
#endif
#define fog fogs[medium]

const int region_unbounded = REGION_UNBOUNDED, region_box = REGION_BOX, region_sphere = REGION_SPHERE, region_slab = REGION_SLAB;

double knot_height(int k) { return knot[2 * (fog.first_knot + k)]; }
double knot_factor(int k) { return knot[2 * (fog.first_knot + k) + 1]; }

// Where a ray is over a grid [cells], its height and what it rises per metre [m]: MapLine of scene/media/spline_map.h.
struct Line {
  dvec2 start, along;
  double height, rise;
};
dvec2 turned(dvec2 x) {
  return dvec2(x.x * fog.cos_over_cell - x.y * fog.sin_over_cell, x.x * fog.sin_over_cell + x.y * fog.cos_over_cell);
}
Line line_over(dvec3 origin, dvec3 direction) {
  return Line(turned(origin.xz - dvec2(fog.map_x0, fog.map_z0)), turned(direction.xz), origin.y, direction.y);
}
Line coarser(Line line, int level) {
  double s = 1;
  for (int i = 0; i < level; ++i) s *= 0.5LF;
  return Line(s * line.start, s * line.along, line.height, line.rise);
}

dvec2 clip_axis(double origin, double direction, double lo, double hi, dvec2 t) {
  if (direction == 0) return origin >= lo && origin <= hi ? t : dvec2(1, 0);
  double a = (lo - origin) / direction, b = (hi - origin) / direction;
  return dvec2(max(t.x, min(a, b)), min(t.y, max(a, b)));
}
// The part of t in the medium's region and heights; empty where y <= x.
dvec2 clip_to_region(dvec3 origin, dvec3 direction, dvec2 t) {
  dvec3 lo = dvec3(fog.region_lo[0], fog.region_lo[1], fog.region_lo[2]);
  dvec3 hi = dvec3(fog.region_hi[0], fog.region_hi[1], fog.region_hi[2]);
  t = clip_axis(origin.y, direction.y, fog.lowest, fog.highest, t);
  if (fog.region == region_slab) return clip_axis(dot(origin, lo), dot(direction, lo), hi.x, hi.y, t);
  if (fog.region == region_sphere) {
    dvec3 to_center = lo - origin, across = cross(direction, to_center);
    double middle = dot(to_center, direction), reach2 = hi.x * hi.x - dot(across, across);
    if (!(reach2 > 0)) return dvec2(1, 0);
    double reach = sqrt(reach2);
    return dvec2(max(t.x, middle - reach), min(t.y, middle + reach));
  }
  if (fog.region == region_box)
    for (int axis = 0; axis < 3; ++axis) t = clip_axis(origin[axis], direction[axis], lo[axis], hi[axis], t);
  return t;
}
// The part over a grid's splines, half open: scene/media/spline_map.cpp.
dvec2 clip_to_support(Grid g, Line line, dvec2 t) {
  dvec2 lo = dvec2(lo_of(g)), hi = lo + dvec2(size_of(g) + DEGREE);
  for (int a = 0; a < 2; ++a) {
    if (line.along[a] == 0) {
      if (!(line.start[a] >= lo[a] && line.start[a] < hi[a])) t = dvec2(1, 0);
    } else {
      t = clip_axis(line.start[a], line.along[a], lo[a], hi[a], t);
    }
  }
  return t;
}
