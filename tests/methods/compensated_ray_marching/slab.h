// A slab between two vacua under isotropic light, by the solver for boxes: two axes are endless. Values between nodes
// are integrated along single directions.
#pragma once
#include <cmath>
#include <functional>

#include "methods/compensated_ray_marching/discrete_ordinates.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::test {

namespace crm = compensated_ray_marching;

inline double legendre(int l, double x) { return std::legendre(unsigned(l), x); }

class Slab {
 public:
  double thickness = 1, albedo = 0.9, g = 0, inflow_top = 1, inflow_bottom = 0, emission = 0;
  std::function<double(double)> extinction = [](double) { return 1.0; };
  std::function<double(double)> depth = [](double z) { return z; };  // optical, from the top

  crm::OrdinateSolution solve(int cells, int levels, double tolerance = 1e-7) {
    n = cells;
    crm::OrdinateGrid grid{{1, 1, cells}, {1, 1, thickness / cells}, {true, true, false}};
    Eigen::ArrayXd of_node(cells);
    source = crm::Moments::Zero(cells, 16);
    for (int i = 0; i < cells; ++i) {
      const double z = height(i);
      of_node[i] = extinction(z);
      for (int l = 0; l < 4; ++l)
        source(i, l * (l + 1)) = std::sqrt(4 * pi * (2 * l + 1)) *
                                 (albedo * std::pow(g, l) * reduced_moment(l, z) + (l == 0 ? emission : 0));
    }
    crm::OrdinateOptions options;
    options.levels = levels;
    options.tolerance = tolerance;
    options.iterations = 2000;
    const crm::DiscreteOrdinates solver(grid, of_node, albedo, {1, g, g * g, g * g * g}, options);
    crm::OrdinateSolution solution = solver.solve(source);
    source = solution.source;
    return solution;
  }

  // 1/2 of the integral of P_l times the light that nothing has scattered.
  double reduced_moment(int l, double z) const {
    return 0.5 * over_half([&](double mu) {
             return legendre(l, mu) * inflow_top * std::exp(-depth(z) / mu) +
                    legendre(l, -mu) * inflow_bottom * std::exp(-(depth(thickness) - depth(z)) / mu);
           });
  }
  double mean_media_radiance(double z) const {
    return 0.5 * over_half([&](double mu) { return media_radiance(z, mu) + media_radiance(z, -mu); });
  }
  double radiance(double z, double mu) const {
    return media_radiance(z, mu) + (mu > 0 ? inflow_top * std::exp(-depth(z) / mu)
                                           : inflow_bottom * std::exp((depth(thickness) - depth(z)) / mu));
  }

 private:
  double height(double i) const { return (i + 0.5) * thickness / n; }
  static double over_half(const std::function<double(double)>& f) {
    static const scene::GaussLegendre rule = scene::gauss_legendre(96);
    double sum = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double u = 0.5 + 0.5 * rule.node[i];
      sum += 0.5 * rule.weight[i] * 2 * u * f(u * u);
    }
    return sum;
  }
  double emitted(int i, double mu) const {
    double sum = 0;
    for (int l = 0; l < 4; ++l) sum += source(i, l * (l + 1)) * std::sqrt((2 * l + 1) / (4 * pi)) * legendre(l, mu);
    return sum;
  }
  // At a face, as half a cell behind the last node.
  double emitted_at_face(bool top, double mu) const {
    const int last = top ? 0 : n - 1, other = top ? 1 : n - 2;
    return std::max(0.0, 1.5 * emitted(last, mu) - 0.5 * emitted(other, mu));
  }
  // From the face where light comes in to z: the source linear in the depth from node to node.
  double media_radiance(double z, double mu) const {
    const bool falls = mu > 0;
    double at = falls ? 0 : thickness, before = emitted_at_face(falls, mu), light = 0;
    for (int i = falls ? 0 : n - 1; at != z; i += falls ? 1 : -1) {
      const bool beyond = i < 0 || i >= n;
      const double next = beyond ? (falls ? thickness : 0) : height(i),
                   end = falls ? std::min(next, z) : std::max(next, z);
      double here = beyond ? emitted_at_face(!falls, mu) : emitted(i, mu);
      here = before + (here - before) * (depth(end) - depth(at)) / (depth(next) - depth(at));
      const double t = std::abs((depth(end) - depth(at)) / mu), passed = std::exp(-t);
      const double mean = t < 1e-4 ? 1 - t / 2 : (1 - passed) / t;
      light = light * passed + here * (1 - mean) + before * (mean - passed);
      at = end;
      before = here;
    }
    return light;
  }

  int n = 0;
  crm::Moments source;
};

}  // namespace airlight::test
