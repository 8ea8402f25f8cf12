#include "methods/compensated_ray_marching/lit_grid.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "methods/compensated_ray_marching/gaussian_columns.h"
#include "methods/compensated_ray_marching/grid_columns.h"
#include "methods/compensated_ray_marching/to_camera.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/base/stopwatch.h"
#include "scene/base/threads.h"
#include "scene/math/dense.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr int most_cells = 96;           // along a side, for cells that are not too deep
constexpr double least_share = 1e-6;     // of the greatest mean density: below it a cell counts as empty
constexpr double least_radiance = 1e-6;  // of the greatest
// Factor on deepest_cell for light from a single direction. Such light has creases where it enters by different faces.
// In a box 1.3 deep, cells miss the creases by 20 %, in one 0.8 deep by 6 %, in one 0.5 deep by 2 %.
constexpr double share_of_sharp_light = 1. / 3;
constexpr double least_again = 1e-6;  // of an even light: ordinates that scatter less keep what they have
constexpr std::size_t run = 64;       // nodes a task

// Sum of (2l+1)/(4 pi) moment_l P_l(c) [1/sr], of many cosines.
Eigen::ArrayXXd phase_in_bands(const std::vector<double>& moments, const Eigen::ArrayXXd& c) {
  Eigen::ArrayXXd before = Eigen::ArrayXXd::Zero(c.rows(), c.cols()), now = before + 1, sum = before;
  for (std::size_t l = 0; l < moments.size(); ++l) {
    const double n = double(l);
    sum += (2 * n + 1) * moments[l] * now;
    before = ((2 * n + 1) / (n + 1)) * c * now - (n / (n + 1)) * before;
    now.swap(before);
  }
  return sum / (4 * pi);
}

OrdinateOptions ordinate_options(const Options& options) {
  OrdinateOptions ordinates;
  ordinates.levels = options.grid.ordinate_levels;
  ordinates.azimuths = options.grid.azimuths;
  ordinates.order = options.order;
  ordinates.tolerance = options.tolerance;
  ordinates.iterations = options.iterations;
  return ordinates;
}

// Contribution of light of radiance 1 from a direction to each coefficient, without albedo and power; a
// row for each direction.
Eigen::MatrixXd scattered_by_direction(const std::vector<Vec3>& toward, int order, const std::vector<double>& moments) {
  const Eigen::Index bands = order * order;
  Eigen::MatrixXd scatters(Eigen::Index(toward.size()), bands);
  for (std::size_t k = 0; k < toward.size(); ++k) {
    const std::vector<double> harmonics = scene::evaluate_sh(order, -toward[k]);
    for (Eigen::Index b = 0; b < bands; ++b)
      scatters(Eigen::Index(k), b) = harmonics[std::size_t(b)] * moments[std::size_t(std::sqrt(double(b)))];
  }
  return scatters;
}

}  // namespace

LitGrid::LitGrid(const scene::Scene& scene, const scene::Medium& medium, const Options& options,
                 const IncomingLight& light, const scene::Execution& execution)
    : scene_(scene), medium_(medium), options_(options), phase_(phase_moments(medium.phase, options.grid.levels)) {
  scene::Stopwatch watch;
  find_nodes(light, execution);
  times_.push_back({"nodes", watch.lap()});
  fixed_ = light.fixed();
  add_depths(light, 0, execution);
  times_.push_back({"depths", watch.lap()});

  if (options.grid.multiple == Options::Grid::Multiple::none) {
    single_only_ = "not asked for";
    return;
  }
  const OrdinateOptions ordinates = ordinate_options(options);
  const double deepest = look_around(light, ordinates, execution);
  times_.back().seconds += watch.lap();
  double most = 0;  // of multiple scattering, as a share of the light
  for (int c = 0; c < 3; ++c) most = std::max(most, -medium.albedo[c] * std::expm1(-medium.sigma_t[c] * deepest));
  if (most < options.tolerance) {
    single_only_ = fmt::format("at most {:.2g} of the light is scattered again", most);
    return;
  }
  if (options.grid.multiple == Options::Grid::Multiple::ordinates && has_hard_edges(medium))
    find_balance(ordinates, execution);
  if (scene.geometry) find_open_ways(ordinates, execution);
}

