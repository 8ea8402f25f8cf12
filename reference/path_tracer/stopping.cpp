#include "reference/path_tracer/stopping.h"

#include <cmath>

namespace airlight::path_tracer {
namespace {

struct TileError {
  double mean = 0, error = 0, greatest = 0, count = 0;
};

double luminance_at(const double* sums, int entry) {
  return luminance(Rgb(sums[3 * entry], sums[3 * entry + 1], sums[3 * entry + 2]));
}

// Mean of the tile's pixels and its standard error. The channels of a sample move together: the error of the luminance
// is at most the luminance of their errors, which is what is used.
TileError tile_error(const TallyLayout& layout, const std::vector<TallyNode>& nodes) {
  const TallyNode node = fold(layout, nodes);
  TileError tile;
  tile.count = double(node.count);
  if (node.count < 2) return tile;
  const double n = tile.count;
  const std::size_t stride = layout.doubles();
  const double pixels = double(node.sums.size() / stride);
  double variance = 0;
  for (std::size_t at = 0; at < node.sums.size(); at += stride) {
    const double* sums = &node.sums[at];
    tile.mean += luminance_at(sums, layout.mean()) / (n * pixels);
    tile.greatest = std::max(tile.greatest, luminance_at(sums, layout.greatest()));
    Rgb error;
    for (int c = 0; c < 3; ++c) {
      const double sum = sums[3 * layout.mean() + c], square = sums[3 * layout.square() + c];
      error[c] = std::sqrt(std::max(0.0, square - sum * sum / n) / (n * (n - 1)));
    }
    variance += std::pow(luminance(error) / pixels, 2);
  }
  tile.error = std::sqrt(variance);
  return tile;
}

}  // namespace

bool render_to_target(const World& world, const scene::View& view, const scene::Execution& execution,
                      Accumulation& accumulation) {
  const Options& options = world.options();
  if (!(options.target_error > 0)) return render_range(world, view, 0, options.samples, execution, accumulation);

  std::vector<int> active(accumulation.tiles.size());
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = int(i);
  std::uint64_t n = std::min(leaf_samples, options.samples);
  for (;;) {
    scene::Execution pass = execution;
    if (execution.progress)
      pass.progress = [&](double fraction) {
        // Passes double: the last one, if it is reached, is half of the work.
        return execution.progress(std::min(1.0, 0.5 * (1 + fraction) * double(n) / double(options.samples)));
      };
    if (!render_range(world, view, 0, n, pass, accumulation, &active)) return false;
    if (n >= options.samples) return true;
    std::vector<TileError> errors(accumulation.tiles.size());
    double film_mean = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      errors[i] = tile_error(accumulation.layout, accumulation.tiles[i]);
      film_mean += errors[i].mean / double(errors.size());
    }
    std::erase_if(active, [&](int tile) {
      const TileError& e = errors[tile];
      return e.error < options.target_error * std::max(e.mean, 1e-3 * film_mean) &&
             e.greatest < 0.05 * e.count * e.mean;
    });
    if (active.empty()) return true;
    n = std::min(2 * n, options.samples);
  }
}

}  // namespace airlight::path_tracer
