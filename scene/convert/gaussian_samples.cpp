#include "scene/convert/gaussian_samples.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/base/limits.h"
#include "scene/base/threads.h"
#include "scene/convert/separable_gaussians.h"

namespace airlight::scene {
namespace {

using namespace separable;

constexpr std::size_t batch = 4096;  // Gaussians whose tables are held at once

void add(const Tables<float>& tables, int z0, int z1, float* sums) {
  const Layout& layout = tables.layout();
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const auto& p = tables.part(i);
    const int begin = p.empty() ? 0 : p.first_block();
    const float* const ex = tables.along_x(p);
    tables.rows(p, z0, z1, [&](int y, int z, int first, int last, float factor, double, double) {
      const float weight = factor * float(p.amplitude);
      auto* const row = reinterpret_cast<Vector<float>*>(sums) + layout.row(y, z) * layout.blocks;
      for (int b = first / 8; b <= last / 8; ++b) {
        const auto value = *reinterpret_cast<const Vector<float>*>(ex + (b - begin) * 8) * weight;
        row[b] += within<float>(b, first, last) ? value : Vector<float>{};
      }
    });
  }
}

// Refuses a sum that would take longer than the program may. The estimate adds up the samples in the boxes that the Gaussians reach to;
// a sample takes 0.7 ns, as was measured for wide Gaussians.
void require_cost(const GaussianSum& sum, const VoxelGrid& grid, int threads) {
  const double samples = double(grid.size[0]) * grid.size[1] * grid.size[2];
  const std::string what = fmt::format("{} Gaussians in {:.0f} samples", sum.gaussians.size(), samples);
  require_memory(2 * sizeof(float) * samples, what);
  double visits = 0;
  for (const Gaussian& g : sum.gaussians) {
    const Point3 at = world_to_sample(grid, g.center);
    const double reach = std::min(sum.cutoff, std::sqrt(80.0)) * g.width / grid.voxel_size;  // separable::Tables
    double box = 1;
    for (int a = 0; a < 3; ++a)
      box *= std::max(0.0, std::min(at[a] + reach, grid.size[a] - 1.0) - std::max(at[a] - reach, 0.0) + 1);
    visits += box;
  }
  require_time(7e-10 * visits / threads_for(threads), what);
}

}  // namespace

std::vector<float> gaussian_samples(const GaussianSum& sum, const VoxelGrid& grid, int threads) {
  require_cost(sum, grid, threads);
  const Layout layout = Layout::of<float>(grid.size);
  Aligned<float> sums(layout.rows() * layout.blocks * 8);
  std::fill_n(sums.data(), sums.size(), float(sum.constant));
  Tables<float> tables(layout, sum.cutoff, false);
  std::vector<SampleGaussian> part;
  std::vector<float> values(std::size_t(grid.size[0]) * grid.size[1] * grid.size[2]);
  tbb::task_arena(threads_for(threads)).execute([&] {
    for (std::size_t begin = 0; begin < sum.gaussians.size(); begin += batch) {
      part.clear();
      for (std::size_t i = begin; i < std::min(begin + batch, sum.gaussians.size()); ++i) {
        const Gaussian& g = sum.gaussians[i];
        part.push_back({world_to_sample(grid, g.center), g.width / grid.voxel_size, g.amplitude});
      }
      tables.make(part.data(), part.size());
      // A slice adds the Gaussians in their order, whoever computes it.
      tbb::parallel_for(
          tbb::blocked_range<int>(0, grid.size[2], 4),
          [&](const auto& slices) { add(tables, slices.begin(), slices.end(), sums.data()); },
          tbb::simple_partitioner());
    }
  });
  for (std::size_t row = 0; row < layout.rows(); ++row)
    std::copy_n(sums.data() + row * layout.blocks * 8, grid.size[0], values.data() + row * grid.size[0]);
  return values;
}

}  // namespace airlight::scene
