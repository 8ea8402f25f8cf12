// The angle of (x, y) in [-pi, pi], to 1e-7 of itself. llvmpipe's atan is off by up to 3e-6, which is 2e-5 of a small angle
// and so of every airlight.
float angle_of(float y, float x) {
  float ax = abs(x), ay = abs(y), small = min(ax, ay), large = max(ax, ay);
  if (!(large > 0)) return 0;
  float z = small / large;
  // Above tan(pi/8) from pi/4; then a Chebyshev fit of atan(s)/s in w = s^2 over [0, tan(pi/8)^2], error 2e-8.
  const float step_ = 0.414213562373095;
  bool upper = z > step_;
  float s = upper ? (small - large) / (small + large) : z;  // tan(angle - pi/4)
  float w = s * s;
  float angle = s * (0.99999998 + w * (-0.33332797 + w * (0.19974405 + w * (-0.13851478 + w * 0.07984963))));
  if (upper) angle += 0.785398163397448;
  if (ay > ax) angle = 1.57079632679490 - angle;
  if (x < 0) angle = 3.14159265358979 - angle;
  return y < 0 ? -angle : angle;
}

// The tangent of an angle in [-0.47, 0.47], to 1.2e-7 of itself: a fit of tan(x)/x in w = x^2, error 1.2e-8. The tangent of GLSL
// has the absolute error of its sine, which may be 2^-11, and nothing of a small angle is left.
float tangent(float x) {
  float w = x * x;
  return x * (1.00000001 + w * (0.3333307 + w * (0.1334273 + w * (0.05280648 + w * 0.02758767))));
}
