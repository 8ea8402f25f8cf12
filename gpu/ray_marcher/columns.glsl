// Integrals of densities from a point towards a light: reference/ray_marcher/columns.cpp and its kernels.
// DEPTHS: 0 media dim no light on its way, 1 columns, 2 maps of the lights.
uint shadow_step_count = 0;  // density evaluations of this invocation

#if DEPTHS > 0
// Column of layer k's constant along a ray that is clipped to the region [m].
float constant_column(int k, vec2 t) {
  return layers[k].constant > 0 && t.x < t.y ? min(layers[k].constant * min(t.y - t.x, endless), endless) : 0;
}
#endif

#if DEPTHS == 2
#include "light_map/look_up.glsl"
vec3 depth_towards(int l, vec3 x, vec3 direction, float distance_) {
  vec3 depth = mapped_depth(l, x);
  for (int k = 0; k < layer_count; ++k)
    if (layers[k].constant > 0)
      depth += layers[k].sigma_t * constant_column(k, clip_region(k, x, direction, vec2(0, distance_)));
  return depth;
}
#elif DEPTHS == 0
vec3 depth_towards(int l, vec3 x, vec3 direction, float distance_) { return vec3(0); }
#else
#include "common/error_function.glsl"
uniform int shadow_steps;
uniform float shadow_step;  // [m]; > 0: instead of the count
uniform int exact_shadow;

float steps_of(float length_) {
  return shadow_step > 0 ? clamp(ceil(length_ / shadow_step), 1, 1048576) : float(shadow_steps);
}

#if GRIDS
float grid_column(int k, vec3 o, vec3 d, vec2 t) {
  float length_ = t.y - t.x, n = steps_of(length_), h = length_ / n, sum = 0;
  vec3 start = o + (t.x + 0.5 * h) * d, delta = h * d;
  float pace = 1 / max(max(abs(delta.x), abs(delta.y)), abs(delta.z));  // steps per cell of the largest component
  for (float i = 0; i < n; ++i) {
    vec3 p = start + i * delta;
    float value = grid_density(k, p);
    sum += value;
    ++shadow_step_count;
    ++work;
    if (skip_empty != 0 && value == 0) i += floor(max(free_at(k, p), 0) * pace);
  }
  return sum * h;
}

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
// A Gaussian along a ray: amplitude * exp(-(near2 + ((t - middle) * rate)^2)), for |t - middle| <= spread.
struct Profile {
  bool met;
  float middle, rate, near2, spread;
};
Profile profile(Gaussian g, vec3 o, vec3 d) {
  Profile p;
  vec3 q = g.inverse_width * (g.center - o), w = g.inverse_width * d;
  float rate2 = dot(w, w);
  p.rate = sqrt(rate2);
  p.middle = dot(q, w) / rate2;
  vec3 away = q - p.middle * w;  // not |q|^2 less its part along the ray, which loses all digits far away
  p.near2 = dot(away, away);
  p.met = p.near2 <= g.limit;
  p.spread = sqrt(max(0, g.limit - p.near2)) / p.rate;
  return p;
}

float gaussian_column(int k, vec3 o, vec3 d, vec2 t) {
  float length_ = t.y - t.x, n = steps_of(length_), h = length_ / n, sum = 0;
  shadow_step_count += uint(n);
  work += uint(layers[k].count);
  if (layers[k].negative != 0) {
    // The clamp at zero density acts on the sum of all Gaussians at each step.
    for (float j = 0; j < n; ++j) sum += gaussian_density(k, o + (t.x + (j + 0.5) * h) * d);
    return sum * h;
  }
  for (int i = layers[k].first; i < layers[k].first + layers[k].count; ++i) {
    Gaussian g = gaussian_at(i);
    Profile p = profile(g, o, d);
    if (!p.met) continue;
    // Steps within reach.
    float from = max(floor((p.middle - p.spread - t.x) / h - 1), 0), to = min(n, (p.middle + p.spread - t.x) / h + 1);
    float u0 = p.rate * (t.x + 0.5 * h - p.middle), du = p.rate * h, part = 0;
    work += uint(max(to - from, 0)) / 4;
    for (float j = from; j < to; j += 4) {
      vec4 at = j + vec4(0, 1, 2, 3), u = u0 + at * du, d2 = u * u + p.near2;
      bvec4 counts = bvec4(uvec4(lessThan(at, vec4(to))) & uvec4(lessThanEqual(d2, vec4(g.limit))));
      part += dot(mix(vec4(0), exp(-d2), counts), vec4(1));
    }
    sum += g.amplitude * part;
  }
  return sum * h;
}

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
#endif

