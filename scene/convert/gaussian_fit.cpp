#include "scene/convert/gaussian_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/stopwatch.h"
#include "scene/convert/fit_gauss_newton.h"
#include "scene/convert/fit_lbfgs.h"
#include "scene/convert/fit_placement.h"

namespace airlight::scene {
namespace {

// Greatest density; whatever is no density is refused.
double greatest_of(const VoxelGrid& grid) {
  float greatest = 0;
  for (std::size_t at = 0; at < grid.values.size(); ++at) {
    const float value = grid.values[at];
    if (std::isfinite(value) && value >= 0) {
      greatest = std::max(greatest, value);
      continue;
    }
    const std::size_t nx = std::size_t(grid.size[0]), ny = std::size_t(grid.size[1]);
    throw Error(fmt::format("the density at voxel ({}, {}, {}) is {}, expected a finite number, at least 0", at % nx,
                            at / nx % ny, at / (nx * ny), value));
  }
  return greatest;
}

// A fit at work: a grid's samples as lengths, its greatest density as 1.
class Frame {
 public:
  Frame(const VoxelGrid& grid, double greatest, const FitOptions& options)
      : grid_(grid),
        options_(options),
        greatest_(greatest),
        objective_(grid.size, grid.values.data(), 1 / greatest, fit_cutoff, options.threads) {
    const double unit = (options.unit > 0 ? options.unit : fit_unit(grid)) / grid.voxel_size;
    bounds_.centers = {Point3::Constant(-0.5), grid.size.cast<double>().array() - 0.5};
    bounds_.widths.lo = std::max(options.widths.lo * unit, options.least_voxels);
    bounds_.widths.hi = std::max(options.widths.hi * unit, 2 * bounds_.widths.lo);
    bounds_.amplitudes = options.amplitudes;
  }

  // Some where the mass is, then half as many again where density is missing, over and over. Gaussians that all begin where the mass is
  // stay about as wide as they are apart, and too few of them ever come to the edge of the smoke, where most of the error is.
  void place() {
    const int n = int(std::min(std::size_t(options_.gaussians), objective_.filled()));
    gaussians_ =
        place_gaussians(grid_.size, grid_.values.data(), 1 / greatest_, std::max(n / 16, std::min(n, 50)), bounds_);
    ids_.resize(gaussians_.size());
    std::iota(ids_.begin(), ids_.end(), 0);
    next_id_ = int(ids_.size());
    amplitudes(5);
    for (int before = 0, now = next_id_; now < n && now > before; now = next_id_) {
      before = now;
      run(FitMethod::gauss_newton, 5, options_.tolerance);
      insert(std::min(n, now + (now + 1) / 2) - now);
    }
    inserted_ = 0;
  }
  void take(const GaussianFit& previous) {
    for (const Gaussian& g : previous.sum.gaussians) {
      gaussians_.push_back({world_to_sample(grid_, g.center), g.width / grid_.voxel_size, g.amplitude / greatest_});
      clamp_to(bounds_, gaussians_.back());
    }
    ids_ = previous.ids;
    next_id_ = previous.next_id;
  }

