#include "experiments/equality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/batches.h"
#include "experiments/statistics.h"
#include "scene/error.h"

namespace airlight::experiments {
namespace {

using Batches = std::vector<std::span<const float>>;

// Mean over a set of values, with the variance of that mean from the scatter of the batches.
struct Mean {
  double value = 0;
  double variance = 0;
  double degrees = 0;
};

Mean mean_over(std::span<const float> layer, const Batches& batches, const std::vector<std::size_t>& index) {
  Mean m;
  for (const std::size_t i : index) m.value += layer[i] / double(index.size());
  if (batches.empty()) return m;
  const double n = double(batches.size());
  std::vector<double> means;
  double center = 0;
  for (const auto& batch : batches) {
    double sum = 0;
    for (const std::size_t i : index) sum += batch[i];
    means.push_back(sum / double(index.size()));
    center += means.back() / n;
  }
  for (const double x : means) m.variance += (x - center) * (x - center) / (n * (n - 1));
  m.degrees = n - 1;
  return m;
}

struct Difference {
  double z;
  double sigma;
  double degrees;
};

Difference difference(const Mean& a, const Mean& b) {
  const double variance = a.variance + b.variance;
  if (variance == 0) {
    const double z = a.value == b.value ? 0 : std::copysign(std::numeric_limits<double>::infinity(), a.value - b.value);
    return {z, 0, 0};
  }
  const auto square_over = [](const Mean& m) { return m.degrees > 0 ? m.variance * m.variance / m.degrees : 0; };
  const double degrees = variance * variance / (square_over(a) + square_over(b));
  return {normal_from_student((a.value - b.value) / std::sqrt(variance), degrees), std::sqrt(variance), degrees};
}

}  // namespace

Equality compare_equal(const scene::Film& a, const scene::Film& b, const std::string& layer,
                       const std::vector<unsigned char>& left_out, double alpha) {
  if (a.width != b.width || a.height != b.height)
    throw Error(fmt::format("first image is {}x{} and second {}x{}, expected the same size", a.width, a.height, b.width,
                            b.height));
  const auto va = finite_layer(a, layer, "first image"), vb = finite_layer(b, layer, "second image");
  const Batches ba = batches(a, layer, "first image"), bb = batches(b, layer, "second image");
  if (ba.empty() && bb.empty()) throw Error("both images are exact: compare them by metrics, not by tests of noise");

  constexpr int side = 8;
  Equality e;
  std::vector<std::size_t> everything;
  e.chi_square_probability = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    double chi_square = 0;
    std::size_t m = 0;
    for (int y0 = 0; y0 < a.height; y0 += side)
      for (int x0 = 0; x0 < a.width; x0 += side) {
        std::vector<std::size_t> index;
        for (int y = y0; y < std::min(a.height, y0 + side); ++y)
          for (int x = x0; x < std::min(a.width, x0 + side); ++x) {
            const std::size_t pixel = std::size_t(y) * std::size_t(a.width) + std::size_t(x);
            if (left_out.empty() || !left_out[pixel]) index.push_back(3 * pixel + c);
          }
        if (index.empty()) continue;
        everything.insert(everything.end(), index.begin(), index.end());
        const Difference d = difference(mean_over(va, ba, index), mean_over(vb, bb, index));
        if (d.sigma == 0) {
          e.differing += d.z != 0;
          continue;
        }
        ++m;
        chi_square += d.z * d.z;
        e.largest_z = std::max(e.largest_z, std::abs(d.z));
      }
    e.blocks += m;
    if (m == 0) continue;
    const double tail = std::min(chi_square_above(chi_square, double(m)), chi_square_below(chi_square, double(m)));
    const double probability = std::min(1.0, 2 * tail);  // both tails
    if (probability <= e.chi_square_probability) {
      e.chi_square_probability = probability;
      e.chi_square = chi_square;
    }
  }
  const Mean ma = mean_over(va, ba, everything), mb = mean_over(vb, bb, everything);
  const Difference whole = difference(ma, mb);
  e.image_z = whole.z;
  e.image_threshold = normal_quantile(1 - alpha / 6);
  e.largest_threshold = e.blocks ? sidak_threshold(e.blocks, alpha / 3) : 0;
  e.detectable_bias = std::numeric_limits<double>::quiet_NaN();
  if (whole.sigma > 0)
    e.detectable_bias =
        (student_quantile(1 - alpha / 6, whole.degrees) + normal_quantile(0.95)) * whole.sigma / std::abs(mb.value);
  e.equal = objections(e, alpha) == 0;
  e.tested = e.detectable_bias <= 0.01;
  return e;
}

int objections(const Equality& e, double alpha) {
  return int(e.differing > 0 || e.largest_z > e.largest_threshold) + int(e.chi_square_probability < alpha / 9) +
         int(std::abs(e.image_z) > e.image_threshold);
}

std::string text(const Equality& e) {
  return fmt::format(
      "{}: {} blocks, largest |z| {:.2f} (threshold {:.2f}), chi-square probability {:.2g}, whole image z {:.2f} "
      "(threshold {:.2f}), {} differ without noise, detectable bias {:.2g} %{}",
      e.equal ? "equal" : "different", e.blocks, e.largest_z, e.largest_threshold, e.chi_square_probability, e.image_z,
      e.image_threshold, e.differing, 100 * e.detectable_bias, e.tested ? "" : " (over 1 %: not tested)");
}

}  // namespace airlight::experiments
