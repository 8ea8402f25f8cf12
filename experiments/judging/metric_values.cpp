#include "experiments/judging/metric_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "experiments/judging/batches.h"
#include "scene/base/error.h"

namespace airlight::experiments {

Values::Values(const scene::Film& image, const scene::Film& reference, const std::string& layer, const MetricName& name,
               const Masks& masks, ImageNoise noise)
    : a_(finite_layer(image, layer, "image")),
      r_(finite_layer(reference, layer, "reference")),
      r_batches_(batches(reference, layer, "reference")),
      width_(image.width),
      height_(image.height) {
  const bool counted = noise == ImageNoise::counted;
  if (counted && has_only_errors(image, layer, "image")) {
    se_ = standard_errors(image, layer, "image");
    if (image.has("n")) n_ = finite_layer(image, "n", "image");
  } else {
    a_batches_ = batches(image, layer, "image");
    a_unresolved_ = experiments::unresolved(image, layer, "image");
  }
  r_unresolved_ = experiments::unresolved(reference, layer, "reference");
  counted_ = counted && (only_errors() || image_has_batches());
  if (!a_batches_.empty() && !r_batches_.empty() && a_batches_.size() != r_batches_.size())
    throw Error(
        fmt::format("image has {} batches and reference {}, expected as many", a_batches_.size(), r_batches_.size()));
  const std::size_t pixels = image.pixels();
  kept_.assign(pixels, 1);
  for (std::size_t p = 0; p < pixels; ++p) {
    if (!masks.left_out.empty() && masks.left_out[p]) kept_[p] = 0;
    if (name.foreground && !masks.foreground[p]) kept_[p] = 0;
    if (kept_[p])
      for (int c = 0; c < 3; ++c)
        if (name.channel < 0 || c == name.channel) index_.push_back(3 * p + std::size_t(c));
  }
}

double Values::samples(std::size_t i) const {
  return n_.empty() ? std::numeric_limits<double>::infinity() : double(n_[index_[i]]);
}

double Values::unresolved(std::size_t i) const {
  return (a_unresolved_.empty() ? 0.0 : a_unresolved_[index_[i]]) +
         (r_unresolved_.empty() ? 0.0 : r_unresolved_[index_[i]]);
}

double Values::smoothed_range() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double least = infinity, greatest = -infinity;
  for (const std::size_t at : index_) {
    const int pixel = int(at / 3), px = pixel % width_, py = pixel / width_;
    double sum = 0;
    int count = 0;
    for (int y = std::max(0, py - 1); y <= std::min(height_ - 1, py + 1); ++y)
      for (int x = std::max(0, px - 1); x <= std::min(width_ - 1, px + 1); ++x)
        if (kept_[std::size_t(y) * width_ + x]) {
          sum += r_[std::size_t(y * width_ + x) * 3 + at % 3];
          ++count;
        }
    least = std::min(least, sum / count);
    greatest = std::max(greatest, sum / count);
  }
  return greatest - least;
}

}  // namespace airlight::experiments