  void minimise() {
    const bool alternating = options_.teleport == Teleport::alternating;
    double before = objective_.value(gaussians_);
    int in_vain = 0;  // rounds in a row
    for (int round = 0; round < options_.rounds; ++round) {
      const double value = run(options_.method, options_.iterations, options_.tolerance);
      const bool sends = options_.teleport != Teleport::none && round + 1 < options_.rounds;
      const int moved = sends ? send_least(20, alternating && round % 2 == 1 ? round : 0) : 0;
      const bool good = before - value > options_.tolerance * before || moved > int(gaussians_.size()) / 100;
      in_vain = good ? 0 : in_vain + 1;
      if (in_vain > int(alternating)) break;  // both ways have failed
      before = value;
    }
  }
  // From the Gaussians of the frame before; where they do not do, as good as `ratio`, others come, and are sent from place to place.
  void minimise_later(double ratio) {
    const double wanted = ratio * objective_.sum_of_squares();
    double before = objective_.value(gaussians_);
    for (int round = 0; round < options_.later_rounds; ++round) {
      const double value = run(options_.method, options_.iterations, options_.later_tolerance);
      int moved = 0;
      if (value > wanted && round + 1 < options_.later_rounds) {
        if (inserted_ == 0) insert(options_.inserted);
        // A Gaussian that is moved far away gets a new id.
        const std::vector<Gaussian> at = gaussians_;
        if (options_.resent) moved = send_least(10);
        for (std::size_t i = 0; moved > 0 && i < at.size(); ++i)
          if (gaussians_[i].center != at[i].center) ids_[i] = next_id_++;
      }
      if (!(before - value > options_.later_tolerance * before) && inserted_ + moved <= int(gaussians_.size()) / 100)
        break;
      before = value;
    }
  }
  void delete_least(int count) {
    std::vector<std::size_t> order(gaussians_.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto significance = [&](std::size_t i) {
      return gaussians_[i].amplitude * gaussians_[i].amplitude * std::pow(gaussians_[i].width, 3);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return significance(a) < significance(b); });
    order.resize(std::min(order.size(), std::size_t(count)));
    std::sort(order.rbegin(), order.rend());
    for (const std::size_t i : order) {
      gaussians_.erase(gaussians_.begin() + std::ptrdiff_t(i));
      ids_.erase(ids_.begin() + std::ptrdiff_t(i));
    }
    deleted_ += int(order.size());
  }
  void insert(int count) {
    objective_.value(gaussians_);
    for (const Point3& place : missing_places(objective_, bounds_, 2 * std::size_t(count))) {
      if (count == 0 || int(gaussians_.size()) >= most_fit_gaussians) break;
      const Placed placed = place_at(objective_, bounds_, place);
      if (!(placed.gain > 0)) continue;
      objective_.add(placed.gaussian);
      gaussians_.push_back(placed.gaussian);
      ids_.push_back(next_id_++);
      ++inserted_;
      --count;
    }
  }
  void amplitudes(int iterations) {
    iterations_ +=
        minimize_gauss_newton(objective_, bounds_, gaussians_, {iterations, 1e-6, options_.check}, true).iterations;
  }

  GaussianFit result() {
    GaussianFit fit;
    objective_.value(gaussians_);
    fit.errors = objective_.errors();
    fit.sum.cutoff = fit_cutoff;
    for (const Gaussian& g : gaussians_)
      fit.sum.gaussians.push_back(
          {sample_to_world(grid_, g.center), g.width * grid_.voxel_size, g.amplitude * greatest_});
    fit.ids = ids_;
    fit.next_id = next_id_;
    fit.evaluations = objective_.evaluations();
    fit.iterations = iterations_;
    fit.teleported = teleported_;
    fit.deleted = deleted_;
    fit.inserted = inserted_;
    return fit;
  }

 private:
  // At most one of `share`; with a number above 0 to random places, others for each number.
  int send_least(int share, int random = 0) {
    const int most = std::max(1, int(gaussians_.size()) / share);
    const int moved =
        random > 0
            ? teleport(objective_, bounds_, gaussians_, most,
                       random_places(grid_.size, grid_.values.data(), std::uint32_t(random), 2 * std::size_t(most)))
            : teleport(objective_, bounds_, gaussians_, most);
    teleported_ += moved;
    return moved;
  }
  double run(FitMethod method, int iterations, double tolerance) {
    const MinimizerOptions options{iterations, 0.1 * tolerance, options_.check};
    const Minimization done = method == FitMethod::lbfgs
                                  ? minimize_lbfgs(objective_, bounds_, gaussians_, options)
                                  : minimize_gauss_newton(objective_, bounds_, gaussians_, options);
    iterations_ += done.iterations;
    return done.value;
  }

