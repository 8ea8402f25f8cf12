// Columns of what varies, without steps: density_integral() of scene/media.
#if GRIDS
// From face to face of cells, where the density is a cubic along the ray: two Gauss points are exact.
float grid_integral(int k, vec3 o, vec3 d, vec2 t) {
  vec3 start = o + t.x * d, rate = mix(vec3(1e37), 1 / abs(d), greaterThan(abs(d), vec3(1e-30)));
  vec3 to_face = mix(start - (ceil(start) - 1), floor(start) + 1 - start, greaterThan(d, vec3(0)));
  float from = 0, end = t.y - t.x, sum = 0;
  while (from < end) {
    vec3 faces = to_face * rate;
    float to = min(min(faces.x, faces.y), min(faces.z, end)), middle = 0.5 * (from + to), off = 0.288675135 * (to - from);
    if (to > from) sum += 0.5 * (to - from) * (grid_density(k, start + (middle - off) * d) + grid_density(k, start + (middle + off) * d));
    to_face += vec3(lessThanEqual(faces, vec3(to)));
    from = to;
    ++work;
  }
  return sum;
}
#endif

#if GAUSSIANS
#include "common/error_function.glsl"

// Zhou et al. 2007, Eq. 31: sqrt(pi)/2 * amplitude * exp(-near^2) / rate * (erf(u1) - erf(u0)).
float gaussian_integral(int k, vec3 o, vec3 d, vec2 t) {
  float sum = 0;
  work += uint(layers[k].count);
  for (int i = layers[k].first; i < layers[k].first + layers[k].count; ++i) {
    Gaussian g = gaussian_at(i);
    Profile p = profile(g, o, d);
    if (!p.met) continue;
    float reach = p.rate * p.spread;  // where it is cut off, or as good as zero, is outside
    vec2 u = clamp(p.rate * (t - p.middle), -reach, reach);
    sum += 0.886226925 * g.amplitude * exp(-p.near2) / p.rate * (error_function(u.y) - error_function(u.x));
  }
  return sum;
}

// The sum of layer k's Gaussians with its constant, and its change along the ray, at t.
vec2 sum_and_slope(int k, vec3 o, vec3 d, float t) {
  vec2 sum = vec2(layers[k].constant, 0);
  for (int i = layers[k].first; i < layers[k].first + layers[k].count; ++i) {
    Gaussian g = gaussian_at(i);
    vec3 q = g.inverse_width * (o + t * d - g.center);
    float d2 = dot(q, q);
    if (d2 <= g.limit) sum += g.amplitude * exp(-d2) * vec2(1, -2 * g.inverse_width * dot(q, d));
  }
  return sum;
}

// Where the sum changes its sign. Twelve halvings leave 2e-4 of a step; the error does not count, because the sum is almost 0 there.
float sign_change(int k, vec3 o, vec3 d, float low, float high, bool rises) {
  for (int i = 0; i < 12; ++i) {
    float middle = 0.5 * (low + high);
    if ((sum_and_slope(k, o, d, middle).x >= 0) == rises)
      high = middle;
    else
      low = middle;
  }
  return 0.5 * (low + high);
}

// With negative Gaussians, less the constant where the sum is below 0 (scene/media/gaussian_clamped.cpp). Where one of them reaches the
// ray, places a quarter of the least width apart are looked at, and the turn between two of them.
float clamped_integral(int k, vec3 o, vec3 d, vec2 t) {
  vec2 reach = t.yx;
  float finest = far_away;
  for (int i = layers[k].first; i < layers[k].first + layers[k].count; ++i) {
    Gaussian g = gaussian_at(i);
    Profile p = profile(g, o, d);
    if (!p.met) continue;
    finest = min(finest, 1 / p.rate);
    if (g.amplitude < 0) reach = vec2(min(reach.x, p.middle - p.spread), max(reach.y, p.middle + p.spread));
  }
  reach = clamp(reach, t.x, t.y);
  float n = reach.x < reach.y ? ceil((reach.y - reach.x) / (0.25 * finest)) : 0;
  float low = reach.x, begin = t.x, sum = 0;  // `begin`: of the stretch in hand
  vec2 at_low = sum_and_slope(k, o, d, low);
  bool above = n == 0 || at_low.x >= 0;
  if (!above) {
    sum += gaussian_integral(k, o, d, vec2(t.x, low));
    begin = low;
  }
  for (float i = 1; i <= n; ++i) {
    float high = mix(reach.x, reach.y, i / n);
    vec2 at_high = sum_and_slope(k, o, d, high);
    float turn = low;
    if ((at_low.x >= 0) == (at_high.x >= 0) && (above ? at_low.y < 0 && at_high.y > 0 : at_low.y > 0 && at_high.y < 0)) {
      turn = mix(low, high, at_low.y / (at_low.y - at_high.y));
      if ((sum_and_slope(k, o, d, turn).x >= 0) == above) turn = low;
    }
    // To the turn, if the sign is another there, and from it; or in one go.
    for (int part = turn > low ? 0 : 1; part < 2; ++part) {
      float to = part == 0 ? turn : high;
      bool above_there = part == 0 ? !above : at_high.x >= 0;
      if (above_there != above) {
        float change = sign_change(k, o, d, low, to, above_there);
        sum += above ? gaussian_integral(k, o, d, vec2(begin, change)) : -layers[k].constant * (change - begin);
        begin = change;
        above = above_there;
      }
      low = to;
    }
    at_low = at_high;
  }
  work += uint(2 * n) * uint(layers[k].count);
  return sum + (above ? gaussian_integral(k, o, d, vec2(begin, t.y))
                      : gaussian_integral(k, o, d, vec2(low, t.y)) - layers[k].constant * (low - begin));
}
#endif

