#include "experiments/judging/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "experiments/judging/batches.h"
#include "experiments/judging/equality.h"
#include "experiments/judging/flip.h"
#include "experiments/judging/metric_values.h"
#include "experiments/judging/statistics.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/settings.h"

namespace airlight::experiments {
namespace {

constexpr const char* converted_prefix = "converted.";

MetricName parse(std::string name) {
  MetricName parsed;
  if (is_of_converted(name)) name.erase(0, std::string(converted_prefix).size());
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

// Squared difference of one value without the noise of the reference, and without that of the image unless it counts.
// Where it counts, a picture of all batches but one is noisier: what it has more of is taken out.
double square(const Values& v, std::size_t i, const Group& group, int without) {
  if (group.size() == 0) return v.d(i) * v.d(i);
  if (!v.counted()) return group.pair_mean([&](int b) { return v.d(i, b); });
  double a = v.a(i), excess = 0;
  if (without >= 0 && v.image_has_batches()) {
    const Group all(0, v.batch_count(), without);
    const auto of_batch = [&](int b) { return v.a(i, b); };
    a = all.mean(of_batch);
    excess = all.variance(of_batch) * (1 / all.size() - 1 / (all.size() + 1));
  }
  const double plain =
      v.reference_is_noisy() ? group.pair_mean([&](int b) { return a - v.r(i, b); }) : (a - v.r(i)) * (a - v.r(i));
  return plain - excess;
}

// Mean squared difference and mean squared reference, noise left out of both.
struct Squares {
  double error;
  double signal;
};

Squares squares(const Values& v, int without) {
  Squares s{0, 0};
  const Group group(0, v.batch_count(), without);
  for (std::size_t i = 0; i < v.size(); ++i) {
    s.error += square(v, i, group, without);
    s.signal += v.reference_is_noisy() ? group.pair_mean([&](int b) { return v.r(i, b); }) : v.r(i) * v.r(i);
  }
  return {s.error / double(v.size()), s.signal / double(v.size())};
}

// 1 / (R^2 + 0.01 mean(R)^2) for each value, from the batches of `group`.
std::vector<double> relative_weights(const Values& v, const Group& group) {
  std::vector<double> r(v.size());
  double mean = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    r[i] = group.size() > 0 ? group.mean([&](int b) { return v.r(i, b); }) : v.r(i);
    mean += r[i] / double(v.size());
  }
  for (double& x : r) x = 1 / (x * x + 0.01 * mean * mean);
  return r;
}

double relative_mse(const Values& v, int without) {
  const auto one_way = [&](const Group& above, const Group& below) {
    const std::vector<double> weights = relative_weights(v, below);
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) sum += square(v, i, above, without) * weights[i];
    return sum / double(v.size());
  };
  const int count = v.batch_count();
  const Group first(0, count / 2, without), second(count / 2, count, without);
  return 0.5 * (one_way(first, second) + one_way(second, first));
}

double signed_bias(const Values& v, int without) {
  const Group group(0, v.batch_count(), without);
  double a = 0, r = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    a += group.size() > 0 ? group.mean([&](int b) { return v.a(i, b); }) : v.a(i);
    r += group.size() > 0 ? group.mean([&](int b) { return v.r(i, b); }) : v.r(i);
  }
  return a / r - 1;
}

std::vector<double> ones(const Values& v) { return std::vector<double>(v.size(), 1.0); }

// Upper end of a quantity that at most one of all pixels can have missed (batches.h): the greatest of
// each channel, summed.
template <class F>
double shared(const Values& v, F missed) {
  std::array<double, 3> most{};
  for (std::size_t i = 0; v.has_unresolved() && i < v.size(); ++i)
    most[v.channel(i)] = std::max(most[v.channel(i)], missed(i));
  return most[0] + most[1] + most[2];
}

