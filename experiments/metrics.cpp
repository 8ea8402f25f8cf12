#include "experiments/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "experiments/batches.h"
#include "experiments/equality.h"
#include "experiments/statistics.h"
#include "scene/error.h"
#include "scene/settings.h"

namespace airlight::experiments {
namespace {

struct MetricName {
  std::string base;
  bool foreground = false;
  int channel = -1;  // all
};

MetricName parse(std::string name) {
  MetricName parsed;
  const std::string prefix = "foreground.";
  if (name.rfind(prefix, 0) == 0) {
    parsed.foreground = true;
    name.erase(0, prefix.size());
  }
  if (name.size() > 2 && name[name.size() - 2] == '.') {
    const std::size_t channel = std::string("rgb").find(name.back());
    if (channel != std::string::npos) {
      parsed.channel = int(channel);
      name.resize(name.size() - 2);
    }
  }
  parsed.base = name;
  return parsed;
}

// The values that a metric looks at, and the differences per batch. Batch means stand for the batches; with exact
// images there are none, and every function below sees one difference without noise.
class Values {
 public:
  Values(const scene::Film& image, const scene::Film& reference, const std::string& layer, const MetricName& name,
         const Masks& masks)
      : a_(finite_layer(image, layer, "image")),
        r_(finite_layer(reference, layer, "reference")),
        a_batches_(batches(image, layer, "image")),
        r_batches_(batches(reference, layer, "reference")),
        width_(image.width),
        height_(image.height) {
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

  std::size_t size() const { return index_.size(); }
  int batch_count() const { return int(std::max(a_batches_.size(), r_batches_.size())); }
  std::size_t pixel(std::size_t i) const { return index_[i] / 3; }
  double a(std::size_t i) const { return a_[index_[i]]; }
  double r(std::size_t i) const { return r_[index_[i]]; }
  double a(std::size_t i, int b) const { return a_batches_.empty() ? a(i) : a_batches_[std::size_t(b)][index_[i]]; }
  double r(std::size_t i, int b) const { return r_batches_.empty() ? r(i) : r_batches_[std::size_t(b)][index_[i]]; }
  double d(std::size_t i, int b) const { return a(i, b) - r(i, b); }

  // Greatest less least value of the reference, smoothed over the kept pixels among 3x3.
  double smoothed_range() const {
    double least = infinity_, greatest = -infinity_;
    for (const std::size_t at : index_) {
      const int pixel = int(at / 3), px = pixel % width_, py = pixel / width_;
      double sum = 0;
      int count = 0;
      for (int y = std::max(0, py - 1); y <= std::min(height_ - 1, py + 1); ++y)
        for (int x = std::max(0, px - 1); x <= std::min(width_ - 1, px + 1); ++x)
          if (kept_[std::size_t(y * width_ + x)]) {
            sum += r_[std::size_t(y * width_ + x) * 3 + at % 3];
            ++count;
          }
      least = std::min(least, sum / count);
      greatest = std::max(greatest, sum / count);
    }
    return greatest - least;
  }

 private:
  static constexpr double infinity_ = std::numeric_limits<double>::infinity();
  std::span<const float> a_, r_;
  std::vector<std::span<const float>> a_batches_, r_batches_;
  int width_, height_;
  std::vector<unsigned char> kept_;
  std::vector<std::size_t> index_;
};

// Over the batches [begin, end) without one: mean, mean over pairs of different batches, variance of the mean.
class Group {
 public:
  Group(int begin, int end, int without)
      : begin_(begin), end_(end), without_(without), n_(end - begin - (without >= begin && without < end)) {}
  template <class F>
  double mean(F value) const {
    double sum = 0;
    for (int b = begin_; b < end_; ++b)
      if (b != without_) sum += value(b);
    return sum / n_;
  }
  template <class F>
  double pair_mean(F value) const {
    double sum = 0, squares = 0;
    for (int b = begin_; b < end_; ++b)
      if (b != without_) {
        const double v = value(b);
        sum += v;
        squares += v * v;
      }
    return (sum * sum - squares) / (double(n_) * (n_ - 1));
  }

