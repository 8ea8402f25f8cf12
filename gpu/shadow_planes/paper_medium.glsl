// One medium in a convex region in the paper's way, Biri et al. 2006, sections 4.2 and 5.2: methods/shadow_planes/
// paper_medium.cpp. Light reaches every point through a length R of it; the way to the eye begins where the ray enters.
uniform float mean_distance;  // R [m]

// The part of the ray in it.
dvec2 domain_of(Ray ray, double end) {
  return clip_to_region(air_medium, ray.origin, ray.direction, dvec2(0, end));
}

// Over [from, to] [m] inside, within which the light is smooth; per W/sr of it. x_in: where the ray enters.
vec3 smooth_airlight(Ray ray, double x_in, double from, double to) {
  float length_ = float(to - from), d0 = float(from - ray.T);
#if SPOT
  double x = 0.5LF * (from + to);
  if (dot(normalize(x * ray.direction - ray.to_light), spot_axis) <= cos_outer) return vec3(0);
#endif
  float h = floor_of_h(d0, length_, float(ray.h));
  if (!(h > 0)) return vec3(1e37);
  vec3 result = vec3(0), extinction = extinction_of(air_medium);
  float first = float(from - x_in) + mean_distance;
  for (int c = 0; c < channels; ++c) {
    float k = extinction[c];
    if (!(k > 0)) continue;
#if POLYNOMIAL
    // The way to the eye at theta = 0, which may lie outside.
    result[c] = polynomial_integral(k, h, d0, float(to - ray.T), float(k * (ray.T - x_in + mean_distance)));
#else
    // The rule for integrands that fall as e^(-extinction h q): far along the ray tan(theta) is q/2.
    Mapped map = map_part(media[air_medium].phase.width, 0.5 * k, d0, length_, h);
    float sum = 0;
    for (int i = 0; i < rule_nodes; ++i) {
      Node node = node_of(map, i);
      float further = 0.5 * h * node.further * (1 + 1 / node.q / map.q0);  // x - from
      float weight = node.weight * exp(-k * (first + further)) *
                     phase_of_halves(media[air_medium].phase, node.v, node.w);
#if SPOT
      weight *= spot_factor(2 * node.q * node.v * float(dot(ray.n, spot_axis)) +
                            (node.w - node.v) * float(dot(ray.direction, spot_axis)));
#endif
      sum += weight;
    }
    result[c] = k / (4 * pi) * sum;
#endif
  }
  if (GREY != 0) result = vec3(result.x);
  return albedo_of(air_medium) * result;
}

// Over what of [from, to] [m] is inside.
vec3 lit_airlight(Ray ray, double from, double to) {
  dvec2 inside = domain_of(ray, 1e37LF);
  from = max(from, inside.x);
  to = min(to, inside.y);
  vec3 sum = vec3(0);
  while (from < to) {
    double next = to;
#if SPOT
    nearest_place = to;
    meet_cone(ray, cos_inner, from);
    meet_cone(ray, cos_outer, from);
    next = nearest_place;
#endif
    sum += smooth_airlight(ray, inside.x, from, next);
    from = next;
  }
  return sum;
}