// Cells as small as the smoke's depth asks for, and the nodes of those with smoke.
void LitGrid::find_nodes(const IncomingLight& light, const scene::Execution& execution) {
  const Box box = smoke_box(medium_);
  const bool sharp = has_hard_edges(medium_) && light.directions().size() > light.fixed();
  const double deepest_cell = options_.grid.deepest_cell * (sharp ? share_of_sharp_light : 1);
  for (int cells = options_.grid.cells;;) {
    grid_ = node_grid(box, cells);
    densities_ = mean_densities(medium_, grid_, execution.threads);
    deepest_ = medium_.sigma_t.maxCoeff() * densities_.maxCoeff() * grid_.cells.cell[0];
    if (deepest_ <= deepest_cell) break;
    const int needed = int(std::ceil(cells * deepest_ / deepest_cell));
    if (cells >= most_cells)
      throw scene::NotSupported(
          fmt::format("compensated_ray_marching: cells of the smoke's {} are {:.3g} deep: light would leak through; "
                      "settings.deepest_cell = {} allows {:.3g}",
                      cells, deepest_, options_.grid.deepest_cell, deepest_cell),
          "cells deeper than deepest_cell");
    cells = std::min(std::max(cells + 1, needed), most_cells);
  }
  nodes_ = compensated_ray_marching::nodes_with_smoke(grid_, densities_, least_share * densities_.maxCoeff());
  beyond_ = beyond_edges(medium_, grid_);
}

// Channels that have extinction and albedo in common are solved together. A device, which solves itself, never asks for this.
void LitGrid::find_channels() {
  if (!channels_.empty()) return;
  const OrdinateOptions ordinates = ordinate_options(options_);
  const Rgb &sigma_t = medium_.sigma_t, &albedo = medium_.albedo;
  const std::vector<double> moments(phase_moments(medium_.phase, options_.order));
  for (int c = 0; c < 3; ++c) {
    const auto alike = [&](const Channels& group) {
      return sigma_t[group.which[0]] == sigma_t[c] && albedo[group.which[0]] == albedo[c];
    };
    const auto known = std::find_if(channels_.begin(), channels_.end(), alike);
    if (known != channels_.end())
      known->which.push_back(c);
    else if (options_.grid.multiple == Options::Grid::Multiple::p1)
      channels_.push_back({{c},
                           {},
                           P1Grid(grid_.cells, sigma_t[c] * densities_, albedo[c], mean_cosine(medium_.phase),
                                  {options_.tolerance, options_.iterations}),
                           {}});
    else {
      channels_.push_back(
          {{c}, DiscreteOrdinates(grid_.cells, sigma_t[c] * densities_, albedo[c], moments, ordinates, open_), {}, {}});
      channels_.back().ordinates->scale(balance_[std::size_t(c)]);
    }
  }
}

// Transmitted share of an even light at the nodes; returns the deepest column [m]. Uses the directions of single
// scattering from an environment, if there is one, else those of the ordinates. Surfaces are left out.
double LitGrid::look_around(const IncomingLight& light, const OrdinateOptions& options,
                            const scene::Execution& execution) {
  const bool known = fixed_ > 0 && !scene_.geometry;
  const std::vector<Ordinate> directions =
      fixed_ > 0 ? light.fixed_directions()
                 : ordinate_directions(options.levels, options.azimuths, options.hemispheres);
  even_.setZero(Eigen::Index(nodes_.size()), 3);
  std::vector<float> deepest((nodes_.size() + run - 1) / run, 0.0F);
  in_columns(execution, [&](std::size_t first, std::size_t count, const auto& columns_towards) {
    std::vector<float> found(count);
    for (std::size_t k = 0; k < directions.size(); ++k) {
      if (!known) columns_towards(fixed_ > 0 ? directions[k].direction : Vec3(-directions[k].direction), found.data());
      const auto column =
          Eigen::Map<const Eigen::ArrayXf>(known ? columns_[k].data() + first : found.data(), Eigen::Index(count));
      for (int c = 0; c < 3; ++c)
        even_.col(c).segment(Eigen::Index(first), Eigen::Index(count)) +=
            directions[k].weight / (4 * pi) * (-medium_.sigma_t[c] * column.cast<double>()).exp();
      deepest[first / run] = std::max(deepest[first / run], column.maxCoeff());
    }
  });
  return deepest.empty() ? 0 : *std::max_element(deepest.begin(), deepest.end());
}