#if SERIES
float series_column(int k, vec3 o, vec3 d, vec2 t) {
  float n = steps_of(t.y - t.x), h = (t.y - t.x) / n, sum = 0;
  shadow_step_count += uint(n);
  for (float i = 0; i < n; ++i) sum += local_density(k, o + (t.x + (i + 0.5) * h) * d);
  work += uint(n);
  return sum * h;
}
#endif

#if GRIDS || GAUSSIANS || SERIES
uniform float deepest_shadow_step;

// reference/ray_marcher/depth.h: is the first step deep, and the column of such a ray. Beyond 20 optical depths, 2e-9 of
// the light, steps are as they come: plan.cpp bounds their number.
bool starts_deep(int k, vec3 o, vec3 d, vec2 t) {
  float h = (t.y - t.x) / steps_of(t.y - t.x), least = deepest_shadow_step;
  return layers[k].most_varied * layers[k].thickest * h > least &&
         local_density(k, o + t.x * d) * layers[k].thickest * h > least;
}
float deep_column(int k, vec3 o, vec3 d, vec2 t) {
  float n = steps_of(t.y - t.x), whole = (t.y - t.x) / n, column = 0, thickest = layers[k].thickest;
  float i = 0, from = 0, width_ = 1;
  while (i < n && column * thickest < 750) {
    ++work;
    float lo = t.x + (i + from) * whole, h = width_ * whole;
    float first = local_density(k, o + lo * d), middle = local_density(k, o + (lo + 0.5 * h) * d),
          last = local_density(k, o + (lo + h) * d);
    if (column * thickest < 20 && width_ > 1.0 / 16777216 &&
        max(max(first, middle), last) * thickest * h > deepest_shadow_step) {
      width_ *= 0.5;
      continue;
    }
    column += (first + 4 * middle + last) / 6 * h;
    ++shadow_step_count;
    from += width_;
    while (from < 1 && fract(from / (2 * width_)) == 0) width_ *= 2;
    if (from >= 1) {
      ++i;
      from = 0;
      width_ = 1;
    }
  }
  return column;
}
#endif

// Column of layer k from x over a distance in a unit direction [m].
float column_of(int k, vec3 x, vec3 direction, float distance_) {
  vec2 t = clip_region(k, x, direction, vec2(0, distance_));
  if (!(t.x < t.y)) return 0;
  float column = constant_column(k, t);
  if (layers[k].field == field_none) return column;
  t = clip_field(k, x, direction, t);
  if (!(t.x < t.y)) return column;
  vec3 o = to_local(layers[k].field_frame, x), d = rotate_to_local(layers[k].field_frame, direction);
#if GRIDS || GAUSSIANS || SERIES
  if (exact_shadow == 0 && starts_deep(k, o, d, t)) return column + deep_column(k, o, d, t);
#endif
#if GRIDS
  if (layers[k].field == field_grid) return column + (exact_shadow != 0 ? grid_integral(k, o, d, t) : grid_column(k, o, d, t));
#endif
#if SERIES
  if (layers[k].field == field_map || layers[k].field == field_series) return column + series_column(k, o, d, t);
#endif
#if GAUSSIANS
  return column + (exact_shadow != 0 ? gaussian_integral(k, o, d, t) : gaussian_column(k, o, d, t));
#endif
  return column;
}

// Optical depth of all media from x to light l, which lies in a unit direction and at a distance [m].
vec3 depth_towards(int l, vec3 x, vec3 direction, float distance_) {
  vec3 depth = vec3(0);
  for (int k = 0; k < layer_count; ++k) depth += layers[k].sigma_t * column_of(k, x, direction, distance_);
  return depth;
}
#endif
