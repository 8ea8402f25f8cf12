// A ray through all media: the stretches on which every density is a polynomial, or one times an exponential (SunScattering::cells of
// methods/wavelet_fog/sun_scattering.cpp). Each follows from where the one before ended, so that a ray can go on in another dispatch.
#include "common/private_doubles.glsl"
dvec3 course_origin, course_direction;
// Bits of dvec2, by medium: the ray over its map [cells], and where the ray is in the medium [m].
uvec4 start_in[MEDIA], along_in[MEDIA], way_in[MEDIA];

ivec2 cell_of(double t) {
  Grid g = grids[fog.map];
  return clamp(ivec2(floor(from_bits(start_in[medium]) + t * from_bits(along_in[medium]))), lo_of(g), lo_of(g) + size_of(g) + DEGREE - 1);
}
bool is_in_medium(double t) {
  dvec2 way = from_bits(way_in[medium]);
  return t > way.x && t < way.y;
}

void set_course(dvec3 origin, dvec3 direction, double end) {
  course_origin = origin;
  course_direction = direction;
  for (int i = 0; i < MEDIA; ++i) start_in[i] = along_in[i] = way_in[i] = bits_of(dvec2(0));
  for (int i = 0; i < media; ++i) {
    take_medium(i);
    Line line = line_over(origin, direction);
    start_in[medium] = bits_of(line.start);
    along_in[medium] = bits_of(line.along);
    way_in[medium] =
        bits_of(clip_to_support(grids[fog.map], line, clip_to_region(origin, direction, dvec2(0, end))));
  }
}

// The next place behind t where a medium begins or ends, or its density is another polynomial; 1e37: none. Grid lines that rounding
// hardly tells from t are passed, as where two of them cross.
double next_cut(double t) {
  const double passed = 1e-10LF;  // [cells]
  double next = 1e37LF;
  for (int i = 0; i < media; ++i) {
    take_medium(i);
    COUNT_LOOP
    dvec2 way = from_bits(way_in[medium]), start_over = from_bits(start_in[medium]), along_over = from_bits(along_in[medium]);
    if (!(way.y > way.x) || t >= way.y) continue;
    next = min(next, t < way.x ? way.x : way.y);
    if (t < way.x) continue;
    for (int a = 0; a < 2; ++a) {
      double start = a == 0 ? start_over.x : start_over.y, speed = a == 0 ? along_over.x : along_over.y, here = start + t * speed;
      if (speed == 0) continue;
      double met = ((speed > 0 ? floor(here + passed) + 1 : ceil(here - passed) - 1) - start) / speed;
      if (met > t) next = min(next, met);
    }
    for (int k = 0; k < breaks() && course_direction.y != 0; ++k) {
      COUNT_LOOP
      double met = (knot_height(k) - course_origin.y) / course_direction.y;
      if (met > t) next = min(next, met);
    }
  }
  return next;
}
bool something_at(double t) {
  bool something = false;
  for (int i = 0; i < media; ++i) {
    take_medium(i);
    COUNT_LOOP
    if (!is_in_medium(t) || empty_around(grids[fog.cells], cell_of(t)) >= 0) continue;
    if (PROFILE != PROFILE_LAYERS || factor_at(course_origin.y + t * course_direction.y) > 0) something = true;
  }
  return something;
}