// Mean variance of the difference of the two means, times weights; without the image's part if that counts as error.
double mean_noise(const Values& v, const std::vector<double>& weights) {
  const Group group(0, v.batch_count(), -1);
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double variance =
        group.size() == 0 ? 0
                          : group.variance([&](int b) { return v.counted() ? v.r(i, b) : v.d(i, b); }) / group.size();
    sum += variance * weights[i];
  }
  sum += shared(v, [&](std::size_t i) { return v.unresolved(i) * v.unresolved(i) * weights[i]; });
  return sum / double(v.size());
}

// Sum over pixels of the square of the sum over channels: the variance of the sum of all values whose standard errors
// these are, if channels share their samples and pixels do not.
template <class F>
double sum_variance(const Values& v, F error) {
  double variance = 0;
  for (std::size_t i = 0; i < v.size();) {
    double of_pixel = 0;
    for (const std::size_t pixel = v.pixel(i); i < v.size() && v.pixel(i) == pixel; ++i) of_pixel += error(i);
    variance += of_pixel * of_pixel;
  }
  return variance;
}

// Variance of the weighted mean of d^2 by the standard errors of an image without batches (statistics.h,
// squared_error).
double variance_by_errors(const Values& v, const std::vector<double>& weights) {
  if (!v.only_errors()) return 0;
  const double count = double(v.size());
  return sum_variance(v,
                      [&](std::size_t i) {
                        const double s2 = v.se(i) * v.se(i), d2 = v.d(i) * v.d(i);
                        const double own = 4 * d2 * s2 - 2 * s2 * s2 + 2 * s2 * s2 / (v.samples(i) - 1);
                        return weights[i] * std::sqrt(std::max(0.0, own));
                      }) /
         (count * count);
}

// By what the weighted mean of d^2 may be too large and too small where the batches do not show the noise: each |d| is
// off by at most u, and all of a channel together by at most the greatest u.
struct Slack {
  double below = 0;
  double above = 0;
};
Slack unresolved_squares(const Values& v, const std::vector<double>& weights) {
  Slack slack;
  if (!v.has_unresolved()) return slack;
  double each = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double d = std::abs(v.d(i)), sure = std::max(0.0, d - v.unresolved(i));
    each += (d * d - sure * sure) * weights[i];
  }
  // Falling, d^2 loses at most 2 d a unit; rising, all that was missed in one pixel makes most of it.
  const double together = shared(v, [&](std::size_t i) { return 2 * std::abs(v.d(i)) * v.unresolved(i) * weights[i]; });
  slack.below = std::min(each, together) / double(v.size());
  slack.above = shared(v,
                       [&](std::size_t i) {
                         const double d = std::abs(v.d(i)), u = v.unresolved(i);
                         return ((d + u) * (d + u) - d * d) * weights[i];
                       }) /
                double(v.size());
  return slack;
}

// The value from all batches and its jackknife; `variance` as of jackknife().
template <class F>
Estimate with_interval(const Values& v, double variance, bool corrected, F statistic) {
  const double whole = statistic(v, -1);
  if (v.batch_count() == 0) {
    const double half = normal_quantile(0.975) * std::sqrt(variance);
    return {whole, whole - half, whole + half};
  }
  std::vector<double> without;
  for (int b = 0; b < v.batch_count(); ++b) without.push_back(statistic(v, b));
  return jackknife(corrected ? jackknife_value(whole, without) : whole, without, variance);
}

Estimate widened(Estimate e, const Slack& slack) { return {e.value, e.low - slack.below, e.high + slack.above}; }

double quantile(std::vector<double>& x, double p) {
  if (x.empty()) return 0;
  const std::size_t k = std::min(x.size() - 1, std::size_t(std::max(0.0, std::ceil(p * double(x.size())) - 1)));
  std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(k), x.end());
  return x[k];
}

