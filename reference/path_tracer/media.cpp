#include "reference/path_tracer/media.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/path_tracer/sampling.h"
#include "scene/base/error.h"
#include "scene/math/elementary.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::path_tracer {
namespace {

// Flights of one vertex share 2^24 random blocks: 2^18 for each of up to 64 media. So do the transmittances of its four
// branches (light, and three segments of a connection): 2^16 for each medium.
// The second to eighth tries of a first collision have 2^15 each, later ones 2^11.
constexpr std::uint32_t flight_blocks = 1u << 18, branch_blocks = 1u << 16, retry_blocks = 1u << 15,
                        late_blocks = 1u << 11;
constexpr std::size_t most_media = 64;
constexpr int retries = 7;
static_assert((most_attempts - retries - 1) * most_media * late_blocks <= 1 << 24);

// The random numbers of one flight, two from each block of a range.
class Uniforms {
 public:
  Uniforms(const SampleRandom& random, std::uint32_t vertex, Purpose purpose, std::uint32_t first, std::uint32_t count)
      : random_(random), vertex_(vertex), purpose_(purpose), index_(first), end_(first + count) {}

  double next() {
    if (used_ == 2) {
      if (++index_ == end_)
        throw Error("path_tracer: a flight used up its random numbers, expected a tighter majorant");
      block_ = random_.block(vertex_, purpose_, index_);
      used_ = 0;
    }
    return block_.fine(used_++);
  }

 private:
  const SampleRandom& random_;
  std::uint32_t vertex_;
  Purpose purpose_;
  std::uint32_t index_, end_;
  RandomBlock block_ = random_.block(vertex_, purpose_, index_);
  int used_ = 0;
};

// Where the numbers of an attempt lie: the how manieth it is of its purpose, and how many blocks each has.
struct Tries {
  Purpose purpose;
  int number;
  std::uint32_t blocks;
};
Tries tries_of(int attempt) {
  if (attempt == 0) return {Purpose::flight, 0, flight_blocks};
  if (attempt <= retries) return {Purpose::retry, attempt - 1, retry_blocks};
  return {Purpose::late_retry, attempt - retries - 1, late_blocks};
}

// Calls visit(t, density, majorant) at the collisions that a medium of the majorants' extinction, times sigma, would
// cause along the range, until it returns true. The first one lies an optical depth of `depth` ahead.
template <class Visit>
void track(const TrackedMedium& tracked, const Ray& ray, Interval range, double sigma, double depth, Uniforms& uniforms,
           Counters& counters, Visit&& visit) {
  const Ray tracking = tracked.tracking_ray(ray);
  walk(tracked.majorants, tracking, range, [&](double begin, double end, double majorant) {
    if (!(majorant > 0)) return false;
    const double rate = sigma * majorant;
    for (double t = begin;;) {
      const double step = depth / rate;
      if (!(t + step < end)) {
        depth = std::max(0.0, depth - (end - t) * rate);
        return false;
      }
      t += step;
      const double density = tracked.density_at(tracking.at(t));
      ++counters.lookups;
      if (density > majorant * (1 + 1e-6)) ++counters.violations;
      if (visit(t, density, majorant)) return true;
      depth = -elementary::log(uniforms.next());
    }
  });
}

// Integral of the majorants over the range.
double majorant_column(const TrackedMedium& tracked, const Ray& ray, Interval range) {
  if (range.empty()) return 0;
  if (tracked.homogeneous) return tracked.constant > 0 ? tracked.constant * range.length() : 0;
  double column = 0;
  walk(tracked.majorants, tracked.tracking_ray(ray), range, [&](double begin, double end, double majorant) {
    if (majorant > 0) column += majorant * (end - begin);
    return false;
  });
  return column;
}

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

std::optional<Collision> Media::fly(const Ray& ray, double tmax, int hero, const SampleRandom& random,
                                    std::uint32_t vertex, int attempt, double some, Counters& counters) const {
  std::optional<Collision> nearest;
  enum { not_drawn, drawn, past } forced = some < 1 ? not_drawn : past;
  double ahead = 0;  // majorant depth to the forced collision
  for (std::size_t m = 0; m < tracked_.size(); ++m) {
    const TrackedMedium& tracked = tracked_[m];
    const Interval range = scene::extent(*tracked.medium, ray, {0, nearest ? nearest->t : tmax});
    const double sigma = tracked.medium->sigma_t[hero];
    if (range.empty() || !(sigma > 0)) continue;
    const Tries tries = tries_of(attempt);
    Uniforms uniforms(random, vertex, tries.purpose,
                      (std::uint32_t(tries.number) * std::uint32_t(most_media) + std::uint32_t(m)) * tries.blocks,
                      tries.blocks);
    double depth;
    if (forced == past) {
      depth = -elementary::log(uniforms.next());
    } else {
      if (forced == not_drawn) ahead = truncated_exponential(uniforms.next(), some);
      forced = drawn;
      const double column = m + 1 < tracked_.size() ? sigma * majorant_column(tracked, ray, range) : infinity;
      if (ahead >= column) {
        ahead -= column;
        continue;
      }
      depth = ahead;
      forced = past;
    }
    if (tracked.homogeneous) {
      const double t = range.lo + depth / (sigma * tracked.constant);
      if (t < range.hi) nearest = {t, int(m), tracked.constant};
      continue;
    }
    track(tracked, ray, range, sigma, depth, uniforms, counters, [&](double t, double density, double majorant) {
      if (!(uniforms.next() * majorant < density)) return false;
      nearest = {t, int(m), density};
      return true;
    });
  }
  if (nearest) ++counters.collisions;
  return nearest;
}

Rgb Media::majorant_depth(const Ray& ray, double tmax) const {
  Rgb depth = Rgb::Zero();
  for (const TrackedMedium& tracked : tracked_) {
    const double column = majorant_column(tracked, ray, scene::extent(*tracked.medium, ray, {0, tmax}));
    for (int c = 0; c < 3; ++c)
      if (tracked.medium->sigma_t[c] > 0 && column > 0) depth[c] += tracked.medium->sigma_t[c] * column;
  }
  return depth;
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

Rgb Media::ratio_transmittance(const Ray& ray, double tmax, const SampleRandom& random, std::uint32_t vertex,
                               std::uint32_t branch, Counters& counters) const {
  double product = 1;
  for (std::size_t m = 0; m < tracked_.size(); ++m) {
    const TrackedMedium& tracked = tracked_[m];
    const double sigma = tracked.medium->sigma_t[0];
    const Interval range = scene::extent(*tracked.medium, ray, {0, tmax});
    if (range.empty() || !(sigma > 0)) continue;
    if (tracked.homogeneous) {
      product *= elementary::exp(-sigma * tracked.constant * range.length());
      continue;
    }
    const std::uint32_t first = branch * std::uint32_t(most_media) * branch_blocks + std::uint32_t(m) * branch_blocks;
    Uniforms uniforms(random, vertex, Purpose::transmittance, first, branch_blocks);
    const double depth = -elementary::log(uniforms.next());
    track(tracked, ray, range, sigma, depth, uniforms, counters, [&](double, double density, double majorant) {
      product *= 1 - density / majorant;
      return product == 0;
    });
  }
  return Rgb::Constant(product);
}

}  // namespace airlight::path_tracer
