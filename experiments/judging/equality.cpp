#include "experiments/judging/equality.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "experiments/judging/batches.h"
#include "experiments/judging/statistics.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Batches = std::vector<std::span<const float>>;

// An image with what is known of its noise.
struct Image {
  Image(const scene::Film& film, const std::string& layer, const std::string& what)
      : values(finite_layer(film, layer, what)),
        batches(experiments::batches(film, layer, what)),
        unresolved(experiments::unresolved(film, layer, what)) {}
  std::span<const float> values;
  Batches batches;
  std::vector<float> unresolved;
};

// Mean over a set of values, with the variance and the third cumulant of that mean from the scatter of the batches.
struct Mean {
  double value = 0;
  double variance = 0;
  double degrees = 0;
  double third = 0;
  bool widened = false;  // the variance is an upper end
};

Mean mean_over(const Image& image, const std::vector<std::size_t>& index) {
  const auto& [layer, batches, unresolved] = image;
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
  for (const double x : means) {
    const double d = x - center;
    m.variance += d * d / (n * (n - 1));
    m.third += d * d * d / (n * (n - 1) * (n - 2));
  }
  m.degrees = n - 1;
  if (!unresolved.empty()) {
    // Pixels share what was missed (batches.h); channels may all be off to the same side.
    std::array<double, 3> most{};
    for (const std::size_t i : index) most[i % 3] = std::max(most[i % 3], double(unresolved[i]));
    const double missed = (most[0] + most[1] + most[2]) / double(index.size()), scatter = m.variance;
    m.widened = missed > 0;
    m.variance += missed * missed;
    m.degrees *= scatter > 0 ? (m.variance / scatter) * (m.variance / scatter) : infinity;
  }
  return m;
}

struct Difference {
  double z;
  double sigma;
  double degrees;
  double third = 0;
};

Difference difference(const Mean& a, const Mean& b) {
  const double variance = a.variance + b.variance;
  if (variance == 0) {
    const double z = a.value == b.value ? 0 : std::copysign(infinity, a.value - b.value);
    return {z, 0, 0};
  }
  const auto square_over = [](const Mean& m) { return m.degrees > 0 ? m.variance * m.variance / m.degrees : 0; };
  const double degrees = variance * variance / (square_over(a) + square_over(b));
  return {normal_from_student((a.value - b.value) / std::sqrt(variance), degrees), std::sqrt(variance), degrees,
          a.third - b.third};
}

// Skewness of the means of one channel: over a block, from all blocks; and over the image, which is the sum of its
// blocks (its own sixteen means would be too few for a third moment).
class Skewness {
 public:
  // The sample skewness of n normal values has the variance 6 n (n-1) / ((n-2) (n+1) (n+3)); that of their mean an
  // n-th.
  explicit Skewness(std::size_t batches) {
    const double n = double(batches);
    unit_ = std::sqrt(6 * (n - 1) / ((n - 2) * (n + 1) * (n + 3)));
  }
  void add(const Difference& d, double pixels) {
    const double cube = d.sigma * d.sigma * d.sigma, volume = pixels * pixels * pixels;
    thirds_ += d.third;
    cubes_ += cube;
    squared_cubes_ += cube * cube;
    image_third_ += d.third * volume;
    image_variance_ += d.sigma * d.sigma * pixels * pixels;
    image_squared_cubes_ += cube * cube * volume * volume;
  }
  // Is it in range? `greatest` becomes it if it is greater.
  bool of_blocks(double& greatest) const { return judge(thirds_, cubes_, squared_cubes_, greatest); }
  bool of_image(double& greatest) const {
    return judge(image_third_, std::pow(image_variance_, 1.5), image_squared_cubes_, greatest);
  }

 private:
  bool judge(double third, double cube, double squares, double& greatest) const {
    const double value = third / cube;
    if (std::abs(value) > std::abs(greatest)) greatest = value;
    return std::abs(value) <= most_skewness + 2 * unit_ * std::sqrt(squares) / cube;
  }
  double unit_;
  double thirds_ = 0, cubes_ = 0, squared_cubes_ = 0;
  double image_third_ = 0, image_variance_ = 0, image_squared_cubes_ = 0;
};

struct SumOfSquares {
  void add(double z) {
    sum += z * z;
    ++count;
  }
  double sum = 0;
  std::size_t count = 0;
};

constexpr int side = 8;  // of a block, in pixels

// Values of a channel in the block that begins at (x0, y0), but for pixels that are left out.
std::vector<std::size_t> block(const scene::Film& film, int x0, int y0, std::size_t channel,
                               const std::vector<unsigned char>& left_out) {
  std::vector<std::size_t> index;
  for (int y = y0; y < std::min(film.height, y0 + side); ++y)
    for (int x = x0; x < std::min(film.width, x0 + side); ++x) {
      const std::size_t pixel = std::size_t(y) * std::size_t(film.width) + std::size_t(x);
      if (left_out.empty() || !left_out[pixel]) index.push_back(3 * pixel + channel);
    }
  return index;
}

