// Homogeneous media, each in its region: scene/media/region.h.
#include "shadow_planes/phase.glsl"

const int region_unbounded = REGION_UNBOUNDED, region_box = REGION_BOX, region_sphere = REGION_SPHERE, region_slab = REGION_SLAB;
struct Medium {
  double lo[3], hi[3];  // of the box; centre and radius; normal and both heights [m]
  float extinction[3];  // [1/m]
  float albedo[3];
  int region;
  Phase phase;
  int unused;
};
layout(std430, binding = AT_MEDIA) readonly buffer Media { Medium media[]; };
uniform int media_count;
uniform int air_medium;  // the one in question, where it is one alone

dvec3 region_lo(int m) { return dvec3(media[m].lo[0], media[m].lo[1], media[m].lo[2]); }
dvec3 region_hi(int m) { return dvec3(media[m].hi[0], media[m].hi[1], media[m].hi[2]); }
vec3 extinction_of(int m) { return vec3(media[m].extinction[0], media[m].extinction[1], media[m].extinction[2]); }
vec3 albedo_of(int m) { return vec3(media[m].albedo[0], media[m].albedo[1], media[m].albedo[2]); }

dvec2 clip_axis(double origin, double direction, double lo, double hi, dvec2 t) {
  if (direction == 0) return origin >= lo && origin <= hi ? t : dvec2(1, 0);
  double a = (lo - origin) / direction, b = (hi - origin) / direction;
  return dvec2(max(t.x, min(a, b)), min(t.y, max(a, b)));
}

// The part of the ray's [t.x, t.y] in the medium's region; empty where y <= x.
dvec2 clip_to_region(int m, dvec3 origin, dvec3 direction, dvec2 t) {
  int kind = media[m].region;
  if (kind == region_unbounded) return t;
  dvec3 lo = region_lo(m), hi = region_hi(m);
  if (kind == region_slab) return clip_axis(dot(origin, lo), dot(direction, lo), hi.x, hi.y, t);
  if (kind == region_sphere) {
    dvec3 to_center = lo - origin, across = cross(direction, to_center);
    double middle = dot(to_center, direction), reach2 = hi.x * hi.x - dot(across, across);
    if (!(reach2 > 0)) return dvec2(1, 0);
    double reach = sqrt(reach2);
    return dvec2(max(t.x, middle - reach), min(t.y, middle + reach));
  }
  for (int axis = 0; axis < 3; ++axis) t = clip_axis(origin[axis], direction[axis], lo[axis], hi[axis], t);
  return t;
}

bool region_contains(int m, dvec3 x) {
  int kind = media[m].region;
  if (kind == region_unbounded) return true;
  dvec3 lo = region_lo(m), hi = region_hi(m);
  if (kind == region_slab) return dot(x, lo) >= hi.x && dot(x, lo) <= hi.y;
  if (kind == region_sphere) return dot(x - lo, x - lo) <= hi.x * hi.x;
  return all(greaterThanEqual(x, lo)) && all(lessThanEqual(x, hi));
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
