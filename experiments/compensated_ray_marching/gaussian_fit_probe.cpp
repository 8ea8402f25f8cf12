#include "experiments/compensated_ray_marching/gaussian_fit_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "experiments/compensated_ray_marching/fitted_smoke.h"
#include "scene/base/data_folder.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/convert/gaussian_fit.h"
#include "scene/convert/gaussian_samples.h"
#include "scene/convert/perfect_hash.h"
#include "scene/convert/residual.h"
#include "scene/load/parts.h"

namespace airlight::experiments {
namespace {

using scene::GaussianFit;
using scene::VoxelGrid;

enum class Smoke { noise, puff, scene, data };
const scene::Choices<Smoke> smokes{
    {"noise", Smoke::noise}, {"puff", Smoke::puff}, {"scene", Smoke::scene}, {"data", Smoke::data}};

// A frame of the smoke that the settings name.
VoxelGrid smoke_at(const ProbeInput& input, const scene::Settings& s, int frame) {
  const double time = s.real("rise") * frame;
  if (s.choice("smoke", smokes) == Smoke::noise)
    return noise_smoke(int(s.integer("size")), time, int(s.integer("octaves")));
  if (s.choice("smoke", smokes) == Smoke::puff) return puff_smoke(int(s.integer("size")), time);
  if (s.choice("smoke", smokes) == Smoke::data) {
    const std::string name =
        fmt::format("volumes/plume/plume_{:04}.vdb", s.integer("first") + frame * s.integer("step"));
    if (scene::data_folder().empty()) throw NoDataFolder(fmt::format("no data folder (--data) with {}", name));
    const std::filesystem::path path = std::filesystem::path(scene::data_folder()) / name;
    if (!std::filesystem::exists(path)) throw Unavailable(fmt::format("{}: no such file", path.string()));
    return scene::read_vdb(path.string(), "density");
  }
  ProbeInput one = input;
  if (s.integer("frames") > 1)
    one.overrides["medium.0.frame"] = std::to_string(s.integer("first") + frame * s.integer("step"));
  return grid_of_scene(one);
}

// Cube root of the volume of the box that all frames fill, as of `airlight fit` [m].
double unit_of(const ProbeInput& input, const scene::Settings& s) {
  Eigen::Array3d lo = Eigen::Array3d::Constant(infinity), hi = -lo;
  double voxel = 0;
  for (int frame = 0; frame < int(s.integer("frames")); ++frame) {
    const VoxelGrid grid = smoke_at(input, s, frame);
    voxel = grid.voxel_size;
    lo = lo.min(grid.origin_index.cast<double>().array());
    hi = hi.max((grid.origin_index + grid.size).cast<double>().array());
    if (s.choice("smoke", smokes) == Smoke::noise || s.choice("smoke", smokes) == Smoke::puff) break;  // all alike
  }
  return voxel * std::cbrt((hi - lo).prod());
}

// Change from one frame to the next, in the density and in the residual of the fit: sums of squares over the samples
// that either frame has, on the lattice that both share.
class Flicker {
 public:
  void add(const VoxelGrid& grid, const GaussianFit& fit) {
    VoxelGrid left = grid;
    const std::vector<float> values = scene::gaussian_samples(fit.sum, grid);
    for (std::size_t i = 0; i < values.size(); ++i) left.values[i] = values[i] - grid.values[i];
    if (density_) {
      of_density_ += squared_change(*density_, grid);
      of_error_ += squared_change(*error_, left);
    }
    density_ = grid;
    error_ = std::move(left);
  }
  double ratio() const { return of_density_ > 0 ? std::sqrt(of_error_ / of_density_) : 0; }

