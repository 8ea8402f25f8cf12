// Zhou et al. 2008, Eq. 9: the objective of a fit and its gradient.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "experiments/verify/readers.h"
#include "scene/convert/fit_objective.h"

namespace airlight::experiments::verification {
namespace {

using scene::Gaussian;

// A Gaussian in the unit cube, from "exp(-|x-(.5,.5,.5)|^2/0.04) at voxel centres (i+.5)/N, box [0,1]^3".
struct Density {
  Point3 center;
  double square;  // of the width
};

Density density_of(const Value& text) {
  Density d{};
  int end = 0;
  std::sscanf(text.text().c_str(), "exp(-|x-(%lf,%lf,%lf)|^2/%lf) at voxel centres (i+.5)/N, box [0,1]^3%n",
              &d.center[0], &d.center[1], &d.center[2], &d.square, &end);
  if (!end || text.text().c_str()[end] || !d.center.allFinite() || !(d.square > 1e-6 && d.square < 1e6))
    text.complain("exp(-|x-(X,Y,Z)|^2/SQUARE) at voxel centres (i+.5)/N, box [0,1]^3");
  return d;
}

std::vector<double> values_of(const Density& d, int n) {
  std::vector<double> values;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        values.push_back(
            std::exp(-(Point3((i + 0.5) / n, (j + 0.5) / n, (k + 0.5) / n) - d.center).squaredNorm() / d.square));
  return values;
}

}  // namespace

Check read_fit_objective(const Value& v) {
  const Value input = v["input"], expected = v["expected"], rows = input["rbf_x_y_z_r_w"];
  const int n = input["grid"].integer_in(1, 64);
  const double cut = input["cut"].number_in(1e-3, 1e3);
  const double rtol = v["rtol"].number(), atol = v["atol"].number();
  const Density density = density_of(input["density"]);
  // Positions in the unit cube as positions in samples, of which there are n to the unit.
  std::vector<Gaussian> gaussians;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> g = rows[i].numbers();
    if (g.size() != 5) rows[i].complain("x, y, z, r and w");
    gaussians.push_back({Point3(g[0], g[1], g[2]) * n - Point3::Constant(0.5), g[3] * n, g[4]});
  }
  const double objective = expected["objective"].number(), squares = expected["sum_D2"].number();
  const std::vector<double> gradient = expected["gradient"].numbers();
  if (gradient.size() != 5 * gaussians.size()) expected["gradient"].complain("five numbers for every Gaussian");
  return {"",
          [=](VerifyProfile) {
            const std::vector<double> values = values_of(density, n);
            scene::FitObjective<double> fit({n, n, n}, values.data(), 1, cut, 0);
            std::vector<double> got(gradient.size());
            Outcome out;
            out.add(relative("objective", objective, fit.value(gaussians, got.data()), rtol, atol));
            out.add(relative("sum D^2", squares, fit.sum_of_squares(), rtol, atol));
            for (std::size_t i = 0; i < gradient.size(); ++i)
              out.add(relative(fmt::format("gradient {}", i), gradient[i], got[i] * (i % 5 == 4 ? 1 : n), rtol, atol));
            return out;
          },
          nullptr, "fits are made on the processor"};
}

}  // namespace airlight::experiments::verification