// Between nodes the ordinates see means of cells; the light that is scattered once is exact at nodes. Where cells are deep, or an edge runs
// through them, the two do not add up: of an even light of 1 that scatters without loss everything must be 1. So the ordinates' light is
// given what light scattered once leaves: then no light is made, and none is brighter than what comes in. Where density has no edges the
// two agree to second order without, and smoke 23 depths across is 1.6 times as wrong with it.
void LitGrid::find_balance(const OrdinateOptions& options, const scene::Execution& execution) {
  tbb::task_arena arena(scene::threads_for(execution.threads));
  OrdinateOptions of_means = options;
  of_means.order = 1;
  const double mean = std::sqrt(4 * pi);
  for (int c = 0; c < 3; ++c) {
    Eigen::ArrayXd& balance = balance_[std::size_t(c)];
    const int same = medium_.sigma_t[c] == medium_.sigma_t[0] ? 0 : medium_.sigma_t[c] == medium_.sigma_t[1] ? 1 : 2;
    if (same < c) {
      balance = balance_[std::size_t(same)];
      continue;
    }
    Moments again;
    arena.execute([&] {
      const DiscreteOrdinates even(grid_.cells, medium_.sigma_t[c] * densities_, 1, {1}, of_means);
      again = even.sweep(Moments::Constant(grid_.cells.nodes(), 1, mean), 0);
    });
    balance.setOnes(grid_.cells.nodes());
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (const double rest = again(nodes_[i], 0) / mean; rest > least_again)
        balance[nodes_[i]] = (1 - even_(Eigen::Index(i), c)) / rest;
  }
}

void LitGrid::find_open_ways(const OrdinateOptions& options, const scene::Execution& execution) {
  tbb::task_arena arena(scene::threads_for(execution.threads));
  arena.execute([&] {
    open_ = open_ways(grid_.cells, ordinate_directions(options.levels, options.azimuths, options.hemispheres),
                      [&](Eigen::Index node, const Vec3& back) {
                        return scene_.geometry->occluded({grid_.node(node), back.normalized()}, back.norm());
                      });
  });
}

// Calls of(first, count, columns_towards) for runs of nodes with smoke; columns_towards(direction, columns) finds theirs [m].
void LitGrid::in_columns(const scene::Execution& execution, const OfColumns& of) const {
  const auto* sum = std::get_if<scene::GaussianSum>(&medium_.field);
  std::optional<GaussianColumns> gaussians;
  if (sum && GaussianColumns::knows(*sum) && std::holds_alternative<scene::Unbounded>(medium_.region))
    gaussians.emplace(*sum);
  std::optional<GridColumns> voxels;
  if (const scene::VoxelGrid* grid = scene::grid_of(medium_.field); grid && GridColumns::knows(*grid))
    voxels.emplace(*grid);
  in_runs(execution, [&](std::size_t first, std::size_t count) {
    std::vector<Point3> points;
    for (std::size_t i = first; i < first + count; ++i) points.push_back(grid_.node(nodes_[i]));
    of(first, count, [&](const Vec3& direction, float* columns) {
      if (gaussians) return gaussians->from(points, direction, columns);
      if (voxels) return voxels->from(points, direction, medium_.region, columns);
      for (std::size_t i = 0; i < count; ++i)
        columns[i] = float(density_integral(medium_, {points[i], direction}, {0, infinity}));
    });
  });
}

void LitGrid::add_depths(const IncomingLight& light, std::size_t from, const scene::Execution& execution) {
  toward_ = light.directions();
  columns_.resize(from);
  columns_.resize(toward_.size(), std::vector<float>(nodes_.size()));
  in_columns(execution, [&](std::size_t first, std::size_t count, const auto& columns_towards) {
    for (std::size_t k = from; k < toward_.size(); ++k) {
      float* columns = columns_[k].data() + first;
      columns_towards(toward_[k], columns);
      if (!scene_.geometry) continue;
      for (std::size_t i = 0; i < count; ++i)
        if (scene_.geometry->occluded({grid_.node(nodes_[first + i]), toward_[k]}))
          columns[i] = std::numeric_limits<float>::infinity();
    }
  });
}

// In a node's row what the smoke leaves of the light of each direction.
Eigen::ArrayXXd LitGrid::left(std::size_t first, std::size_t count, double sigma_t) const {
  Eigen::ArrayXXd left(Eigen::Index(count), Eigen::Index(columns_.size()));
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const auto column =
        Eigen::Map<const Eigen::ArrayXf>(columns_[k].data() + first, Eigen::Index(count)).cast<double>();
    left.col(Eigen::Index(k)) = (column < infinity).select((-sigma_t * column).exp(), 0.0);
  }
  return left;
}

