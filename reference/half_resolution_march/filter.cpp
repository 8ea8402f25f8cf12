#include "reference/half_resolution_march/filter.h"

#include "scene/base/flush_subnormals.h"

namespace airlight::half_resolution_march {
namespace {

constexpr double same_weight = 1e-6;  // weights that differ by less are equal, whatever the rounding

struct Weights {
  double of_distance[blur_radius + 1];
  Weights() {
    for (int i = 0; i <= blur_radius; ++i) of_distance[i] = std::exp(-i * i / (2 * blur_sigma * blur_sigma));
  }
};

// The mean around entry i of n, `stride` apart.
FogPixel filtered(const FogPixel* fog, const double* depth, std::size_t stride, int i, int n, double edge) {
  static const Weights weights;
  FogPixel sum = FogPixel::Zero();
  float total = 0;
  for (int j = std::max(0, i - blur_radius); j <= std::min(n - 1, i + blur_radius); ++j) {
    double weight = weights.of_distance[std::abs(j - i)];
    if (depth) {
      const double apart = depth_difference(depth[std::size_t(j) * stride], depth[std::size_t(i) * stride]) / edge;
      weight *= std::exp(-apart * apart);
    }
    sum += float(weight) * fog[std::size_t(j) * stride];
    total += float(weight);
  }
  return sum / total;
}

}  // namespace

void blur(LowFilm& film, double edge, const scene::Execution& execution) {
  const int width = film.width(), height = film.height();
  std::vector<FogPixel> blurred(film.fog.size());
  const auto pass = [&](bool rows) {
    scene::parallel_for(height, execution, [&](int y) {
      const scene::FlushSubnormals flush;
      for (int x = 0; x < width; ++x) {
        const std::size_t start = rows ? film.at(0, y) : film.at(x, 0);
        blurred[film.at(x, y)] =
            filtered(film.fog.data() + start, film.depth.empty() ? nullptr : film.depth.data() + start,
                     rows ? 1 : std::size_t(width), rows ? x : y, rows ? width : height, edge);
      }
    });
    film.fog.swap(blurred);
  };
  pass(true);
  pass(false);
}

Neighbours neighbours(const Blocks& blocks, int pixel) { return neighbours_at(blocks, pixel + 0.5); }

Neighbours neighbours_at(const Blocks& blocks, double x) {
  const int block = std::min(int(std::clamp(x, 0.0, double(blocks.pixels))) / blocks.divide, blocks.count() - 1);
  const int first = x < blocks.center(block) ? block - 1 : block;
  if (first < 0) return {0, 0, 0};
  if (first + 1 >= blocks.count()) return {first, first, 0};
  const double center = blocks.center(first);
  return {first, first + 1, (x - center) / (blocks.center(first + 1) - center)};
}

FogPixel upsampled(const LowFilm& film, const Neighbours& across, const Neighbours& down, double depth,
                   bool nearest_depth, double edge) {
  const std::size_t at[4] = {film.at(across.first, down.first), film.at(across.second, down.first),
                             film.at(across.first, down.second), film.at(across.second, down.second)};
  const double weights[4] = {(1 - across.share) * (1 - down.share), across.share * (1 - down.share),
                             (1 - across.share) * down.share, across.share * down.share};
  if (nearest_depth && !film.depth.empty()) {
    int nearest = 0;
    double least = infinity, sum = 0;
    const double slack = depth == infinity ? 0 : same_depth * depth;
    for (int k = 0; k < 4; ++k) {
      const double apart = depth_difference(depth, film.depth[at[k]]);
      sum += apart;
      if (apart > least + slack || (apart >= least - slack && weights[k] <= weights[nearest] * (1 + same_weight)))
        continue;
      nearest = k;
      least = apart;
    }
    if (sum > upsample_edges * edge) return film.fog[at[nearest]];
  }
  FogPixel sum = FogPixel::Zero();
  for (int k = 0; k < 4; ++k) sum += float(weights[k]) * film.fog[at[k]];
  return sum;
}

}  // namespace airlight::half_resolution_march
