#include "experiments/compensated_ray_marching/fitted_smoke.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <tuple>
#include <vector>

#include "experiments/application/build_info.h"
#include "scene/base/content_key.h"
#include "scene/base/content_store.h"
#include "scene/base/error.h"
#include "scene/convert/gaussian_fit.h"
#include "scene/load/hash_parts.h"
#include "scene/load/parts.h"
#include "scene/math/random.h"
#include "scene/scene.h"

namespace airlight::experiments {
namespace {

// Values from -1 to 1 at the eight corners of a cell of a lattice. Samples that lie side by side mostly ask for the same few cells, so each
// thread keeps those that it used last: random numbers are nearly all of the time that noise takes.
const std::array<double, 8>& corners_of(const Eigen::Vector3i& low, std::uint32_t stream) {
  struct Cell {
    Eigen::Vector3i low;
    std::uint32_t stream;
    std::array<double, 8> corners;
  };
  constexpr std::size_t count = 256;
  thread_local std::vector<std::optional<Cell>> cells(count);
  const std::uint32_t slot =
      std::uint32_t(low[0]) + 5 * std::uint32_t(low[1]) + 23 * std::uint32_t(low[2]) + 89 * stream;
  std::optional<Cell>& cell = cells[slot % count];
  if (!cell || cell->low != low || cell->stream != stream) {
    cell = Cell{low, stream, {}};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      PhiloxCounter at = {0, 0, 0, stream};
      for (std::size_t a = 0; a < 3; ++a) at[a] = std::uint32_t(low[Eigen::Index(a)] + int(corner >> a & 1));
      cell->corners[corner] = 2 * uniform32(philox4x32_10(at, {53, 1})[0]) - 1;
    }
  }
  return cell->corners;
}

// Smooth between the corners of a lattice.
double noise(const Vec3& p, std::uint32_t stream) {
  const Vec3 low = p.array().floor();
  const Vec3 f = p - low, w = f.array().square() * (3 - 2 * f.array());
  const std::array<double, 8>& corners = corners_of(low.cast<int>(), stream);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= corner >> a & 1 ? w[a] : 1 - w[a];
    sum += weight * corners[std::size_t(corner)];
  }
  return sum;
}

// The curl of three noises, by differences: without divergence, as what a flow carries along.
Vec3 curl(const Vec3& p) {
  constexpr double h = 1e-3;
  const auto gradient = [&](std::uint32_t of, int along) {
    const Vec3 d = h * Vec3::Unit(along);
    return (noise(p + d, of) - noise(p - d, of)) / (2 * h);
  };
  return {gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0), gradient(1, 0) - gradient(0, 1)};
}

// n^3 samples of a cube of 1 m of a density, its places displaced by a curl that has risen.
template <class Density>
scene::VoxelGrid stirred_smoke(int n, const Vec3& risen, Density&& density) {
  scene::VoxelGrid grid;
  grid.size = Eigen::Vector3i::Constant(n);
  grid.voxel_size = 1.0 / n;
  grid.translation = Vec3::Constant(0.5 / n);
  grid.values.resize(std::size_t(n) * n * n);
  scene::parallel_for(n, {}, [&](int z) {
    float* to = grid.values.data() + std::size_t(z) * n * n;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Vec3 p = (Vec3(x, y, z) + Vec3::Constant(0.5)) / n, from = p - risen;
        *to++ = float(density(Vec3(p + (0.05 * curl(4 * from) + 0.012 * curl(11 * from + Vec3(7, 3, 5))))));
      }
  });
  return grid;
}

scene::VoxelGrid stirred_noise(int n, double time, int octaves) {
  const Vec3 risen = time * Vec3::UnitY();
  return stirred_smoke(n, risen, [&](const Vec3& p) {
    // A column that widens with its height.
    const double radius = 0.1 + 0.22 * p[1], off = std::hypot(p[0] - 0.5, p[2] - 0.5) / radius;
    const double ends = std::clamp(8 * (p[1] - 0.06), 0.0, 1.0) * std::clamp(6 * (0.9 - p[1]), 0.0, 1.0);
    double detail = 0;
    for (int octave = 0; octave < octaves; ++octave)
      detail += std::pow(0.5, octave) * noise(6 * std::pow(2.0, octave) * (p - risen), 10 + std::uint32_t(octave));
    return std::max(0.0, ends * (std::exp(-1.5 * off * off) * (1 + 0.8 * detail) - 0.12));
  });
}

// Content key of everything that a fit depends on.
std::string key_of(const scene::VoxelGrid& grid, int count) {
  scene::load::ContentHash hash;
  scene::load::add(hash, grid);
  return content_key({"fit", hash.digits(), std::to_string(count), reference_id(), compiler()});
}

}  // namespace

scene::VoxelGrid grid_of_scene(const ProbeInput& input) {
  if (input.file.empty()) throw Error("a [[scene]] with voxels is needed");
  const scene::Scene scene = scene::load_scene(input.file.string(), input.overrides);
  for (const scene::Medium& medium : scene.media)
    if (const scene::VoxelGrid* grid = scene::grid_of(medium.field)) return *grid;
  throw Error(input.file.string() + ": no medium has voxels");
}

scene::VoxelGrid noise_smoke(int n, double time, int octaves) {
  // Row after row of an experiment asks for the same, which takes longer to make than to fit.
  static std::mutex mutex;
  static std::optional<std::pair<std::tuple<int, double, int>, scene::VoxelGrid>> last;
  const std::tuple key(n, time, octaves);
  const std::lock_guard lock(mutex);
  if (!last || last->first != key) last.emplace(key, stirred_noise(n, time, octaves));
  return last->second;
}

scene::VoxelGrid puff_smoke(int n, double time) {
  return stirred_smoke(n, time * Vec3::UnitY(), [](const Vec3& p) {
    const double share = std::max(0.0, 1 - (p - Vec3::Constant(0.5)).squaredNorm() / (0.305 * 0.305));
    return share * share;
  });
}

scene::GaussianSum gaussians_for(const scene::VoxelGrid& grid, int count, const scene::Execution& execution) {
  scene::GaussianSum sum;
  sum.cutoff = scene::fit_cutoff;
  if (count == 0) return sum;
  const std::string name = fmt::format("fits/{}.csv", key_of(grid, count));
  if (const auto kept = execution.store ? execution.store->find(name) : std::nullopt) {
    sum.gaussians = scene::load::read_gaussians_csv(kept->string());
    return sum;
  }
  scene::FitOptions options;
  options.gaussians = count;
  options.threads = execution.threads;
  const scene::GaussianFit fit = scene::fit_gaussians(grid, options);
  if (execution.store)
    execution.store->keep(name, [&](const auto& path) { scene::write_gaussians_csv(path.string(), fit); });
  return fit.sum;
}

}  // namespace airlight::experiments
