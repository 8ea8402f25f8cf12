#include "experiments/choosing/sparse_view.h"

#include <algorithm>
#include <cmath>

namespace airlight::experiments {

SparseView sparse_view(const scene::View& whole, int width) {
  SparseView sparse{whole, whole, 1, 0, 0};
  const int stride = 1 + 2 * int(std::lround(0.5 * (double(whole.width) / width - 1)));
  const int least = std::min(whole.width, whole.height);
  sparse.stride = std::clamp(stride, 1, least - (least + 1) % 2);
  // Both films have the same middle: what is left over on both sides is the same number of pixels.
  const auto fitted = [&](int size) {
    const int count = size / sparse.stride;
    return count > 1 && (size - count * sparse.stride) % 2 != 0 ? count - 1 : count;
  };
  sparse.small.width = fitted(whole.width);
  sparse.small.height = fitted(whole.height);
  sparse.left = (whole.width - sparse.small.width * sparse.stride) / 2 + sparse.stride / 2;
  sparse.top = (whole.height - sparse.small.height * sparse.stride) / 2 + sparse.stride / 2;
  const double seen = double(sparse.small.height) * sparse.stride / whole.height;  // of the whole film's height
  scene::Camera& camera = sparse.small.camera;
  camera.vertical_fov = 2 * std::atan(seen * std::tan(0.5 * camera.vertical_fov));
  camera.height *= seen;
  return sparse;
}

scene::Film pick(const scene::Film& film, const SparseView& sparse) {
  scene::Film picked(sparse.small.width, sparse.small.height);
  picked.metadata = film.metadata;
  for (const auto& [name, values] : film.layers) {
    std::vector<float>& kept = picked.add(name);
    auto out = kept.begin();
    for (int y = 0; y < picked.height; ++y)
      for (int x = 0; x < picked.width; ++x) {
        const std::size_t row = std::size_t(sparse.top + y * sparse.stride) * std::size_t(film.width);
        const auto from = values.begin() + std::ptrdiff_t(3 * (row + std::size_t(sparse.left + x * sparse.stride)));
        out = std::copy(from, from + 3, out);
      }
  }
  return picked;
}

}  // namespace airlight::experiments
