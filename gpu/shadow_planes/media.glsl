// Homogeneous media, each in its region: scene/media/region.h.
#include "shadow_planes/phase.glsl"

const int region_unbounded = REGION_UNBOUNDED, region_box = REGION_BOX, region_sphere = REGION_SPHERE, region_slab = REGION_SLAB;
struct Medium {
  dvec4 lo, hi;     // of the box; centre and radius; normal and both heights [m]
  vec4 extinction;  // [1/m]
  vec4 albedo;
  Phase phase;
  int region;
};
layout(std140, binding = AT_MEDIA) uniform Media { Medium media[MOST_MEDIA]; };
uniform int media_count;
uniform int air_medium;  // the one in question, where it is one alone

dvec3 region_lo(int m) { return media[m].lo.xyz; }
dvec3 region_hi(int m) { return media[m].hi.xyz; }
vec3 extinction_of(int m) { return media[m].extinction.rgb; }
vec3 albedo_of(int m) { return media[m].albedo.rgb; }

// No function returns early here: drivers carry what it would return through the loops around it, in registers.
dvec2 clip_axis(double origin, double direction, double lo, double hi, dvec2 t) {
  if (direction == 0) {
    t = origin >= lo && origin <= hi ? t : dvec2(1, 0);
  } else {
    double a = (lo - origin) / direction, b = (hi - origin) / direction;
    t = dvec2(max(t.x, min(a, b)), min(t.y, max(a, b)));
  }
  return t;
}

// The part of the ray's [t.x, t.y] in the medium's region; empty where y <= x.
dvec2 clip_to_region(int m, dvec3 origin, dvec3 direction, dvec2 t) {
  int kind = media[m].region;
  dvec3 lo = region_lo(m), hi = region_hi(m);
  if (kind == region_sphere) {
    dvec3 to_center = lo - origin, across = cross(direction, to_center);
    double middle = dot(to_center, direction), reach2 = hi.x * hi.x - dot(across, across);
    double reach = sqrt(max(reach2, 0.0LF));
    t = reach2 > 0 ? dvec2(max(t.x, middle - reach), min(t.y, middle + reach)) : dvec2(1, 0);
  } else if (kind == region_slab) {
    t = clip_axis(dot(origin, lo), dot(direction, lo), hi.x, hi.y, t);
  } else if (kind == region_box) {
    for (int axis = 0; axis < 3; ++axis) t = clip_axis(origin[axis], direction[axis], lo[axis], hi[axis], t);
  }
  return t;
}

bool region_contains(int m, dvec3 x) {
  int kind = media[m].region;
  dvec3 lo = region_lo(m), hi = region_hi(m);
  bool inside = kind == region_unbounded;
  if (kind == region_slab) inside = dot(x, lo) >= hi.x && dot(x, lo) <= hi.y;
  if (kind == region_sphere) inside = dot(x - lo, x - lo) <= hi.x * hi.x;
  if (kind == region_box) inside = all(greaterThanEqual(x, lo)) && all(lessThanEqual(x, hi));
  return inside;
}

// Optical depth of the ray's first `length_` [m].
vec3 depth_along(dvec3 origin, dvec3 direction, double length_) {
  vec3 sum = vec3(0);
  for (int m = 0; m < media_count; ++m) {
    dvec2 inside = clip_to_region(m, origin, direction, dvec2(0, length_));
    if (inside.y > inside.x) sum += extinction_of(m) * float(inside.y - inside.x);
  }
  return sum;
}