// Calls of(first, count) for runs of nodes with smoke.
void LitGrid::in_runs(const scene::Execution& execution,
                      const std::function<void(std::size_t, std::size_t)>& of) const {
  const std::size_t runs = (nodes_.size() + run - 1) / run;
  scene::parallel_for(int(runs), execution, [&](int row) {
    const std::size_t first = std::size_t(row) * run;
    of(first, std::min(run, nodes_.size() - first));
  });
}

bool LitGrid::aim(const IncomingLight& light, const scene::Execution& execution) {
  scene::Stopwatch watch;
  times_.clear();
  power_.resize(Eigen::Index(light.power().size()), 3);
  for (std::size_t k = 0; k < light.power().size(); ++k) power_.row(Eigen::Index(k)) = light.power()[k].transpose();
  if (light.directions().size() == toward_.size() && std::equal(toward_.begin() + long(light.fixed()), toward_.end(),
                                                                light.directions().begin() + long(light.fixed())))
    return false;
  add_depths(light, light.fixed(), execution);
  times_.push_back({"depths of directional lights", watch.lap()});
  return true;
}

void LitGrid::light(const IncomingLight& light, const scene::Execution& execution) {
  aim(light, execution);
  again_.clear();
  iterations_ = 0;
  error_ = 0;
  if (single_only_.empty() && !light.dark()) scatter_again(light, execution);
}

// J_ss of a group's lights at all nodes; `scatters`: scattered_by_direction.
Moments LitGrid::scatter_once(const Channels& group, std::size_t lights, const Eigen::MatrixXd& scatters,
                              const scene::Execution& execution) const {
  const Eigen::Index bands = scatters.cols();
  const double albedo = medium_.albedo[group.which[0]];
  Eigen::MatrixXd of_direction(scatters.rows(), Eigen::Index(lights) * bands);
  for (std::size_t l = 0; l < lights; ++l)
    of_direction.middleCols(Eigen::Index(l) * bands, bands) =
        (albedo * power_.col(group.which[l])).matrix().asDiagonal() * scatters;
  Moments source = Moments::Zero(grid_.cells.nodes(), of_direction.cols());
  in_runs(execution, [&](std::size_t first, std::size_t count) {
    const Eigen::MatrixXd single =
        scene::product(left(first, count, medium_.sigma_t[group.which[0]]).matrix(), of_direction);
    for (std::size_t i = 0; i < count; ++i) source.row(nodes_[first + i]) = single.row(Eigen::Index(i));
  });
  return source;
}

void LitGrid::scatter_again(const IncomingLight& light, const scene::Execution& execution) {
  scene::Stopwatch watch;
  find_channels();
  double single_seconds = 0, multiple_seconds = watch.lap();
  const int order = options_.order;
  const Eigen::Index bands = order * order;
  const std::vector<double> moments = phase_moments(medium_.phase, order);
  const Eigen::MatrixXd scatters = scattered_by_direction(toward_, order, moments);
  again_.assign(nodes_.size(), std::vector<Rgb>(std::size_t(bands), Rgb::Zero()));
  tbb::task_arena arena(scene::threads_for(execution.threads));
  std::atomic<bool> stopped{false};
  for (Channels& group : channels_) {
    // For light without colour one channel stands for all.
    const std::size_t lights = light.grey() ? 1 : group.which.size();
    const Moments source = scatter_once(group, lights, scatters, execution);
    single_seconds += watch.lap();
    const bool known = group.before && group.before->cols() == source.cols();
    const Moments* before = known ? &*group.before : nullptr;
    const auto interrupted = [&] {
      if (execution.progress && !execution.progress(1)) stopped = true;
      return stopped.load();
    };
    OrdinateSolution solution;
    if (group.ordinates) {
      arena.execute([&] { solution = group.ordinates->solve(source, 0, before, interrupted); });
    } else if (!interrupted()) {
      P1Solution p1 = group.diffusion->solve(source, order, before);
      solution = {p1.radiance, std::move(p1.radiance), p1.iterations, p1.error};
    }
    if (stopped) throw scene::Interrupted("interrupted");
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      for (std::size_t l = 0; l < group.which.size(); ++l)
        for (Eigen::Index b = 0; b < bands; ++b)
          again_[i][std::size_t(b)][group.which[l]] =
              medium_.albedo[group.which[0]] * moments[std::size_t(std::sqrt(double(b)))] *
              solution.radiance(nodes_[i], Eigen::Index(lights == 1 ? 0 : l) * bands + b);
    }
    iterations_ += solution.iterations;
    error_ = std::max(error_, solution.error);
    group.before = std::move(solution.source);
    multiple_seconds += watch.lap();
  }
  times_.push_back({"single scattering", single_seconds});
  times_.push_back({"multiple scattering", multiple_seconds});
}

