// Cubics between the entries of the tables here.
#pragma once

namespace airlight::wavelet_fog {

// From a at t = 0 to b at t = 1 with these slopes at the ends.
inline double hermite(double t, double a, double slope_a, double b, double slope_b) {
  const double w = 1 - t;
  return w * w * ((1 + 2 * t) * a + t * slope_a) + t * t * ((1 + 2 * w) * b - w * slope_b);
}

// From p[1] at t = 0 to p[2] at t = 1.
inline double catmull_rom(double t, const double (&p)[4]) {
  return p[1] +
         0.5 * t * (p[2] - p[0] + t * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] + t * (3 * (p[1] - p[2]) + p[3] - p[0])));
}

}  // namespace airlight::wavelet_fog
