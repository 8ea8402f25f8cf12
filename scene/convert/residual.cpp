#include "scene/convert/residual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/base/error.h"
#include "scene/convert/gaussian_samples.h"
#include "scene/load/content_hash.h"

namespace airlight::scene {
namespace {

constexpr double most_levels = 127;
constexpr double cancelled = 1e-12;  // of D~: what rounding leaves where the residual takes all of it away

std::string place(const Eigen::Vector3i& size, std::size_t i) {
  const std::size_t x = std::size_t(size[0]), y = std::size_t(size[1]);
  return fmt::format("({}, {}, {})", i % x, i / x % y, i / x / y);
}

// D~ as it is rendered, not below 0; denormals would take part in products that single precision loses.
double supported(float density) { return density < std::numeric_limits<float>::min() ? 0 : double(density); }

VoxelGrid without_values(VoxelGrid grid) {
  grid.values.clear();
  return grid;
}

}  // namespace

ResidualLevels quantised(const Eigen::Vector3i& size, const std::vector<double>& residual,
                         const QuantisationOptions& options) {
  if (options.threshold < 0 || options.threshold > 126)
    throw Error(fmt::format("threshold = {}, expected 0 to 126 levels", options.threshold));
  if (options.step && !(*options.step > 0 && std::isfinite(*options.step)))
    throw Error(fmt::format("step = {}, expected a density above 0", *options.step));
  const std::size_t count = std::size_t(size[0]) * size[1] * size[2];
  if (residual.size() != count)
    throw Error(
        fmt::format("a residual of {} values, expected {} x {} x {}", residual.size(), size[0], size[1], size[2]));
  double greatest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(residual[i]))
      throw Error(fmt::format("residual {} at sample {}, expected a finite number", residual[i], place(size, i)));
    greatest = std::max(greatest, std::abs(residual[i]));
  }
  ResidualLevels levels;
  levels.size = size;
  levels.step = options.step.value_or(greatest / most_levels);
  levels.values.assign(count, 0);
  if (greatest == 0 || !(levels.step > 0)) return levels;  // or the step is too small for a double
  for (std::size_t i = 0; i < count; ++i) {
    const double level = std::clamp(std::round(residual[i] / levels.step), -most_levels, most_levels);
    if (std::abs(level) > options.threshold) levels.values[i] = std::int8_t(level);
  }
  return levels;
}

std::string content_of(const GaussianSum& sum) {
  load::ContentHash hash;
  hash.tag("gaussians of a residual 1");
  hash.add(sum.constant);
  hash.add(std::int64_t(sum.gaussians.size()));
  for (const Gaussian& g : sum.gaussians) {
    hash.add(g.center);
    hash.add(g.width);
    hash.add(g.amplitude);
  }
  return hash.digits();
}

Residual residual_of(const VoxelGrid& grid, const GaussianSum& sum, const QuantisationOptions& options) {
  const std::vector<float> approximation = gaussian_samples(sum, without_values(grid));
  std::vector<double> residual(grid.values.size());
  for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = double(grid.values[i]) - supported(approximation[i]);
  ResidualLevels levels = quantised(grid.size, residual, options);
  if (options.keep_empty && levels.step > 0)
    for (std::size_t i = 0; i < residual.size(); ++i)
      if (grid.values[i] == 0 && residual[i] < 0) {
        double level = std::max(std::floor(residual[i] / levels.step), -most_levels);
        if (levels.step * level > residual[i] && level > -most_levels) --level;  // rounding
        levels.values[i] = std::int8_t(level);
      }
  Residual result;
  result.layout = without_values(grid);
  result.cutoff = sum.cutoff;
  result.gaussians_key = content_of(sum);
  result.threshold = options.threshold;
  result.step = levels.step;
  result.bricks = bricks_of(levels.size, levels.values);
  return result;
}

VoxelGrid decoded(const VoxelGrid& layout, const GaussianSum& sum, const ResidualLevels& levels) {
  VoxelGrid grid = without_values(layout);
  grid.values = gaussian_samples(sum, grid);
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    const double sum = supported(grid.values[i]), level = levels.values.empty() ? 0 : levels.values[i];
    const double density = sum + levels.step * level;
    grid.values[i] = density > cancelled * sum ? float(density) : 0.0f;
  }
  return grid;
}

bool belongs_to(const Residual& residual, const GaussianSum& sum) {
  return content_of(sum) == residual.gaussians_key && sum.cutoff == residual.cutoff;
}

VoxelGrid decoded(const GaussianSum& sum, const Residual& residual) {
  if (!belongs_to(residual, sum)) throw Error("the residual is of other Gaussians");
  return decoded(residual.layout, sum, {residual.layout.size, residual.step, levels_of(residual.bricks)});
}

}  // namespace airlight::scene