 private:
  static double squared_change(const VoxelGrid& a, const VoxelGrid& b) {
    const Eigen::Vector3i lo = a.origin_index.cwiseMin(b.origin_index);
    const Eigen::Vector3i hi = (a.origin_index + a.size).cwiseMax(b.origin_index + b.size);
    const auto at = [](const VoxelGrid& g, const Eigen::Vector3i& index) {
      const Eigen::Vector3i p = index - g.origin_index;
      if ((p.array() < 0).any() || (p.array() >= g.size.array()).any()) return 0.0;
      return double(g.at(p[0], p[1], p[2]));
    };
    double sum = 0;
    for (int z = lo[2]; z < hi[2]; ++z)
      for (int y = lo[1]; y < hi[1]; ++y)
        for (int x = lo[0]; x < hi[0]; ++x) {
          const double change = at(b, {x, y, z}) - at(a, {x, y, z});
          sum += change * change;
        }
    return sum;
  }
  std::optional<VoxelGrid> density_, error_;
  double of_density_ = 0, of_error_ = 0;
};

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / double(values.size());
}

// A frame's residual in a hash with tags and in bricks of 8^3: sizes [bytes] and times [s] to build them from its levels, frame by frame.
struct Stores {
  std::vector<double> hash_bytes, hash_seconds, brick_bytes, brick_seconds;
  void add(const VoxelGrid& grid, const GaussianFit& fit) {
    const std::vector<std::int8_t> levels = levels_of(scene::residual_of(grid, fit.sum, {}).bricks);
    scene::Stopwatch watch;
    const scene::PerfectHash hash = scene::perfect_hash(grid.size, scene::hashed_voxels(grid.size, levels));
    hash_seconds.push_back(watch.lap());
    hash_bytes.push_back(double(hash.bytes_with_tags()));
    watch.lap();
    const scene::ResidualBricks bricks = scene::bricks_of(grid.size, levels);
    brick_seconds.push_back(watch.lap());
    brick_bytes.push_back(double(bricks.bytes()));
  }
  void tell(Findings& found) const {
    found.figures.push_back(exactly("hash_kB", 1e-3 * mean_of(hash_bytes)));
    found.figures.push_back(measured("hash_ms", scaled(hash_seconds, 1e3)));
    found.figures.push_back(exactly("bricks_kB", 1e-3 * mean_of(brick_bytes)));
    found.figures.push_back(measured("bricks_ms", scaled(brick_seconds, 1e3)));
  }
};

// Statistics of the fits, frame by frame; times [s] of the first frame and of later ones.
struct Fits {
  std::vector<double> squared, rms, rms_filled, max, filled, evaluations, iterations, teleported, count, first, later;
  std::vector<double> widths;  // of all Gaussians, in units
  double at_least = 0, at_greatest = 0;

  void add(const VoxelGrid& grid, const GaussianFit& fit, const scene::FitOptions& options) {
    squared.push_back(fit.errors.squared_ratio);
    rms.push_back(fit.errors.rms);
    rms_filled.push_back(fit.errors.rms_filled);
    max.push_back(fit.errors.max);
    filled.push_back(double(std::count_if(grid.values.begin(), grid.values.end(), [](float v) { return v > 0; })) /
                     double(grid.values.size()));
    evaluations.push_back(double(fit.evaluations));
    iterations.push_back(fit.iterations);
    teleported.push_back(fit.teleported);
    count.push_back(double(fit.sum.gaussians.size()));
    const double lo = std::max(options.widths.lo * options.unit, options.least_voxels * grid.voxel_size);
    const double hi = std::max(options.widths.hi * options.unit, 2 * lo);
    for (const scene::Gaussian& g : fit.sum.gaussians) {
      widths.push_back(g.width / options.unit);
      at_least += g.width < 1.0001 * lo;
      at_greatest += g.width > 0.9999 * hi;
    }
  }
  void tell(Findings& found) {
    const auto percent = [&](const char* name, double value) { found.figures.push_back(exactly(name, 100 * value)); };
    percent("squared_percent", mean_of(squared));
    percent("relative_l2_percent", std::sqrt(mean_of(squared)));
    percent("rms_percent", mean_of(rms));
    percent("rms_filled_percent", mean_of(rms_filled));
    percent("max_percent", *std::max_element(max.begin(), max.end()));
    percent("filled_percent", mean_of(filled));
    found.figures.push_back(exactly("evaluations", mean_of(evaluations)));
    found.figures.push_back(exactly("iterations", mean_of(iterations)));
    found.figures.push_back(exactly("teleported", mean_of(teleported)));
    found.figures.push_back(exactly("gaussians", mean_of(count)));
    if (!widths.empty()) {
      percent("at_least_percent", at_least / double(widths.size()));
      percent("at_greatest_percent", at_greatest / double(widths.size()));
      std::nth_element(widths.begin(), widths.begin() + std::ptrdiff_t(widths.size() / 2), widths.end());
      found.figures.push_back(exactly("median_width", widths[widths.size() / 2]));
    }
    found.figures.push_back(measured("first_seconds", first));
  }
};

scene::FitOptions fit_options(const scene::Settings& s, const scene::Execution& execution) {
  scene::FitOptions options;
  options.gaussians = int(s.integer("gaussians"));
  options.widths.lo = s.real("least_width");
  options.least_voxels = s.real("least_voxels");
  options.method = s.choice("method", scene::fit_methods());
  options.teleport = s.choice("teleport", scene::teleports());
  options.rounds = int(s.integer("rounds"));
  options.iterations = int(s.integer("iterations"));
  options.tolerance = s.real("tolerance");
  options.resent = s.flag("resent");
  options.threads = execution.threads;
  options.check = [&execution] {
    if (execution.progress && !execution.progress(0)) throw scene::Interrupted("interrupted");
  };
  return options;
}

}  // namespace