 private:
  int begin_, end_, without_;
  double n_;
};

// Mean squared difference and mean squared reference, noise left out of both.
struct Squares {
  double error;
  double signal;
};

Squares squares(const Values& v, int without) {
  Squares s{0, 0};
  const int count = v.batch_count();
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (count == 0) {
      const double d = v.a(i) - v.r(i);
      s.error += d * d;
      s.signal += v.r(i) * v.r(i);
    } else {
      const Group group(0, count, without);
      s.error += group.pair_mean([&](int b) { return v.d(i, b); });
      s.signal += group.pair_mean([&](int b) { return v.r(i, b); });
    }
  }
  return {s.error / double(v.size()), s.signal / double(v.size())};
}

double relative_mse(const Values& v, int without) {
  const int count = v.batch_count();
  const auto one_way = [&](const Group* above, const Group* below) {
    const auto r = [&](std::size_t i) { return below ? below->mean([&](int b) { return v.r(i, b); }) : v.r(i); };
    double mean = 0;
    for (std::size_t i = 0; i < v.size(); ++i) mean += r(i) / double(v.size());
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double exact = v.a(i) - v.r(i);
      const double square = above ? above->pair_mean([&](int b) { return v.d(i, b); }) : exact * exact;
      sum += square / (r(i) * r(i) + 0.01 * mean * mean);
    }
    return sum / double(v.size());
  };
  if (count == 0) return one_way(nullptr, nullptr);
  const Group first(0, count / 2, without), second(count / 2, count, without);
  return 0.5 * (one_way(&first, &second) + one_way(&second, &first));
}

double signed_bias(const Values& v, int without) {
  const int count = v.batch_count();
  double a = 0, r = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Group group(0, count, without);
    a += count ? group.mean([&](int b) { return v.a(i, b); }) : v.a(i);
    r += count ? group.mean([&](int b) { return v.r(i, b); }) : v.r(i);
  }
  return a / r - 1;
}

// Mean variance of the difference of the two means.
double mean_noise(const Values& v) {
  const int n = v.batch_count();
  if (n == 0) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    double mean = 0, square = 0;
    for (int b = 0; b < n; ++b) mean += v.d(i, b) / n;
    for (int b = 0; b < n; ++b) square += (v.d(i, b) - mean) * (v.d(i, b) - mean);
    sum += square / (double(n) * (n - 1));
  }
  return sum / double(v.size());
}

template <class F>
Estimate with_interval(const Values& v, F statistic) {
  const double whole = statistic(v, -1);
  if (v.batch_count() == 0) return {whole, whole, whole};
  std::vector<double> without;
  for (int b = 0; b < v.batch_count(); ++b) without.push_back(statistic(v, b));
  return jackknife(whole, without);
}

double quantile(std::vector<double>& x, double p) {
  if (x.empty()) return 0;
  const std::size_t k = std::min(x.size() - 1, std::size_t(std::max(0.0, std::ceil(p * double(x.size())) - 1)));
  std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(k), x.end());
  return x[k];
}

// |error| <= |d| + |noise| for each value, so for the p-quantile Q and half the tail q = (1-p)/2:
//   Q(|error|, p) <= Q(|d|, p+q) + Q(|noise|, 1-q) and Q(|error|, p) >= Q(|d|, p-q) - Q(|noise|, 1-q).
Measure percentile(const Values& v, double p) {
  const int n = v.batch_count();
  double greatest = 0;
  for (std::size_t i = 0; i < v.size(); ++i) greatest = std::max(greatest, v.r(i));
  std::vector<double> error, noise;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double scale = std::max(v.r(i), 0.0) + 0.01 * greatest;
    error.push_back(std::abs(v.a(i) - v.r(i)) / scale);
    if (n > 0) {
      const auto d = [&](int b) { return v.d(i, b); };
      noise.push_back(0.5 * std::abs(Group(0, n / 2, -1).mean(d) - Group(n / 2, n, -1).mean(d)) / scale);
    }
  }
  Measure m;
  m.value = m.low = m.high = quantile(error, p);
  if (n > 0) {
    const double tail = (1 - p) / 2;
    const double noise_bound = quantile(noise, 1 - tail);
    m.floor = quantile(noise, p);
    m.low = std::max(0.0, quantile(error, p - tail) - noise_bound);
    m.high = quantile(error, p + tail) + noise_bound;
    m.below_floor = m.low <= 0;
  }
  return m;
}

double wrong_share(const Values& v) {
  double mean = 0;
  for (std::size_t i = 0; i < v.size(); ++i) mean += v.r(i) / double(v.size());
  std::size_t pixels = 0, wrong = 0;
  for (std::size_t i = 0; i < v.size();) {
    bool differs = false;
    for (const std::size_t pixel = v.pixel(i); i < v.size() && v.pixel(i) == pixel; ++i)
      differs = differs || std::abs(v.a(i) - v.r(i)) > 1e-4 * mean;
    ++pixels;
    wrong += differs;
  }
  return double(wrong) / double(pixels);
}

double root(double x) { return std::sqrt(std::max(0.0, x)); }

Measure squared_family(const Estimate& e, double floor, bool take_root, bool noisy) {
  Measure m;
  m.value = take_root ? root(e.value) : std::max(0.0, e.value);
  m.low = take_root ? root(e.low) : std::max(0.0, e.low);
  m.high = take_root ? root(e.high) : std::max(0.0, e.high);
  m.floor = floor;
  m.below_floor = noisy && e.low <= 0;
  if (std::isnan(e.value)) m.value = m.low = m.high = e.value;
  return m;
}

