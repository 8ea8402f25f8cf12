// The integral that a march tends to: L = integral of s J exp(-depth) along a ray, by Gauss quadrature in panels that are halved until they
// agree, with ends wherever s is known to have a kink.
#pragma once
#include <functional>
#include <vector>

namespace airlight::experiments::verification {

struct RayIntegral {
  double radiance = 0, depth = 0;
};
struct RaySample {
  double extinction, source;  // s [1/m], J
};

// From the first of `ends` to the last (ascending, at least two). tolerance: of a panel's radiance and depth, absolute.
RayIntegral integrate_ray(const std::function<RaySample(double t)>&, const std::vector<double>& ends, double tolerance);

}  // namespace airlight::experiments::verification
