#include "scene/media/gaussian_line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/math/special_functions.h"

namespace airlight::scene {
namespace {

// Eight-point Gauss-Legendre rule on [0, 1], symmetric: four nodes and weights.
constexpr double gauss_node[4] = {0.01985507175123188416, 0.1016667612931866302, 0.2372337950418355071,
                                  0.4082826787521750975};
constexpr double gauss_weight[4] = {0.05061426814518812958, 0.1111905172266872353, 0.1568533229389436437,
                                    0.1813418916891809915};

const double half_sqrt_pi = 0.5 * std::sqrt(pi);

}  // namespace

GaussianLine gaussian_line(const Gaussian& g, const Ray& ray) {
  const Vec3 to_center = g.center - ray.origin;
  return {1 / g.width, to_center.dot(ray.direction), ray.direction.cross(to_center).squaredNorm() / (g.width * g.width),
          g.amplitude};
}

Interval GaussianLine::clip(double cutoff, Interval t) const {
  if (cutoff == infinity) return t;
  const double reach2 = cutoff * cutoff - exponent;
  if (!(reach2 > 0)) return {};
  const double reach = std::sqrt(reach2) / a;
  return intersect(t, {middle - reach, middle + reach});
}

double GaussianLine::integral(Interval t) const {
  if (t.empty() || amplitude == 0 || exponent > 746) return 0;
  double t1 = a * (t.lo - middle);
  double t2 = a * (t.hi - middle);
  const double length = a * (t.hi - t.lo);
  if (length * (1 + std::abs(t1)) < 0.5) {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const double left = t1 + gauss_node[k] * length;
      const double right = t1 + (1 - gauss_node[k]) * length;
      sum += gauss_weight[k] * (std::exp(-exponent - left * left) + std::exp(-exponent - right * right));
    }
    return amplitude * (t.hi - t.lo) * sum;
  }
  if (t2 < 0) {
    std::swap(t1, t2);
    t1 = -t1;
    t2 = -t2;
  }
  const double scale = amplitude * half_sqrt_pi / a;
  if (t1 > 0) {
    // Both ends on one side of the peak: the error functions agree in all their digits far out.
    double difference = erfcx(t1);
    if (t2 < infinity) difference -= std::exp(-length * (t1 + t2)) * erfcx(t2);
    return scale * std::exp(-exponent - t1 * t1) * difference;
  }
  return scale * std::exp(-exponent) * (std::erf(t2) - std::erf(t1));
}

}  // namespace airlight::scene