#if OTHER_FIELDS
const float deep_fall = 24;  // scale heights above which nothing is left in single precision

// From side to side of cells and height to height of knots, where the density is a polynomial of degree 7 at most: four Gauss points are
// exact. Parts of an exponential fall are half a scale height at most.
float map_integral(int k, vec3 o, vec3 d, vec2 t) {
  int at = layers[k].first, knots = layers[k].size.z;
  bool falls = layers[k].bricks.y == profile_exponential;
  float base = falls ? field_value[at + map_rows] : 0, scale_height = falls ? field_value[at + map_rows + 1] : 0;
  if (falls) t = clip_axis(o.y, d.y, -far_away, base + deep_fall * scale_height, t);
  vec3 start = o + t.x * d;
  vec2 place = place_on_map(k, start);
  vec2 along = vec2(dot(vec2(field_value[at], field_value[at + 1]), d.xz), dot(vec2(field_value[at + 3], field_value[at + 4]), d.xz));
  vec2 rate = mix(vec2(1e37), 1 / abs(along), greaterThan(abs(along), vec2(1e-30)));
  vec2 to_side = mix(place - (ceil(place) - 1), floor(place) + 1 - place, greaterThan(along, vec2(0)));
  float from = 0, end = t.y - t.x, sum = 0;
  while (from < end) {
    vec2 sides = to_side * rate;
    float to = min(min(sides.x, sides.y), end);
    for (int i = 0; i < knots && d.y != 0; ++i) {
      float there = (field_value[at + map_rows + 2 * i] - start.y) / d.y;
      if (there > from) to = min(to, there);
    }
    if (falls && start.y + 0.5 * (from + to) * d.y > base) to = min(to, from + 0.5 * scale_height / max(abs(d.y), 1e-30));
    float middle = 0.5 * (from + to), half_ = 0.5 * (to - from);
    const vec2 node = vec2(0.339981044, 0.861136312), weight = vec2(0.652145155, 0.347854845);
    float part = 0;
    for (int q = 0; q < 4; ++q) {
      float s = middle + (q < 2 ? half_ : -half_) * node[q & 1];
      part += weight[q & 1] * map_density(k, start + s * d);
    }
    if (to > from) sum += half_ * part;
    to_side += vec2(lessThanEqual(sides, vec2(to)));
    from = to;
    ++work;
  }
  return sum;
}
#endif

#ifdef SERIES  // points of the rule: there are Legendre boxes
layout(std140, binding = AT_LINE_RULE) uniform LineRule { vec4 rule[(SERIES + 1) * ((SERIES + 3) / 4)]; };
#define SERIES_FOURS ((SERIES + 3) / 4)
float density_at(int k, vec3 at) { return series_value(k, at); }
#include "common/sign_changes.glsl"

// A polynomial along the ray, where it is positive.
float series_integral(int k, vec3 o, vec3 d, vec2 t) {
  vec3 per_half = series_scale(k);
  float half_ = 0.5 * (t.y - t.x);
  vec4 c[SERIES_FOURS];
  series_of(k, per_half * (o + (t.x + half_) * d), per_half * half_ * d, c);
  work += uint(SERIES);
  return half_ * positive_part(c);
}
#endif

// Column of layer k along a ray in its own coordinates [m].
float varied_column(int k, vec3 o, vec3 d, vec2 t) {
#if GRIDS
  if (layers[k].field == field_grid) return grid_integral(k, o, d, t);
#endif
#ifdef SERIES
  if (layers[k].field == field_series) return series_integral(k, o, d, t);
#endif
#if OTHER_FIELDS
  if (layers[k].field == field_map) return map_integral(k, o, d, t);
#endif
#if GAUSSIANS
  return layers[k].negative != 0 ? clamped_integral(k, o, d, t) : gaussian_integral(k, o, d, t);
#endif
  return 0;
}
