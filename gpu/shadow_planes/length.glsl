// Lengths on a ray as its light sees them, in single precision: methods/shadow_planes/mapped_rule.h.

// sqrt(x^2 + y^2) whose squares may overflow.
float hypotenuse(float x, float y) {
  float most = max(abs(x), abs(y)), share = min(abs(x), abs(y)) / max(most, 1e-37);
  return most * sqrt(1 + share * share);
}

// Inverse hyperbolic sine and hyperbolic sine, of x >= 0, without losing digits of small ones.
float arsinh(float x) {
  if (x > 0.3) return log(x) + log(1 + sqrt(1 + 1 / x / x));
  float y = x * x;
  return x * (1 - y * (1 / 6.0 - y * (3 / 40.0 - y * (5 / 112.0 - y * (35 / 1152.0 - y * 63 / 2816.0)))));
}
float sinh_of(float x) {
  if (x > 0.5) return sinh(x);
  float y = x * x;
  return x * (1 + y / 6 * (1 + y / 20 * (1 + y / 42 * (1 + y / 72))));
}

// tan(pi/4 + theta/2) at d [m] beyond the foot point, h > 0.
float q_at(float d, float h) {
  float r = hypotenuse(d, h);
  return d > 0 ? (r + d) / h : h / (r - d);
}

// The light's distance from a ray, kept from 0 where the light lies on it outside a part that begins d0 [m] beyond the foot
// point (methods/shadow_planes/mapped_rule.h); 0 if it lies on the part.
float floor_of_h(float d0, float length_, float h) { return max(h, 1e-12 * min(abs(d0), abs(d0 + length_))); }
