// One step of a march: reference/ray_marcher/scalar.h; divided where it is deep: depth.h. Needs the state of march.comp.

// (1 - exp(-x)) / x, 1 at x = 0.
float mean_over_step(float x) { return x > 0 ? -exp_minus_one(-x) / x : 1; }
bool all_above(vec3 x, float limit) { return all(greaterThan(x, vec3(limit))); }

LIST(float, density_here, LAYERS);  // of each layer at a step

// Light of one lamp that a step scatters to the camera; x as for incidence().
void scatter(int l, Approach a, float x, vec3 point, vec3 direction, float length_, vec3 weight) {
  Light light = lights[l];
  Incidence from = incidence(light, a, x, direction, length_);
  if (from.strength == 0) return;
  work += uint(4 * LAYERS);
#if OCCLUDERS
  ++occlusion_ray_count;
  if (occluded(point, from.to_light, from.distance)) return;
#endif
  ++shadow_ray_count;
  vec3 arrives = from.strength * exp(-depth_towards(l, point, from.to_light, from.distance));
  vec3 less = from.to_light - direction, more = from.to_light + direction;
  float minus = 0.5 * dot(less, less), plus = 0.5 * dot(more, more);
  for (int k = 0; k < layer_count; ++k)
    airlight += light.colour * layers[k].albedo * layers[k].sigma_t * density_here[MINE(k)] *
                (weight * arrives * phase_value(layers[k].phase, layers[k].g, minus, plus));
}

// One step of a part, at t, and at x behind the light of an own march. Adds to the optical depth. False: no budget left,
// lights from at_light on have still to be done.
bool march_step(Part part, vec3 origin, vec3 direction, float t, float x, float length_, int own) {
  vec3 point = origin + t * direction;
  vec3 extinction = vec3(0);
  work += uint(4 * LAYERS);
  for (int k = 0; k < layer_count; ++k) {
    float density = (part.in_constant >> k & 1u) != 0u ? layers[k].constant : 0;
    if ((part.in_varied >> k & 1u) != 0u) density += varied_density(k, point);
    density_here[MINE(k)] = density;
    extinction += layers[k].sigma_t * density;
  }
  vec3 of_step = extinction * length_;
  vec3 weight = exp(-depth) * vec3(mean_over_step(of_step.x), mean_over_step(of_step.y), mean_over_step(of_step.z)) * length_;
  bool any_scatters = extinction * weight != vec3(0);
  int begin = own < 0 ? 0 : own, end = any_scatters ? (own < 0 ? light_count : own + 1) : begin;
  for (int l = max(begin, at_light); l < end; ++l) {
    if (own < 0 && l < balls && (own_marches[l >> 5] >> (l & 31) & 1u) != 0u) continue;
    if (out_of_budget()) {
      at_light = l;
      return false;
    }
    Approach a = approach(lights[l], origin, direction);
    scatter(l, a, own < 0 ? t - a.t : x, point, direction, length_, weight);
    moved = true;
  }
  at_light = 0;
  moved = true;
  step_count += uint(bitCount(part.in_varied));
  depth += of_step;
  return true;
}

// Steps that follow the optical depth: reference/ray_marcher/depth.h.
uniform float deepest_step;
const float least_width = 1.0 / 16777216;

vec3 extinction_at(Part part, vec3 point) {
  vec3 sum = vec3(0);
  for (int k = 0; k < layer_count; ++k) {
    float density = (part.in_constant >> k & 1u) != 0u ? layers[k].constant : 0;
    if ((part.in_varied >> k & 1u) != 0u) density += varied_density(k, point);
    sum += density * layers[k].sigma_t;
  }
  return sum;
}
bool is_deep(vec3 before, vec3 greatest, float length_, bool whole) {
  for (int c = 0; c < 3; ++c) {
    float own = greatest[c] * length_, most = whole ? 2 : 1;
    if (before[c] < deepest && own > most * deepest_step) return true;
  }
  return false;
}
bool may_be_deep(Part part, float length_) {
  vec3 most = vec3(0);
  for (int k = 0; k < layer_count; ++k) {
    if ((part.in_constant >> k & 1u) != 0u) most += layers[k].constant * layers[k].sigma_t;
    if ((part.in_varied >> k & 1u) != 0u) most += layers[k].most_varied * layers[k].sigma_t;
  }
  return is_deep(vec3(0), most, length_, true);
}

// A step that may be deep, [t, t + length] behind the light by x, from where it is. False: no budget left.
bool march_deep_step(Part part, vec3 origin, vec3 direction, float t, float x, float length_, int own) {
  while (at_from < 1) {
    if (out_of_budget()) return false;
    ++work;
    float lo = at_from * length_, h = at_width * length_, middle = lo + 0.5 * h;
    vec3 greatest = vec3(0);
    for (int i = 0; i < 3; ++i)
      greatest = max(greatest, extinction_at(part, origin + (t + lo + 0.5 * float(i) * h) * direction));
    if (at_width > least_width && is_deep(depth, greatest, h, at_width == 1)) {
      at_width *= 0.5;
      moved = true;
      continue;
    }
    ended = all_above(depth, darkest);
    if (ended) return true;
    if (!march_step(part, origin, direction, t + middle, x + middle, h, own)) return false;
    at_from += at_width;
    while (at_from < 1 && fract(at_from / (2 * at_width)) == 0) at_width *= 2;
  }
  at_from = 0;
  at_width = 1;
  return true;
}
