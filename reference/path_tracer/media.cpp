#include "reference/path_tracer/media.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/math/elementary.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::path_tracer {
namespace {

int cells_along(double size, double cell, const Options& options) {
  if (!options.supergrid) return 1;
  if (options.supergrid_cells > 0) return options.supergrid_cells;
  return std::clamp(int(std::ceil(size / cell)), 1, 1024);
}

// Cells of 4^3 voxels, their faces on samples, whichever way the grid lies in the world.
void prepare_grid(TrackedMedium& tracked, const scene::VoxelGrid& grid, const Options& options) {
  tracked.grid = &grid;
  const Box box = scene::sample_support(grid);
  if (box.empty()) return;
  Eigen::Vector3i cells;
  Vec3 size = box.size();
  for (int a = 0; a < 3; ++a) {
    cells[a] = cells_along(size[a], 4, options);
    const bool whole_voxels = options.supergrid && options.supergrid_cells == 0 && 4 * cells[a] >= size[a];
    if (whole_voxels) size[a] = 4 * cells[a];
  }
  tracked.majorants = make_supergrid({box.lo, box.lo + size}, cells, options.majorant_scale,
                                     [&](const Box& cell) { return scene::density_bounds_at_samples(grid, cell).hi; });
}

// Columns of 4 x 4 cells of the map, in sixteen layers where the height matters.
void prepare_fogmap(TrackedMedium& tracked, const scene::Fogmap& fog, const Options& options) {
  const Box box = scene::bounding_box(*tracked.medium);
  const auto bound = [&](const Box& cell) { return scene::density_bounds(fog, cell).hi; };
  if (box.empty() || !(box.size().array() > 0).all()) return;
  if (!(box.size().array() < infinity).all()) {  // no height to put a grid on
    tracked.majorants.outside = round_up(options.majorant_scale * bound(box));
    return;
  }
  const bool level = std::holds_alternative<scene::SameAtAllHeights>(fog.profile);
  const Eigen::Vector3i cells(cells_along(box.size()[0], 4 * fog.cell, options),
                              cells_along(level ? 1 : 16, 1, options),
                              cells_along(box.size()[2], 4 * fog.cell, options));
  tracked.majorants = make_supergrid(box, cells, options.majorant_scale, bound);
}

// Sixteen cells along each side; a coefficient or two along one need no more than one.
void prepare_legendre(TrackedMedium& tracked, const scene::LegendreBox& series, const Options& options) {
  const Box box = scene::bounding_box(*tracked.medium);
  if (box.empty() || !(box.size().array() > 0).all()) return;
  Eigen::Vector3i cells;
  for (int a = 0; a < 3; ++a) cells[a] = cells_along(series.shape()[std::size_t(a)] > 1 ? 16 : 1, 1, options);
  tracked.majorants = make_supergrid(box, cells, options.majorant_scale,
                                     [&](const Box& cell) { return scene::density_bounds(series, cell).hi; });
}

// The Gaussians that count in each cell. A sum of n is at least its greatest term at that term's farthest point of the
// cell; what is nowhere in the cell above 2^-60 / n of it does not change the sum. Negative terms may cancel: then all count.
std::vector<scene::GaussianSum> gaussians_of_cells(const scene::GaussianSum& sum, const Supergrid& grid) {
  constexpr std::size_t most = std::size_t(1) << 21;  // Gaussians in all cells: 84 MB
  const std::size_t n = sum.gaussians.size();
  const bool cancels =
      std::any_of(sum.gaussians.begin(), sum.gaussians.end(), [](const scene::Gaussian& g) { return g.amplitude < 0; });
  if (n < 16 || cancels || grid.size[0] == 0) return {};
  const double limit = sum.cutoff * sum.cutoff, negligible = 60 * std::log(2.0) + std::log(double(n));
  std::vector<double> log_amplitude(n), nearest(n);
  for (std::size_t g = 0; g < n; ++g) log_amplitude[g] = std::log(sum.gaussians[g].amplitude);
  std::vector<scene::GaussianSum> cells;
  cells.reserve(grid.majorants.size());
  std::size_t total = 0;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const Box cell = grid.widened_cell(i, j, k);
        double least = std::log(sum.constant);  // logarithm of a lower bound of the sum
        for (std::size_t g = 0; g < n; ++g) {
          const auto& [center, width, amplitude] = sum.gaussians[g];
          const Vec3 below = cell.lo - center, above = center - cell.hi;
          const double far = below.cwiseAbs().cwiseMax(above.cwiseAbs()).squaredNorm() / (width * width);
          nearest[g] = below.cwiseMax(above).cwiseMax(0).squaredNorm() / (width * width);
          if (far < limit) least = std::max(least, log_amplitude[g] - far);
        }
        scene::GaussianSum& here = cells.emplace_back();
        here.constant = sum.constant;
        here.cutoff = sum.cutoff;
        for (std::size_t g = 0; g < n; ++g)
          if (nearest[g] <= limit && log_amplitude[g] - nearest[g] > least - negligible)
            here.gaussians.push_back(sum.gaussians[g]);
        total += here.gaussians.size();
        if (total > most) return {};
      }
  return cells;
}