// |error| <= |d| + |noise| for each value, so for the p-quantile Q and half the tail q = (1-p)/2:
//   Q(|error|, p) <= Q(|d|, p+q) + Q(|noise|, 1-q) and Q(|error|, p) >= Q(|d|, p-q) - Q(|noise|, 1-q).
// An image whose noise counts is one draw of as many errors as it has pixels: 1.96 sqrt(p (1-p) / pixels) on both
// sides.
Measure percentile(const Values& v, double p) {
  const int n = v.batch_count();
  double greatest = 0;
  for (std::size_t i = 0; i < v.size(); ++i) greatest = std::max(greatest, v.r(i));
  std::vector<double> error, noise;
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    pixels += i == 0 || v.pixel(i) != v.pixel(i - 1);
    const double scale = std::max(v.r(i), 0.0) + 0.01 * greatest;
    error.push_back(std::abs(v.d(i)) / scale);
    const auto d = [&](int b) { return v.counted() ? v.r(i, b) : v.d(i, b); };
    if (n > 0)
      noise.push_back((0.5 * std::abs(Group(0, n / 2, -1).mean(d) - Group(n / 2, n, -1).mean(d)) + v.unresolved(i)) /
                      scale);
  }
  Measure m;
  m.value = m.low = m.high = quantile(error, p);
  const bool removed = v.reference_is_noisy() || (n > 0 && !v.counted());
  const double drawn = v.counted() ? normal_quantile(0.975) * std::sqrt(p * (1 - p) / double(pixels)) : 0;
  const double tail = removed ? (1 - p) / 2 : 0;
  const double noise_bound = quantile(noise, 1 - tail);
  m.floor = quantile(noise, p);
  if (v.noisy()) {
    m.low = std::max(0.0, quantile(error, p - tail - drawn) - noise_bound);
    m.high = quantile(error, p + tail + drawn) + noise_bound;
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

Measure measure_bias(const Values& v) {
  double reference = 0;
  for (std::size_t i = 0; i < v.size(); ++i) reference += v.r(i);
  const double variance = v.only_errors() ? sum_variance(v, [&](std::size_t i) { return v.se(i); }) : 0;
  const double slack = shared(v, [&](std::size_t i) { return v.unresolved(i); }) / std::abs(reference);
  const Estimate e = widened(with_interval(v, variance / (reference * reference), false, signed_bias), {slack, slack});
  // The standard error, back from the interval.
  const double quantile = v.batch_count() ? student_quantile(0.975, v.batch_count() - 1) : normal_quantile(0.975);
  const double floor = v.noisy() ? (e.high - e.low) / 2 / quantile : 0;
  return {"", e.value, e.low, e.high, floor, v.noisy() && e.low <= 0 && e.high >= 0};
}

Measure measure_values(const std::string& base, const Values& v) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (v.size() == 0) return {"", nan, nan, nan, nan, false};
  if (base == "p95") return percentile(v, 0.95);
  if (base == "p99") return percentile(v, 0.99);
  if (base == "p999") return percentile(v, 0.999);
  if (base == "wrong") {
    const double share = v.noisy() ? nan : wrong_share(v);
    return {"", share, share, share, 0, false};
  }
  if (base == "bias") return measure_bias(v);
  if (base == "rel_mse") {
    const std::vector<double> weights = relative_weights(v, Group(0, v.batch_count(), -1));
    const Estimate e = with_interval(v, variance_by_errors(v, weights), true, relative_mse);
    return squared_family(widened(e, unresolved_squares(v, weights)), mean_noise(v, weights), false, v.noisy());
  }
  const std::vector<double> weights = ones(v);
  const double noise = mean_noise(v, weights), by_errors = variance_by_errors(v, weights);
  const Slack slack = unresolved_squares(v, weights);
  // With `per` a divisor without noise to speak of.
  const auto in_units = [&](const Estimate& e, double per, bool take_root) {
    const double floor = noise * per;
    return squared_family(widened(e, {slack.below * per, slack.above * per}), take_root ? root(floor) : floor,
                          take_root, v.noisy());
  };
  if (base == "rmse" || base == "rmse_range") {
    const Estimate e =
        with_interval(v, by_errors, false, [](const Values& x, int without) { return squares(x, without).error; });
    const double range = base == "rmse" ? 1 : v.smoothed_range();
    const double per = range > 0 ? 1 / (range * range) : nan;
    return in_units({e.value * per, e.low * per, e.high * per}, per, true);
  }
  const double signal = squares(v, -1).signal;
  const Estimate e = with_interval(v, by_errors / (signal * signal), false, [&](const Values& x, int without) {
    const Squares s = squares(x, without);
    return s.signal > 0 ? s.error / s.signal : nan;
  });
  return in_units(e, 1 / signal, base == "rel_l2");
}

