// The paper's evaluator, Biri et al. 2006, section 4.1: methods/shadow_planes/polynomial.h about theta = 0. Its coefficients
// times e^a are polynomials in a = extinction * h, which come from there: the annex's or the right ones.
float coefficient(int i) { return evaluator[i >> 2][i & 3]; }  // [n][power of a]
uniform int degree;

// Airlight per unit of albedo and intensity over [d0, d1] [m] from the foot point; `depth` of the whole way there; h > 0 [m].
float polynomial_integral(float k, float h, float d0, float d1, float depth) {
  float a = k * h, begin = angle_of(d0, h), end = d1 < 1e30 ? angle_of(d1, h) : 0.5 * pi;
  float sum = 0, low = begin, high = end;
  for (int n = 0; n <= degree; ++n) {
    float c = 0;
    for (int power = degree; power >= 0; --power) c = c * a + coefficient(n * (degree + 1) + power);
    sum += c * (high - low) / float(n + 1);
    low *= begin;
    high *= end;
  }
  // Outside its range it is far off; it shall not be infinite.
  return clamp(k / (4 * pi * h) * exp(min(-depth, 80)) * sum, -1e30, 1e30);
}