// Cells around the Gaussians, sixteen along each side.
void prepare_gaussians(TrackedMedium& tracked, const scene::GaussianSum& sum, const Options& options) {
  const scene::Medium& medium = *tracked.medium;
  const double scale = options.majorant_scale;
  const Eigen::Vector3i cells = Eigen::Vector3i::Constant(cells_along(16, 1, options));
  const Box all{Point3::Constant(-infinity), Point3::Constant(infinity)};
  const Box box = intersect(scene::support(medium.field), scene::bounding_box(medium.region));
  const auto bound = [&](const Box& cell) { return scene::density_bounds(sum, cell).hi; };
  if ((box.size().array() < infinity).all()) {
    if (!box.empty() && (box.size().array() > 0).all()) tracked.majorants = make_supergrid(box, cells, scale, bound);
    tracked.of_cell = gaussians_of_cells(sum, tracked.majorants);
    return;
  }
  // The bound where the grid is not: everywhere, if there is no box to put a grid on.
  tracked.majorants.outside = round_up(scale * bound(all));
  // A constant without bounds around bounded Gaussians: a grid on these, and a bound for the six half-spaces around.
  const Box core = intersect(scene::support(sum), scene::bounding_box(medium.region));
  if (core.empty() || !(core.size().array() > 0).all() || !(core.size().array() < infinity).all()) return;
  double around = 0;
  for (int a = 0; a < 3; ++a) {
    Box below = all, above = all;
    below.hi[a] = core.lo[a];
    above.lo[a] = core.hi[a];
    around = std::max({around, bound(below), bound(above)});
  }
  tracked.majorants = make_supergrid(core, cells, scale, bound);
  tracked.majorants.outside = round_up(scale * around);
  tracked.of_cell = gaussians_of_cells(sum, tracked.majorants);
}

TrackedMedium prepare(const scene::Medium& medium, const Options& options) {
  TrackedMedium tracked;
  tracked.medium = &medium;
  scene::match(
      medium.field,
      [&](const scene::Homogeneous& uniform) {
        tracked.homogeneous = true;
        tracked.constant = uniform.density;
      },
      [&](const scene::GaussianSum& sum) { prepare_gaussians(tracked, sum, options); },
      [&](const scene::GridPointer& grid) { prepare_grid(tracked, *grid, options); },
      [&](const scene::FogmapPointer& fog) { prepare_fogmap(tracked, *fog, options); },
      [&](const scene::LegendrePointer& series) { prepare_legendre(tracked, *series, options); },
      [&](const scene::FittedPointer& fitted) { prepare_grid(tracked, fitted->grid, options); });
  return tracked;
}

}  // namespace

Media::Media(const std::vector<scene::Medium>& media, const Options& options) {
  for (const scene::Medium& medium : media) {
    if (!(medium.sigma_t.maxCoeff() > 0)) continue;
    tracked_.push_back(prepare(medium, options));
    homogeneous_ = homogeneous_ && tracked_.back().homogeneous;
    if (medium.sigma_t.minCoeff() != medium.sigma_t.maxCoeff()) grey_ = false;
  }
  if (tracked_.size() > most_media)
    throw Error(fmt::format("path_tracer: {} media, expected at most {}", tracked_.size(), most_media));
}

Interval Media::hull(const Ray& ray, double tmax) const {
  Interval hull;
  for (const TrackedMedium& tracked : tracked_) {
    const Interval range = scene::extent(*tracked.medium, ray, {0, tmax});
    if (range.empty()) continue;
    hull = {std::min(hull.lo, range.lo), std::max(hull.hi, range.hi)};
  }
  return hull;
}

Rgb Media::optical_depth(const Ray& ray, double tmax, Counters& counters) const {
  Rgb depth = Rgb::Zero();
  for (const TrackedMedium& tracked : tracked_) {
    ++counters.columns;
    const double column = scene::density_integral(*tracked.medium, ray, {0, tmax});
    // 0 times an infinite column is no extinction.
    for (int c = 0; c < 3; ++c)
      if (tracked.medium->sigma_t[c] > 0) depth[c] += tracked.medium->sigma_t[c] * column;
  }
  return depth;
}

Rgb Media::transmittance(const Rgb& depth) const {
  if (grey_) return Rgb::Constant(elementary::exp(-depth[0]));
  return {elementary::exp(-depth[0]), elementary::exp(-depth[1]), elementary::exp(-depth[2])};
}

}  // namespace airlight::path_tracer