void LitGrid::begin_with(const Solution& last, bool grey) {
  // Diffusion lets light through thin smoke so fast that the last solution is no closer in its residual than nothing.
  if (!single_only_.empty() || options_.grid.multiple == Options::Grid::Multiple::p1) return;
  find_channels();
  const Eigen::Index bands = options_.order * options_.order;
  for (Channels& group : channels_) {
    const auto lights = Eigen::Index(grey ? 1 : group.which.size());
    Moments start(grid_.cells.nodes(), lights * bands);
    bool known = true;
    for (Eigen::Index l = 0; l < lights && known; ++l) {
      const Eigen::ArrayXXd one = at_nodes(last, group.which[std::size_t(l)], grid_, bands);
      known = one.size() > 0;
      if (known) start.middleCols(l * bands, bands) = one;
    }
    if (known) group.before = std::move(start);
  }
}

Solution LitGrid::solution() const {
  Solution now;
  now.nodes = grid_;
  const Eigen::Index bands = options_.order * options_.order;
  for (const Channels& group : channels_)
    for (std::size_t l = 0; group.before && l < group.which.size(); ++l)
      now.of_channel[std::size_t(group.which[l])] =
          group.before->middleCols(group.before->cols() == bands ? 0 : Eigen::Index(l) * bands, bands);
  return now;
}

std::vector<Rgb> LitGrid::towards(const scene::Camera& camera, const scene::Execution& execution) const {
  std::vector<Rgb> values(std::size_t(grid_.cells.nodes()), Rgb::Zero());
  const auto fixed = Eigen::Index(fixed_);
  Eigen::MatrixXd came(3, Eigen::Index(toward_.size()));  // the ways that light goes
  for (std::size_t k = 0; k < toward_.size(); ++k) came.col(Eigen::Index(k)) = -toward_[k];
  in_runs(execution, [&](std::size_t first, std::size_t count) {
    Eigen::MatrixXd out(Eigen::Index(count), 3);
    for (std::size_t i = 0; i < count; ++i)
      out.row(Eigen::Index(i)) = to_camera(camera, grid_.node(nodes_[first + i])).transpose();
    const Eigen::ArrayXXd cosine = scene::product(out, came).array().max(-1.0).min(1.0);
    Eigen::ArrayXXd phase(cosine.rows(), cosine.cols());
    phase.leftCols(fixed) = phase_in_bands(phase_, cosine.leftCols(fixed));
    for (Eigen::Index k = fixed; k < cosine.cols(); ++k)
      for (Eigen::Index i = 0; i < cosine.rows(); ++i) phase(i, k) = phase_value(medium_.phase, cosine(i, k));
    Eigen::ArrayXXd sum(cosine.rows(), 3), once;
    for (int c = 0; c < 3; ++c) {
      if (c == 0 || medium_.sigma_t[c] != medium_.sigma_t[c - 1]) once = left(first, count, medium_.sigma_t[c]) * phase;
      sum.col(c) = medium_.albedo[c] * (once.matrix() * power_.col(c).matrix()).array();
    }
    for (std::size_t i = 0; i < count; ++i) {
      Rgb here = sum.row(Eigen::Index(i)).transpose();
      if (!again_.empty()) here += scene::evaluate_sh(again_[first + i], Vec3(out.row(Eigen::Index(i))));
      values[std::size_t(nodes_[first + i])] = here.max(0);
    }
  });
  Rgb most = Rgb::Zero();
  for (const Rgb& value : values) most = most.max(value);
  const double least = std::max(least_radiance * most.maxCoeff(), std::numeric_limits<double>::min());
  for (Rgb& value : values) value = value.max(least).log();
  beyond_.go_on(values);
  return values;
}

}  // namespace airlight::compensated_ray_marching