Measure measure_values(const std::string& base, const Values& v) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const bool noisy = v.batch_count() > 0;
  if (v.size() == 0) return {"", nan, nan, nan, nan, false};
  if (base == "p95") return percentile(v, 0.95);
  if (base == "p99") return percentile(v, 0.99);
  if (base == "p999") return percentile(v, 0.999);
  if (base == "wrong") {
    const double share = noisy ? nan : wrong_share(v);
    return {"", share, share, share, 0, false};
  }
  if (base == "bias") {
    const Estimate e = with_interval(v, signed_bias);
    // The standard error, back from the interval.
    const double floor = noisy ? (e.high - e.low) / 2 / student_quantile(0.975, v.batch_count() - 1) : 0;
    return {"", e.value, e.low, e.high, floor, noisy && e.low <= 0 && e.high >= 0};
  }
  if (base == "rel_mse") {
    double signal = squares(v, -1).signal;
    return squared_family(with_interval(v, relative_mse), mean_noise(v) / signal, false, noisy);
  }
  const double noise = mean_noise(v);
  if (base == "rmse" || base == "rmse_range") {
    const Estimate e = with_interval(v, [](const Values& x, int without) { return squares(x, without).error; });
    const double range = base == "rmse" ? 1 : v.smoothed_range();
    const double per = range > 0 ? 1 / (range * range) : nan;
    return squared_family({e.value * per, e.low * per, e.high * per}, std::sqrt(noise * per), true, noisy);
  }
  const Estimate e = with_interval(v, [&](const Values& x, int without) {
    const Squares s = squares(x, without);
    return s.signal > 0 ? s.error / s.signal : nan;
  });
  const double relative_noise = noise / squares(v, -1).signal;
  const bool take_root = base == "rel_l2";
  return squared_family(e, take_root ? root(relative_noise) : relative_noise, take_root, noisy);
}

bool is_test(const std::string& base) {
  return base == "objections" || base == "largest_z" || base == "detectable_bias";
}

Measure test_of_equality(const std::string& name, const scene::Film& image, const scene::Film& reference,
                         const std::string& layer, const Masks& masks) {
  constexpr double alpha = 1e-4;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (batches(image, layer, "image").empty() && batches(reference, layer, "reference").empty())
    return {"", nan, nan, nan, 0, false};
  const Equality e = compare_equal(image, reference, layer, masks.left_out, alpha);
  const double x = name == "largest_z"         ? e.largest_z
                   : name == "detectable_bias" ? e.detectable_bias
                                               : double(objections(e, alpha));
  return {"", x, x, x, 0, false};
}

}  // namespace

const std::vector<std::string>& metric_names() {
  static const std::vector<std::string> names = {
      "rmse", "rel_l2", "rel_l2_squared", "rmse_range", "rel_mse",   "bias",           "p95",
      "p99",  "p999",   "wrong",          "objections", "largest_z", "detectable_bias"};
  return names;
}

void check_metric_name(const std::string& name, const std::string& where) {
  const std::string base = parse(name).base;
  const auto& names = metric_names();
  if (std::find(names.begin(), names.end(), base) == names.end())
    throw Error(fmt::format("{}: unknown metric '{}', expected one of {} (nearest: {})", where, name,
                            fmt::join(names, ", "), scene::nearest(base, names)));
  if (is_test(base) && name != base)
    throw Error(fmt::format("{}: metric '{}': expected '{}', which is of the whole picture", where, name, base));
}

std::vector<unsigned char> foreground_mask(const scene::Film& film) {
  if (!film.has("transmittance")) return {};
  const std::vector<float>& t = film.layer("transmittance");
  std::vector<unsigned char> mask(film.pixels(), 0);
  for (std::size_t i = 0; i < t.size(); ++i)
    if (1 - t[i] > 1e-3) mask[i / 3] = 1;
  return mask;
}

std::string text(const Measure& m) {
  if (std::isnan(m.value)) return "undefined";
  if (m.below_floor) return fmt::format("below noise floor, <= {:.3g}", std::max(std::abs(m.low), std::abs(m.high)));
  if (m.low == m.value && m.high == m.value) return fmt::format("{:.4g}", m.value);
  return fmt::format("{:.4g} [{:.4g}, {:.4g}]", m.value, m.low, m.high);
}

std::vector<Measure> measure(const std::vector<std::string>& names, const scene::Film& image,
                             const scene::Film& reference, const std::string& layer, const Masks& masks) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(fmt::format("image is {}x{} and reference {}x{}, expected the same size", image.width, image.height,
                            reference.width, reference.height));
  std::vector<Measure> measures;
  for (const std::string& name : names) {
    check_metric_name(name, "metrics");
    const MetricName parsed = parse(name);
    if (parsed.foreground && masks.foreground.size() != image.pixels())
      throw Error(
          fmt::format("metric '{}' needs the foreground, and the reference has no layer 'transmittance'", name));
    Measure m = is_test(parsed.base) ? test_of_equality(name, image, reference, layer, masks)
                                     : measure_values(parsed.base, Values(image, reference, layer, parsed, masks));
    m.name = name;
    measures.push_back(m);
  }
  return measures;
}

}  // namespace airlight::experiments