std::string GaussianFitProbe::about() const {
  return "error and time of smoke as Gaussians, a frame or a sequence (Zhou et al. 2008, section 5.1)";
}

std::vector<scene::SettingSpec> GaussianFitProbe::settings() const {
  return {
      scene::choice_setting(
          "smoke", Smoke::noise, smokes,
          "curl noise, a ball stirred by a curl, the voxels of the [[scene]], or volumes/plume of the data folder"),
      scene::integer_setting("size", "48", 4, 256, "samples along an axis, of noise and puff"),
      scene::integer_setting("octaves", "4", 0, 8, "of noise: the finest has 6 2^(octaves - 1) cells to the side"),
      scene::integer_setting("gaussians", "200", 1, scene::most_fit_gaussians, "of the first frame"),
      scene::real_setting("least_width", "0.015", 1e-3, 0.08, "of the box"),
      scene::real_setting("least_voxels", "0.7", 0.1, 8, "and no width below so many"),
      scene::choice_setting("method", scene::FitMethod::gauss_newton, scene::fit_methods(), "the minimiser"),
      scene::choice_setting(
          "teleport", scene::Teleport::greatest, scene::teleports(),
          "within the first frame, and of every cold one: none; to where most is missing; there and to random "
          "filled voxels by turns"),
      scene::integer_setting("rounds", "12", 1, 1000, "at most, each followed by teleportation"),
      scene::integer_setting("iterations", "5", 1, 1000, "a round"),
      scene::real_setting("tolerance", "2e-3", 0, 1, "rounds end where one gains less than this share"),
      scene::integer_setting("frames", "1", 1, 1000, "of a sequence"),
      scene::integer_setting("first", "0", 0, 100000, "frame of the files"),
      scene::integer_setting("step", "1", 1, 1000, "from frame to frame of the files"),
      scene::real_setting("rise", "0.02", 0, 1, "of noise and puff from frame to frame, m"),
      scene::flag_setting("warm", true, "a frame begins with the Gaussians of the one before"),
      scene::flag_setting("resent", true, "where the error grows, others are sent to another place in later frames"),
      scene::flag_setting("stores", false, "residuals too, each frame's in a hash and in bricks"),
      scene::integer_setting("runs", "1", 1, 100, "of the same, for times")};
}

std::vector<std::string> GaussianFitProbe::figures() const {
  return {"squared_percent",
          "relative_l2_percent",
          "rms_percent",
          "rms_filled_percent",
          "max_percent",
          "filled_percent",
          "evaluations",
          "iterations",
          "teleported",
          "gaussians",
          "median_width",
          "at_least_percent",
          "at_greatest_percent",
          "flicker",
          "first_seconds",
          "frame_seconds",
          "hash_kB",
          "hash_ms",
          "bricks_kB",
          "bricks_ms"};
}

Findings GaussianFitProbe::run(const ProbeInput& input, const scene::Settings& s,
                               const scene::Execution& execution) const {
  scene::FitOptions options = fit_options(s, execution);
  options.unit = unit_of(input, s);
  const int frames = int(s.integer("frames")), runs = int(s.integer("runs"));
  Fits fits;
  Flicker flicker;
  Stores stores;
  GaussianFit previous;
  for (int frame = 0; frame < frames; ++frame) {
    options.check();
    const VoxelGrid grid = smoke_at(input, s, frame);
    GaussianFit fit;
    for (int run = 0; run < runs; ++run) {
      fit = s.flag("warm") ? scene::next_fit(grid, previous, options) : scene::fit_gaussians(grid, options);
      (frame == 0 ? fits.first : fits.later).push_back(fit.seconds);
    }
    if (!fit.sum.gaussians.empty()) previous = fit;
    fits.add(grid, fit, options);
    if (frames > 1) flicker.add(grid, fit);
    if (s.flag("stores")) stores.add(grid, fit);
  }
  Findings found;
  fits.tell(found);
  if (!fits.later.empty()) {
    found.figures.push_back(exactly("flicker", flicker.ratio()));
    found.figures.push_back(measured("frame_seconds", fits.later));
  }
  if (s.flag("stores")) stores.tell(found);
  set_time(found, fits.later.empty() ? fits.first : fits.later);
  return found;
}

}  // namespace airlight::experiments
