// Lengths on a ray as its light sees them, in single precision: methods/shadow_planes/mapped_rule.h.

// sqrt(x^2 + y^2) whose squares may overflow.
float hypotenuse(float x, float y) {
  float most = max(abs(x), abs(y)), share = min(abs(x), abs(y)) / max(most, 1e-37);
  return most * sqrt(1 + share * share);
}

// tan(pi/4 + theta/2) at d [m] beyond the foot point, h > 0.
float q_at(float d, float h) {
  float r = hypotenuse(d, h);
  return d > 0 ? (r + d) / h : h / (r - d);
}

// The light's distance from a ray, kept from 0 where the light lies on it outside a part that begins d0 [m] beyond the foot
// point (methods/shadow_planes/mapped_rule.h); 0 if it lies on the part.
float floor_of_h(float d0, float length_, float h) { return max(h, 1e-12 * min(abs(d0), abs(d0 + length_))); }