  const VoxelGrid& grid_;
  const FitOptions& options_;
  double greatest_;
  FitObjective<float> objective_;
  FitBounds bounds_;
  std::vector<Gaussian> gaussians_;
  std::vector<int> ids_;
  int next_id_ = 0, iterations_ = 0, teleported_ = 0, deleted_ = 0, inserted_ = 0;
};

}  // namespace

const Choices<Teleport>& teleports() {
  static const Choices<Teleport> choices{
      {"none", Teleport::none}, {"greatest", Teleport::greatest}, {"alternating", Teleport::alternating}};
  return choices;
}

const Choices<FitMethod>& fit_methods() {
  static const Choices<FitMethod> choices{{"gauss_newton", FitMethod::gauss_newton}, {"lbfgs", FitMethod::lbfgs}};
  return choices;
}

FitMethod fit_method_from(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [said, method] : fit_methods()) {
    if (said == name) return method;
    names.push_back(said);
  }
  throw Error(
      fmt::format("method '{}'{}, expected one of {}", name, nearest_hint(name, names), fmt::join(names, ", ")));
}

void check_fit_options(const FitOptions& o) {
  const auto require = [](bool good, const std::string& what) {
    if (!good) throw Error("a fit's " + what);
  };
  require(o.gaussians >= 1 && o.gaussians <= most_fit_gaussians,
          fmt::format("number of Gaussians is {}, expected 1 to {}", o.gaussians, most_fit_gaussians));
  require(std::isfinite(o.unit) && o.unit >= 0, fmt::format("unit is {}, expected a length", o.unit));
  require(o.widths.lo > 0 && o.widths.hi > o.widths.lo && std::isfinite(o.widths.hi),
          "widths are empty, expected 0 < least < greatest");
  require(o.least_voxels > 0 && std::isfinite(o.least_voxels), "least width is no number of voxels above 0");
  require(o.amplitudes.lo > 0 && o.amplitudes.hi > o.amplitudes.lo && std::isfinite(o.amplitudes.hi),
          "amplitudes are empty, expected 0 < least < greatest");
  require(o.rounds >= 0 && o.later_rounds >= 0 && o.iterations >= 1 && o.tolerance >= 0 && o.later_tolerance >= 0,
          "rounds, iterations or tolerance are out of range, expected at least 0, 1 and 0");
  require(o.deleted >= 0 && o.inserted >= 0 && o.allowed >= 1,
          "deleted, inserted or allowed are out of range, expected at least 0, 0 and 1");
}

double fit_unit(const VoxelGrid& grid) { return grid.voxel_size * std::cbrt(grid.size.cast<double>().prod()); }

GaussianFit fit_gaussians(const VoxelGrid& grid, const FitOptions& options) {
  check_fit_options(options);
  Stopwatch watch;
  const double greatest = greatest_of(grid);
  GaussianFit fit;
  fit.sum.cutoff = fit_cutoff;
  if (greatest > 0) {
    Frame frame(grid, greatest, options);
    frame.place();
    frame.minimise();
    if (options.polish) frame.amplitudes(10);
    fit = frame.result();
    fit.first_ratio = fit.errors.squared_ratio;
  }
  fit.seconds = watch.lap();
  return fit;
}

GaussianFit next_fit(const VoxelGrid& grid, const GaussianFit& previous, const FitOptions& options) {
  if (previous.sum.gaussians.empty()) return fit_gaussians(grid, options);
  check_fit_options(options);
  Stopwatch watch;
  const double greatest = greatest_of(grid);
  GaussianFit fit;
  fit.sum.cutoff = fit_cutoff;
  fit.next_id = previous.next_id;
  if (greatest > 0) {
    Frame frame(grid, greatest, options);
    frame.take(previous);
    frame.delete_least(options.deleted);
    frame.minimise_later(options.allowed * previous.first_ratio);
    if (options.polish) frame.amplitudes(10);
    fit = frame.result();
  }
  fit.first_ratio = previous.first_ratio;
  fit.warm = true;
  fit.seconds = watch.lap();
  return fit;
}

void write_gaussians_csv(const std::string& path, const GaussianFit& fit) {
  std::string text = "id,center_x,center_y,center_z,width,amplitude\n";
  for (std::size_t i = 0; i < fit.sum.gaussians.size(); ++i) {
    const Gaussian& g = fit.sum.gaussians[i];
    text += fmt::format("{},{},{},{},{},{}\n", fit.ids[i], g.center[0], g.center[1], g.center[2], g.width, g.amplitude);
  }
  write_file_atomically(path, text);
}

}  // namespace airlight::scene
