// Interface for another minimiser of our fit of Gaussians: the same objective from the same start within the same
// bounds; and our own minimisers, to be timed beside it. scripts/compare_lbfgsb builds and runs this.
//
//   airlight_fit_peer SIZE OCTAVES GAUSSIANS THREADS    curl noise of SIZE^3 samples
//
// It writes doubles: n, the 5 n variables of the start, 5 least and 5 greatest values of a Gaussian's, sum D^2. Then it answers, until its input
// ends, to doubles: 0 and 5 n variables by the objective and its 5 n derivatives; M, a number of iterations and 5 n variables by the
// objective at the end, seconds, evaluations and iterations of our minimiser M (1 or 2, as fit_methods()).
#include <cstdio>
#include <cstdlib>

#include "experiments/compensated_ray_marching/fitted_smoke.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/convert/fit_gauss_newton.h"
#include "scene/convert/fit_lbfgs.h"
#include "scene/convert/fit_placement.h"
#include "scene/convert/gaussian_fit.h"

namespace {

using namespace airlight::scene;
using airlight::Point3;
using Numbers = std::vector<double>;

bool read(double* to, std::size_t count) { return std::fread(to, sizeof *to, count, stdin) == count; }
void write(const Numbers& numbers) {
  if (std::fwrite(numbers.data(), sizeof(double), numbers.size(), stdout) != numbers.size() || std::fflush(stdout))
    std::exit(1);
}

Minimization minimise(FitMethod method, FitObjective<float>& objective, const FitBounds& bounds,
                      std::vector<Gaussian>& gaussians, const MinimizerOptions& options) {
  switch (method) {
    case FitMethod::gauss_newton:
      return minimize_gauss_newton(objective, bounds, gaussians, options);
    case FitMethod::lbfgs:
      return minimize_lbfgs(objective, bounds, gaussians, options);
  }
  throw airlight::Error("airlight_fit_peer: no such minimiser");
}

}  // namespace

int main(int count, char** words) try {
  if (count != 5) throw airlight::Error("usage: airlight_fit_peer SIZE OCTAVES GAUSSIANS THREADS");
  const VoxelGrid grid = airlight::experiments::noise_smoke(std::atoi(words[1]), 0, std::atoi(words[2]));
  const double scale = 1 / *std::max_element(grid.values.begin(), grid.values.end());
  const FitOptions fit;
  const double unit = fit_unit(grid) / grid.voxel_size, least = std::max(fit.widths.lo * unit, least_fit_width);
  const FitBounds bounds{{Point3::Constant(-0.5), grid.size.cast<double>().array() - 0.5},
                         {least, std::max(fit.widths.hi * unit, 2 * least)},
                         fit.amplitudes};
  FitObjective<float> objective(grid.size, grid.values.data(), scale, fit_cutoff, std::atoi(words[4]));
  // All where the mass is, as the first of a frame.
  std::vector<Gaussian> gaussians = place_gaussians(grid.size, grid.values.data(), scale, std::atoi(words[3]), bounds);
  minimize_gauss_newton(objective, bounds, gaussians, {5, 1e-6, {}}, true);

  Numbers start = {double(gaussians.size())}, gradient(5 * gaussians.size()), x(5 * gaussians.size());
  for (const Gaussian& g : gaussians)
    for (int v = 0; v < 5; ++v) start.push_back(variable(g, v));
  for (int v = 0; v < 5; ++v) start.push_back(bounds.lo(v));
  for (int v = 0; v < 5; ++v) start.push_back(bounds.hi(v));
  start.push_back(objective.sum_of_squares());
  write(start);

  for (double what = 0, iterations = 0; read(&what, 1);) {
    if ((what != 0 && !read(&iterations, 1)) || !read(x.data(), x.size())) break;
    for (std::size_t i = 0; i < x.size(); ++i) variable(gaussians[i / 5], int(i % 5)) = x[i];
    if (what == 0) {
      write({objective.value(gaussians, gradient.data())});
      write(gradient);
      continue;
    }
    const std::size_t before = objective.evaluations();
    Stopwatch watch;
    const Minimization done =
        minimise(FitMethod(int(what) - 1), objective, bounds, gaussians, {int(iterations), 0, {}});
    write({done.value, watch.lap(), double(objective.evaluations() - before), double(done.iterations)});
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