// Chi-square over the blocks of a channel; the least probable of all channels counts.
void judge_scatter(const SumOfSquares& all, const SumOfSquares& known, double alpha, Equality& e) {
  const double above = chi_square_above(all.sum, double(all.count));
  const double below = known.count ? chi_square_below(known.sum, double(known.count)) : 1;
  const double probability = std::min(1.0, 2 * std::min(above, below));  // both tails
  if (probability > e.chi_square_probability) return;
  e.chi_square_probability = probability;
  e.chi_square = below < above ? known.sum : all.sum;
  e.too_alike = below < above && probability < alpha / 9;
}

}  // namespace

Equality compare_equal(const scene::Film& a, const scene::Film& b, const std::string& layer,
                       const std::vector<unsigned char>& left_out, double alpha) {
  if (a.width != b.width || a.height != b.height)
    throw Error(fmt::format("first image is {}x{} and second {}x{}, expected the same size", a.width, a.height, b.width,
                            b.height));
  const Image first(a, layer, "first image"), second(b, layer, "second image");
  if (first.batches.empty() && second.batches.empty())
    throw Error("both images are exact: compare them by metrics, not by tests of noise");

  Equality e;
  std::vector<std::size_t> everything;
  for (std::size_t c = 0; c < 3; ++c) {
    SumOfSquares all, known;  // known: blocks whose variance is no upper end
    Skewness skewness(std::max(first.batches.size(), second.batches.size()));
    for (int y0 = 0; y0 < a.height; y0 += side)
      for (int x0 = 0; x0 < a.width; x0 += side) {
        const std::vector<std::size_t> index = block(a, x0, y0, c, left_out);
        if (index.empty()) continue;
        everything.insert(everything.end(), index.begin(), index.end());
        const Mean of_first = mean_over(first, index), of_second = mean_over(second, index);
        const Difference d = difference(of_first, of_second);
        if (d.sigma == 0) {
          e.differing += d.z != 0;
          continue;
        }
        skewness.add(d, double(index.size()));
        all.add(d.z);
        if (!of_first.widened && !of_second.widened) known.add(d.z);
        e.largest_z = std::max(e.largest_z, std::abs(d.z));
      }
    e.blocks += all.count;
    if (all.count == 0) continue;
    e.blocks_in_range = skewness.of_blocks(e.block_skewness) && e.blocks_in_range;
    e.image_in_range = skewness.of_image(e.image_skewness) && e.image_in_range;
    judge_scatter(all, known, alpha, e);
  }
  if (everything.empty()) throw Error("every pixel is left out: nothing to compare");
  const Mean ma = mean_over(first, everything), mb = mean_over(second, everything);
  const Difference whole = difference(ma, mb);
  e.image_z = whole.z;
  e.image_threshold = normal_quantile(1 - alpha / 6);
  e.largest_threshold = e.blocks ? sidak_threshold(e.blocks, alpha / 3) : 0;
  e.detectable_bias = std::numeric_limits<double>::quiet_NaN();
  if (whole.sigma > 0)
    e.detectable_bias = detectable_shift(student_quantile(1 - alpha / 6, whole.degrees), whole.degrees, 0.95) *
                        whole.sigma / std::abs(mb.value);
  e.equal = objections(e, alpha) == 0;
  e.tested = e.blocks_in_range && e.image_in_range && e.detectable_bias <= 0.01;
  return e;
}

int objections(const Equality& e, double alpha) {
  return int(e.differing > 0 || e.largest_z > e.largest_threshold) + int(e.chi_square_probability < alpha / 9) +
         int(std::abs(e.image_z) > e.image_threshold);
}

int sure_objections(const Equality& e, double alpha) {
  Equality sure = e;
  if (!e.blocks_in_range) {
    sure.differing = 0;  // blocks that caught no bright sample know of no noise
    sure.largest_z = 0;
    sure.chi_square_probability = 1;
  }
  if (!e.image_in_range) sure.image_z = 0;
  return objections(sure, alpha);
}

std::string text(const Equality& e) {
  std::string why, verdict = e.equal ? "equal" : "different";
  if (e.too_alike) verdict += ", too alike for their noise (do they share random numbers?)";
  if (!e.blocks_in_range || !e.image_in_range)
    why = fmt::format(" (skewness {:.2g} of blocks, {:.2g} of the image, over {:g}: not tested)", e.block_skewness,
                      e.image_skewness, most_skewness);
  else if (!e.tested)
    why = " (over 1 %: not tested)";
  return fmt::format(
      "{}: {} blocks, largest |z| {:.2f} (threshold {:.2f}), chi-square probability {:.2g}, whole image z {:.2f} "
      "(threshold {:.2f}), {} differ without noise, detectable bias {:.2g} %{}",
      verdict, e.blocks, e.largest_z, e.largest_threshold, e.chi_square_probability, e.image_z, e.image_threshold,
      e.differing, 100 * e.detectable_bias, why);
}

}  // namespace airlight::experiments
