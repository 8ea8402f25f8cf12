// One medium in a convex region in the paper's way, Biri et al. 2006, sections 4.2 and 5.2: methods/shadow_planes/
// paper_medium.cpp. Light reaches every point through a length R of it; the way to the eye begins where the ray enters.
uniform float mean_distance;  // R [m]

// The part of the ray in it.
dvec2 domain_of(Line line, double end) {
  return clip_to_region(air_medium, line.origin, line.direction, dvec2(0, end));
}

#if !POLYNOMIAL
// (1/h) integral over theta of `length_` [m] that begin `begin` [m] before the foot point, of e^(-k way), the phase function
// and the spot: PaperMedium::before_foot.
float before_foot(Ray ray, double from, float k, float h, float begin, float length_) {
  float least = min(length_, (depth_cut + log(1 + k * begin * (begin / h))) / k);
  float sum = 0, done = 0, q_first = exp(-arsinh(begin / h));
#if SPOT
  Spot spot = spot_of(ray, from, h);
#endif
  while (done < least) {
    float d = begin - done, t = arsinh(d / h), step_ = min(least - done, 4 / k);
    if (t > 8) step_ = min(step_, d - h * sinh(t - 8));
    float next = max(d - step_, 0);
    // The difference of both t.
    float span = arsinh(step_ * (d + next) / (d * hypotenuse(next, h) + next * hypotenuse(d, h)));
    float piece = 0, q_piece = exp(-t);
    for (int i = 0; i < rule_nodes; ++i) {
      float back = span * rule_node(i).x, q = exp(back - t), v = 1 / (1 + q * q), half_ = sinh_of(0.5 * back);
      float factor = exp(-k * 2 * h * cosh(t - 0.5 * back) * half_) * phase_of_halves(media[air_medium].phase, v, q * q * v);
#if SPOT
      factor *= spot_towards(spot, q, q_piece - q_first + q_piece * 2 * half_ * exp(0.5 * back));
#endif
      piece += rule_node(i).z * factor * 2 * q * v;
    }
    sum += exp(-k * done) * span * piece;
    done += step_;
  }
  return sum / h;
}
#endif

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
  for (int c = 0; c < channels; ++c) {
    float k = extinction[c];
    if (!(k > 0)) continue;
#if POLYNOMIAL
    // The way to the eye at theta = 0, which may lie outside.
    result[c] = polynomial_integral(k, h, d0, float(to - ray.T), float(k * (ray.T - x_in + mean_distance)));
#else
    float sum = 0;
    if (from < ray.T)
      sum = exp(-k * float(from - x_in + mean_distance)) * before_foot(ray, from, k, h, -d0, float(min(to, ray.T) - from));
    // Behind the foot point tan(theta) soon is q/2: the rule for integrands that fall as e^(-extinction h q).
    double start = max(from, ray.T);
    if (start < to) {
      float first = float(start - x_in + mean_distance);
      Mapped map = map_part(media[air_medium].phase.width, 0.5 * k, 0.5 * k, float(start - ray.T), float(to - start), h);
#if SPOT
      Spot spot = spot_of(ray, start, h);
#endif
      for (int i = 0; i < rule_nodes; ++i) {
        Node node = node_of(map, i);
        float further = 0.5 * h * node.further * (1 + 1 / node.q / map.q0);  // x - start
        float weight = node.weight * exp(-k * (first + further)) *
                       phase_of_halves(media[air_medium].phase, node.v, node.w);
#if SPOT
        weight *= spot_towards(spot, node.q, node.further);
#endif
        sum += weight;
      }
    }
    result[c] = k / (4 * pi) * sum;
#endif
  }
  if (GREY != 0) result = vec3(result.x);
  return albedo_of(air_medium) * result;
}

// Over what of [from, to] [m] is inside.
vec3 lit_airlight(Line line, double from, double to) {
  Ray ray = ray_on(line);
  dvec2 inside = domain_of(line, 1e37LF);
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
