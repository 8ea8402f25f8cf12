#include "experiments/verify/ray_quadrature.h"

#include <Eigen/Core>
#include <cmath>

#include "scene/math/dense.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::experiments::verification {
namespace {

constexpr int points = 12, most_halvings = 40;

// Nodes and weights on [0, 1], and the integrals from 0 to node i of the polynomial that is 1 at node j and 0 at the others.
struct Panel {
  scene::GaussLegendre rule = scene::gauss_legendre(points);
  Eigen::MatrixXd up_to{points, points};
  Panel() {
    Eigen::MatrixXd powers(points, points), integrals(points, points);
    for (int i = 0; i < points; ++i)
      for (int k = 0; k < points; ++k) {
        // Legendre polynomials, and their integrals from -1.
        const double x = rule.node[std::size_t(i)];
        powers(i, k) = std::legendre(unsigned(k), x);
        integrals(i, k) =
            k == 0 ? x + 1 : (std::legendre(unsigned(k + 1), x) - std::legendre(unsigned(k - 1), x)) / (2 * k + 1);
      }
    up_to = 0.5 * integrals * scene::inverse(powers);
    for (double& x : rule.node) x = 0.5 * (1 + x);
    for (double& w : rule.weight) w *= 0.5;
  }
};

using Sampler = std::function<RaySample(double)>;

RayIntegral panel(const Sampler& sample, double lo, double hi) {
  static const Panel unit;
  Eigen::VectorXd extinction(points), source(points);
  for (int i = 0; i < points; ++i) {
    const RaySample s = sample(lo + (hi - lo) * unit.rule.node[std::size_t(i)]);
    extinction[i] = s.extinction;
    source[i] = s.source;
  }
  const Eigen::VectorXd depth = (hi - lo) * (unit.up_to * extinction);
  RayIntegral sum;
  for (int i = 0; i < points; ++i) {
    const double weight = (hi - lo) * unit.rule.weight[std::size_t(i)] * extinction[i];
    sum.depth += weight;
    sum.radiance += weight * source[i] * std::exp(-depth[i]);
  }
  return sum;
}

RayIntegral joined(const RayIntegral& near, const RayIntegral& far) {
  return {near.radiance + std::exp(-near.depth) * far.radiance, near.depth + far.depth};
}

RayIntegral refined(const Sampler& sample, double lo, double hi, const RayIntegral& whole, double tolerance, int left) {
  const double middle = 0.5 * (lo + hi);
  const RayIntegral near = panel(sample, lo, middle), far = panel(sample, middle, hi), both = joined(near, far);
  if (left == 0 || std::abs(both.radiance - whole.radiance) + std::abs(both.depth - whole.depth) <= tolerance)
    return both;
  return joined(refined(sample, lo, middle, near, tolerance, left - 1),
                refined(sample, middle, hi, far, tolerance, left - 1));
}

}  // namespace

RayIntegral integrate_ray(const Sampler& sample, const std::vector<double>& ends, double tolerance) {
  RayIntegral sum;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    if (ends[i] < ends[i + 1])
      sum = joined(
          sum, refined(sample, ends[i], ends[i + 1], panel(sample, ends[i], ends[i + 1]), tolerance, most_halvings));
  return sum;
}

}  // namespace airlight::experiments::verification
