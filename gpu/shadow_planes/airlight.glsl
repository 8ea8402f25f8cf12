// Airlight of one light on a lit part of a ray: methods/shadow_planes/lit_airlight.cpp, bounded_media.h. BOUNDED: media have
// regions, or there are several; SPOT: the light is one; POLYNOMIAL: the paper's evaluator, of one medium without a region;
// GREY: media have one extinction in all channels; PAPER_MEDIUM: the
// paper's form of one medium in a region. Needs ray.glsl.
#include "common/angle.glsl"
#include "common/pi.glsl"
#include "shadow_planes/length.glsl"
#include "shadow_planes/media.glsl"
#include "shadow_planes/evaluator.glsl"
#if POLYNOMIAL
#include "shadow_planes/polynomial.glsl"
#else
#include "shadow_planes/rule.glsl"
#endif

const int channels = GREY != 0 ? 1 : 3;

#if SPOT
#include "shadow_planes/spot.glsl"
#endif

#if BOUNDED || SPOT
double nearest_place;  // found so far beyond the place that is looked from [m]

void meet_place(double place, double from) {
  if (place > from && place < nearest_place) nearest_place = place;
}
#endif

#if SPOT
void meet_cone(Ray ray, double cosine, double from) {
  dvec2 places = cross_cone(ray, cosine);
  meet_place(places.x, from);
  meet_place(places.y, from);
}
#endif

#if BOUNDED
// Ways from the light through a region have kinks where they pass an edge of it, or graze it.
void meet_kinks(Ray ray, int m, double from) {
  int kind = media[m].region;
  dvec3 lo = region_lo(m), hi = region_hi(m);
  if (kind == region_sphere) {
    dvec2 places = cross_tangent_cone(lo - light, hi.x, -ray.to_light, ray.direction);
    if (dot(lo - light, lo - light) > hi.x * hi.x) {
      meet_place(places.x, from);
      meet_place(places.y, from);
    }
  }
  if (kind != region_box) return;
  dvec3 side = cross(ray.direction, ray.to_light);
  for (int edge = 0; edge < 12; ++edge) {
    // Bit 0: at the high end of the edge's own axis; bits 1 and 2: of the two axes after it.
    int axis = edge >> 2, begins = (edge & 3) << 1;
    ivec3 bit = (ivec3(3, 4, 5) - axis) % 3;
    dvec3 a = mix(lo, hi, notEqual(ivec3(begins) >> bit & 1, ivec3(0))) - light;
    dvec3 b = mix(lo, hi, notEqual(ivec3(begins | 1) >> bit & 1, ivec3(0))) - light;
    double sa = dot(side, a), sb = dot(side, b);
    if ((sa >= 0) == (sb >= 0)) continue;
    dvec3 p = a + (b - a) * (sa / (sa - sb));
    double towards = dot(p, ray.n);
    if (towards > 0 && towards <= ray.h) meet_place(ray.T + ray.h * dot(p, ray.direction) / towards, from);
  }
}

// Length within a region of the way back to the light, `r` [m] long, from the point `further` beyond `start`; d: from the
// light. All but `start` in single precision: near the region, however far the light is.
float way_to_light(int m, dvec3 start, vec3 further, vec3 d, float r) {
  int kind = media[m].region;
  float begin = 0, end = r;
  if (kind == region_sphere) {
    vec3 to_center = vec3(region_lo(m) - start) - further, across = cross(d, to_center);
    float radius = float(media[m].hi[0]), middle = -dot(to_center, d), reach2 = radius * radius - dot(across, across);
    float reach = sqrt(max(reach2, 0));
    begin = max(begin, middle - reach);
    end = reach2 > 0 ? min(end, middle + reach) : 0;
  } else if (kind != region_unbounded) {
    vec3 low, high, speed = -d;
    if (kind == region_slab) {  // as a box without ends across its normal
      dvec3 normal = region_lo(m), heights = region_hi(m) - dot(normal, start);
      float there = dot(vec3(normal), further);
      low = vec3(float(heights.x) - there, -1, -1);
      high = vec3(float(heights.y) - there, 1, 1);
      speed = vec3(dot(speed, vec3(normal)), 0, 0);
    } else {
      low = vec3(region_lo(m) - start) - further;
      high = vec3(region_hi(m) - start) - further;
    }
    bvec3 still = equal(speed, vec3(0));
    bool beside = any(bvec3(vec3(still) * vec3(greaterThan(max(low, -high), vec3(0)))));
    vec3 a = low / speed, b = high / speed, first = mix(min(a, b), vec3(0), still), last = mix(max(a, b), vec3(r), still);
    begin = max(begin, max(first.x, max(first.y, first.z)));
    end = beside ? 0 : min(end, min(last.x, min(last.y, last.z)));
  }
  return end > begin ? end - begin : 0;
}
#endif

