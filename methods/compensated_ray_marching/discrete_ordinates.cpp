#include "methods/compensated_ray_marching/discrete_ordinates.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/math/dense.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr int kept = 5;  // iterations that are combined

}  // namespace

int fastest_axis(const OrdinateGrid& grid, const Vec3& direction) {
  int axis = -1;
  double fastest = -1;
  for (int a = 0; a < 3; ++a)
    if (const double speed = std::abs(direction[a]) / grid.cell[a]; !grid.endless[std::size_t(a)] && speed > fastest)
      fastest = speed, axis = a;
  return axis;
}

std::vector<std::vector<float>> open_ways(const OrdinateGrid& grid, const std::vector<Ordinate>& directions,
                                          const std::function<bool(Eigen::Index, const Vec3&)>& objects) {
  std::vector<std::vector<float>> open(directions.size(), std::vector<float>(std::size_t(grid.nodes()), 1.0f));
  tbb::parallel_for(std::size_t(0), directions.size(), [&](std::size_t d) {
    const int axis = fastest_axis(grid, directions[d].direction);
    const Vec3 back = -directions[d].direction * (grid.cell[axis] / std::abs(directions[d].direction[axis]));
    for (Eigen::Index node = 0; node < grid.nodes(); ++node)
      if (objects(node, back)) open[d][std::size_t(node)] = 0;
  });
  return open;
}

DiscreteOrdinates::DiscreteOrdinates(const OrdinateGrid& grid, Eigen::ArrayXd extinction, double albedo,
                                     std::vector<double> phase, const OrdinateOptions& options,
                                     std::vector<std::vector<float>> open)
    : grid_(grid),
      extinction_(std::move(extinction)),
      albedo_(albedo),
      phase_(std::move(phase)),
      options_(options),
      directions_(ordinate_directions(options.levels, options.azimuths, options.hemispheres)),
      open_(std::move(open)) {
  int ends = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (grid.size[a] < 1 || !(grid.cell[Eigen::Index(a)] > 0) || (grid.endless[a] && grid.size[a] != 1))
      throw Error("discrete ordinates: a grid without cells, or of several along an endless axis");
    ends += !grid.endless[a];
  }
  if (ends == 0) throw Error("discrete ordinates: a grid without ends");
  if (extinction_.size() != grid.nodes() || !extinction_.allFinite() || !(extinction_ >= 0).all())
    throw Error(fmt::format("discrete ordinates: found {} extinctions, expected {}, finite and not below 0",
                            extinction_.size(), grid.nodes()));
  if (!(albedo >= 0 && albedo <= 1)) throw Error(fmt::format("discrete ordinates: albedo {}, expected 0 to 1", albedo));
  if (options.order < 1 || options.order > 6 || int(phase_.size()) < options.order)
    throw Error("discrete ordinates: expected an order of 1 to 6, and a moment of the phase function for each band");
  for (const std::vector<float>& one : open_)
    if (open_.size() != directions_.size() || one.size() != std::size_t(grid.nodes()))
      throw Error("discrete ordinates: expected open ways for every direction and node, or none");
}

double DiscreteOrdinates::deepest_cell() const {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a)
    if (!grid_.endless[a]) longest = std::max(longest, grid_.cell[Eigen::Index(a)]);
  return extinction_.maxCoeff() * longest;
}

// J = J_ss + albedo p_l M_lm(J): iterated, each time from the combination of the last few that leaves the least (Anderson 1965, which is
// GMRES for a linear problem), so that thick smoke of albedo 1 takes tens of iterations instead of thousands.
OrdinateSolution DiscreteOrdinates::solve(const Moments& source, double inflow, const Moments* before,
                                          const std::function<bool()>& interrupted) const {
  const int bands = options_.order * options_.order;
  if (source.rows() != grid_.nodes() || source.cols() % bands != 0 || !source.allFinite() ||
      (before && (before->rows() != source.rows() || before->cols() != source.cols())))
    throw Error("discrete ordinates: a source that does not fit the grid and the order, or is not finite");
  const int lights = int(source.cols()) / bands;
  // Inner product of the mean radiances (band 0), weighted with the squared extinction.
  const auto product = [&](const Moments& a, const Moments& b) {
    double sum = 0;
    for (int l = 0; l < lights; ++l) sum += (extinction_.square() * a.col(l * bands) * b.col(l * bands)).sum();
    return sum;
  };
  OrdinateSolution solution;
  Moments& at = solution.source;
  at = before ? *before : source;
  std::vector<Moments> steps, residual_steps;  // differences of results and of their residuals
  Moments last_at, last_result, last_residual;
  double least = 1;  // by how much of its own size a part of the error shows in the residual
  while (solution.iterations < options_.iterations && !(interrupted && interrupted())) {
    solution.radiance = sweep(at, inflow);
    if (factors_.size() > 0) solution.radiance.colwise() *= factors_;
    ++solution.iterations;
    Moments result = source;
    for (Eigen::Index c = 0; c < source.cols(); ++c)
      result.col(c) += albedo_ * phase_[std::size_t(std::sqrt(double(c % bands)))] * solution.radiance.col(c);
    Moments residual = result - at;
    if (solution.iterations > 1) {
      steps.push_back(result - last_result);
      residual_steps.push_back(residual - last_residual);
      if (int(steps.size()) > kept) steps.erase(steps.begin()), residual_steps.erase(residual_steps.begin());
      last_at = at - last_at;
      if (const double moved = product(last_at, last_at); moved > 0)
        least = std::min(least, std::sqrt(product(residual_steps.back(), residual_steps.back()) / moved));
    }
    const double size = product(residual, residual), whole = product(result, result);
    solution.error = size == 0 ? 0 : std::sqrt(size / whole) / std::max(least, 1e-6);
    if (size == 0 || (solution.iterations > 1 && solution.error <= options_.tolerance)) {
      at = std::move(result);
      break;
    }
    last_at = std::move(at);
    last_residual = residual;
    at = last_result = std::move(result);
    if (steps.empty()) continue;
    const int n = int(steps.size());
    Eigen::MatrixXd gram(n, n);
    Eigen::VectorXd right(n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j)
        gram(i, j) = gram(j, i) = product(residual_steps[std::size_t(i)], residual_steps[std::size_t(j)]);
      right[i] = product(residual_steps[std::size_t(i)], residual);
    }
    const Eigen::VectorXd shares = scene::LeastNormFactors(gram).solve(right);
    for (int i = 0; i < n; ++i) at -= shares[i] * steps[std::size_t(i)];
  }
  return solution;
}

}  // namespace airlight::compensated_ray_marching
