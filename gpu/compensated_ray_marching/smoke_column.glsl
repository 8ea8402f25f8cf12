// How much smoke there is from a point to infinity in one direction, after smoke_density.glsl. Places relative to the middle of the smoke.
#include "common/error_function.glsl"
#include "common/loops_cut.glsl"
#ifdef TO_LIGHT_OF_LANE
vec3 to_light;
#else
uniform vec3 to_light;
#endif
uniform float widths2;  // of Gaussians: where they end, in widths, squared

#if GAUSSIANS
// Zhou et al. 2007, Eq. 31 from a point to infinity [m].
float column_of(Gaussian g, vec3 origin, vec2 region) {
  float nearest, aside, column = 0;
  vec2 part = within(g, widths2, origin, to_light, nearest, aside);
  part = vec2(max(part.x, region.x), min(part.y, region.y));
  if (part.x < part.y && part.y > 0) {
    vec2 u = (vec2(max(part.x, 0), part.y) - nearest) / g.width;
    column = 0.886226925 * g.amplitude * g.width * exp(-aside) * (error_function(u.y) - error_function(u.x));
  }
  return column;
}
float column_from(vec3 origin) {
  float sum = 0;
  vec2 region = region_part(origin, to_light);
  for (int i = 0; i < gaussian_count; ++i) sum += column_of(gaussians[i], origin, region);
  return sum;
}
#else
// Between planes of samples density is a cubic along the ray: two Gauss points are exact [m].
float column_from(vec3 origin) {
  vec3 o = sample_at(origin), d = to_samples * to_light;
  vec2 region = region_part(origin, to_light);
  float begin = region.x, end = region.y, sum = 0;
  vec3 next, pace;  // [m] to the next plane of each axis, and from one to the next
  for (int a = 0; a < 3; ++a) {
    float lo = -border, hi = samples_along[a] - 1 + border;
    if (abs(d[a]) < 1e-20) {
      if (o[a] < lo || o[a] > hi) return 0;
      continue;
    }
    float p = (lo - o[a]) / d[a], q = (hi - o[a]) / d[a];
    begin = max(begin, min(p, q));
    end = min(end, max(p, q));
  }
  if (!(begin < end)) return 0;
  for (int a = 0; a < 3; ++a) {
    float here = o[a] + begin * d[a];
    pace[a] = abs(d[a]) < 1e-20 ? 1e37 : 1 / abs(d[a]);
    next[a] = abs(d[a]) < 1e-20 ? 1e37 : begin + (d[a] > 0 ? floor(here) + 1 - here : here - ceil(here) + 1) * pace[a];
  }
  while (begin < end) {
    int a = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
    float until = min(next[a], end), half_ = 0.5 * (until - begin), mid = begin + half_, off = 0.577350269 * half_;
    if (half_ > 0) sum += half_ * (density_at(origin + (mid - off) * to_light) + density_at(origin + (mid + off) * to_light));
    begin = max(until, begin);
    next[a] += pace[a];
  }
  return sum;
}
#endif
