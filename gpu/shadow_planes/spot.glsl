// A spot's penumbra in single precision: cosines of small angles are 1, so 1 - cosine is what is computed. Needs ray.glsl.
uniform dvec3 spot_axis;
uniform double cos_inner, cos_outer;

// The light's intensity over that on the axis, where the angle from there has 1 - its cosine. Called where it is not 0.
float spot_factor(float one_less_cosine) {
  float width_ = float(cos_inner - cos_outer), outer = float(1 - cos_outer);
  float u = width_ > 0 ? clamp((outer - one_less_cosine) / width_, 0, 1) : 1;
  return u * u * (3 - 2 * u);
}

// The axis as a part of a ray sees it, whose points are at q = tan(pi/4 + theta/2): `share` of it lies in the plane of ray
// and light, at q = p.
struct Spot {
  float share, rest;  // 1 - share
  float p, q0_less_p;
};
// `from` [m]: where the part begins.
Spot spot_of(Ray ray, double from, double h) {
  double n = dot(ray.n, spot_axis), w = dot(ray.direction, spot_axis), beside = dot(cross(ray.n, ray.direction), spot_axis);
  double share = sqrt(n * n + w * w), p = 1;
  if (share > 0) p = w > 0 ? (share + w) / (abs(n) > 1e-15LF ? n : 1e-15LF) : n / (share - w);
  double d = from - ray.T, r = sqrt(d * d + h * h), q0 = d > 0 ? (r + d) / h : h / (r - d);
  return Spot(float(share), float(beside * beside / (1 + share)), float(p), float(min(q0, 1e18LF) - p));
}
// Towards the point at q, `further` beyond where the part begins: 1 - cosine = rest + 2 share sin^2 of half the angle.
float spot_towards(Spot spot, float q, float further) {
  float tangent = (spot.q0_less_p + further) / (1 + q * spot.p), t2 = tangent * tangent;
  return spot_factor(spot.rest + 2 * spot.share * (t2 < 1e30 ? t2 / (1 + t2) : 1));
}

// Where the cones around the axis are crossed: (y . A)^2 = cos^2 |y|^2 on the right side. -1: nowhere.
dvec2 cross_cone(Ray ray, double cosine) {
  dvec3 y = -ray.to_light;
  double ya = dot(y, spot_axis), wa = dot(ray.direction, spot_axis), c2 = cosine * cosine;
  dvec2 places = roots_of(wa * wa - c2, ya * wa - c2 * dot(y, ray.direction), ya * ya - c2 * dot(y, y));
  return dvec2((ya + places.x * wa) * cosine < 0 ? -1 : places.x, (ya + places.y * wa) * cosine < 0 ? -1 : places.y);
}
