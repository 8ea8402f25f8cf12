// Columns of what varies, by steps: the kernels of reference/ray_marcher.
uniform int shadow_steps;
uniform float shadow_step;  // [m]; > 0: instead of the count

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
#endif

#if GAUSSIANS
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
#endif

#if OTHER_FIELDS
float series_column(int k, vec3 o, vec3 d, vec2 t) {
  float n = steps_of(t.y - t.x), h = (t.y - t.x) / n, sum = 0;
  shadow_step_count += uint(n);
  for (float i = 0; i < n; ++i) sum += local_density(k, o + (t.x + (i + 0.5) * h) * d);
  work += uint(n);
  return sum * h;
}
#endif

#if GRIDS || GAUSSIANS || OTHER_FIELDS
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

// Column of layer k along a ray in its own coordinates [m].
float varied_column(int k, vec3 o, vec3 d, vec2 t) {
#if GRIDS || GAUSSIANS || OTHER_FIELDS
  if (starts_deep(k, o, d, t)) return deep_column(k, o, d, t);
#endif
#if GRIDS
  if (layers[k].field == field_grid) return grid_column(k, o, d, t);
#endif
#if OTHER_FIELDS
  if (layers[k].field == field_map || layers[k].field == field_series) return series_column(k, o, d, t);
#endif
#if GAUSSIANS
  return gaussian_column(k, o, d, t);
#endif
  return 0;
}