bool is_test(const std::string& base) {
  return base == "objections" || base == "largest_z" || base == "detectable_bias";
}

bool is_whole_picture(const std::string& base) { return is_test(base) || base == "flip"; }

// Noise is judged as it is seen: noise as large as the reference's is added to it, and what that changes may be off on both sides. The
// mean over 48 x 36 pixels differs by less than a tenth from draw to draw (flip_test.cpp): a fifth is added.
Measure measure_flip(const scene::Film& image, const scene::Film& reference, const std::string& layer,
                     const std::vector<unsigned char>& left_out) {
  std::vector<float> a = image.layer(layer), r = reference.layer(layer);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!left_out.empty() && left_out[i / 3]) a[i] = r[i];
  const double value = flip(a, r, image.width, image.height);
  const auto parts = batches(reference, layer, "reference");
  if (parts.empty()) return {"", value, value, value, 0, false};
  std::vector<float> once_more = r;
  for (std::size_t b = 0; b < parts.size(); ++b)
    for (std::size_t i = 0; i < r.size(); ++i) once_more[i] += (b % 2 ? 1 : -1) * parts[b][i] / float(parts.size());
  const double noise = 1.2 * flip(once_more, r, image.width, image.height);
  return {"", value, std::max(0.0, value - noise), value + noise, noise, value <= noise};
}

Measure test_of_equality(const std::string& name, const scene::Film& image, const scene::Film& reference,
                         const std::string& layer, const Masks& masks) {
  constexpr double alpha = 1e-4;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto& left_out = masks.left_out;
  const bool nothing = !left_out.empty() && std::find(left_out.begin(), left_out.end(), 0) == left_out.end();
  if (nothing || (batches(image, layer, "image").empty() && batches(reference, layer, "reference").empty()))
    return {"", nan, nan, nan, 0, false};
  const Equality e = compare_equal(image, reference, layer, masks.left_out, alpha);
  if (name == "objections") {
    const double all = objections(e, alpha), sure = sure_objections(e, alpha);
    return {"", all, sure, all, 0, false};
  }
  const double x = name == "largest_z" ? e.largest_z : e.image_in_range ? e.detectable_bias : nan;
  return {"", x, x, x, 0, false};
}

}  // namespace

const std::vector<std::string>& metric_names() {
  static const std::vector<std::string> names = {
      "rmse", "rel_l2", "rel_l2_squared", "rmse_range", "rel_mse",    "bias",      "p95",
      "p99",  "p999",   "wrong",          "flip",       "objections", "largest_z", "detectable_bias"};
  return names;
}

bool is_of_converted(const std::string& name) { return name.starts_with(converted_prefix); }

void check_metric_name(const std::string& name, const std::string& where) {
  const std::string base = parse(name).base;
  const auto& names = metric_names();
  if (std::find(names.begin(), names.end(), base) == names.end())
    throw Error(fmt::format("{}: unknown metric '{}', expected one of {}{}", where, name, fmt::join(names, ", "),
                            scene::nearest_hint(base, names)));
  if (is_whole_picture(base) && name != base)
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
                             const scene::Film& reference, const std::string& layer, const Masks& masks,
                             ImageNoise noise) {
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
                : parsed.base == "flip"
                    ? measure_flip(image, reference, layer, masks.left_out)
                    : measure_values(parsed.base, Values(image, reference, layer, parsed, masks, noise));
    m.name = name;
    measures.push_back(m);
  }
  return measures;
}

}  // namespace airlight::experiments