#if PAPER_MEDIUM
#include "shadow_planes/paper_medium.glsl"
#else
// Over [from, to] [m], within which all is smooth; per W/sr of the light.
vec3 smooth_airlight(Ray ray, double from, double to) {
  float length_ = to < 1e30LF ? float(to - from) : 1e37, d0 = float(from - ray.T);
#if SPOT
  double x = to < 1e30LF ? 0.5LF * (from + to) : max(from, ray.T) + 1 + ray.h;
  if (dot(normalize(x * ray.direction - ray.to_light), spot_axis) <= cos_outer) return vec3(0);  // dark here
#endif
#if POLYNOMIAL
  float end = to < 1e30LF ? float(to - ray.T) : 1e37;
  if (!(ray.h > 0)) return vec3(0);
#else
  float h = floor_of_h(d0, length_, float(ray.h));
  if (!(h > 0)) return vec3(1e37);  // through the light itself
#endif
  vec3 result = vec3(0);
#if SPOT && !POLYNOMIAL
  Spot spot = spot_of(ray, from, h);
#endif
#if !BOUNDED
  vec3 extinction = extinction_of(air_medium);
  for (int c = 0; c < channels; ++c) {
    float k = extinction[c];
    if (!(k > 0)) continue;
#if POLYNOMIAL
    result[c] = polynomial_integral(k, float(ray.h), d0, end, float(k * (ray.T + ray.h)));
#else
    Mapped map = map_part(media[air_medium].phase.width, k, k, d0, length_, h);
    float sum = 0;
    for (int i = 0; i < rule_nodes; ++i) {
      Node node = node_of(map, i);
      float factor = exp(-k * h * node.further) * phase_of_halves(media[air_medium].phase, node.v, node.w);
#if SPOT
      factor *= spot_towards(spot, node.q, node.further);
#endif
      sum += node.weight * factor;
    }
    double way = from + sqrt((from - ray.T) * (from - ray.T) + ray.h * ray.h);
    result[c] = k / (4 * pi) * float(exp(-float(k * way))) * sum;
#endif
  }
  if (GREY != 0) result = vec3(result.x);
  return albedo_of(air_medium) * result;
#else
  dvec3 middle = ray.origin + (to < 1e30LF ? 0.5LF * (from + to) : from + 1) * ray.direction;
#if MOST_MEDIA > 32
#define HERE(m) here[(m) >> 5]
  uvec4 here = uvec4(0);  // a bit for each medium
#else
#define HERE(m) here
  uint here = 0u;
#endif
  vec3 extinction = vec3(0), before = depth_along(ray.origin, ray.direction, from);
  float width_ = 1;
  for (int m = 0; m < media_count; ++m)
    if (region_contains(m, middle)) {
      HERE(m) |= 1u << (m & 31);
      extinction += extinction_of(m);
      width_ = min(width_, media[m].phase.width);
    }
  vec3 n = vec3(ray.n), direction = vec3(ray.direction);
  dvec3 start = ray.origin + from * ray.direction;
  for (int c = 0; c < channels; ++c) {
    float k = extinction[c];
    if (!(k > 0)) continue;
    // The light's way may get less along the part, by as much as dims it where that begins.
    float dimmed = 0;
    vec3 first = vec3(start - light);
    for (int m = 0; m < media_count; ++m)
      dimmed += media[m].extinction[c] * way_to_light(m, start, vec3(0), first / max(length(first), 1e-30), length(first));
    Mapped map = map_part(width_, k, 0.5 * k * depth_cut / (depth_cut + dimmed), d0, length_, h);
    vec3 sum = vec3(0);
    for (int i = 0; i < rule_nodes; ++i) {
      Node node = node_of(map, i);
      vec3 d = 2 * node.q * node.v * n + (node.w - node.v) * direction;
      float r = 0.5 * h * (node.q + 1 / node.q);
      // x - from, which the difference of both places would lose digits of.
      float further = 0.5 * h * node.further * (1 + 1 / node.q / map.q0);
      float lost = before[c] + k * further;
      for (int m = 0; m < media_count; ++m)
        lost += media[m].extinction[c] * way_to_light(m, start, further * direction, d, r);
      vec3 scattered = vec3(0);
      for (int m = 0; m < media_count; ++m)
        if ((HERE(m) >> (m & 31) & 1u) != 0u)
          scattered += albedo_of(m) * media[m].extinction[c] * phase_of_halves(media[m].phase, node.v, node.w);
      float weight = node.weight * exp(-lost);
#if SPOT
      weight *= spot_towards(spot, node.q, node.further);
#endif
      sum += weight * scattered;
    }
    if (GREY != 0) return sum / (4 * pi);
    result[c] = sum[c] / (4 * pi);
  }
  return result;
#endif
}

// Over [from, to] [m], to 1e37 where the ray does not end; per W/sr of the light.
vec3 lit_airlight(Line line, double from, double to) {
#if !BOUNDED && !SPOT
  return smooth_airlight(ray_on(line), from, to);
#else
  vec3 sum = vec3(0);
  while (from < to) {
    Ray ray = ray_on(line);
    nearest_place = to;
#if SPOT
    meet_cone(ray, cos_inner, from);
    meet_cone(ray, cos_outer, from);
#endif
#if BOUNDED
    for (int m = 0; m < media_count; ++m) {
      dvec2 inside = clip_to_region(m, ray.origin, ray.direction, dvec2(0, 1e37LF));
      if (inside.y > inside.x) {
        meet_place(inside.x, from);
        meet_place(inside.y, from);
      }
      meet_kinks(ray, m, from);
    }
#endif
    sum += smooth_airlight(ray, from, nearest_place);
    from = nearest_place;
  }
  return sum;
#endif
}
#endif
