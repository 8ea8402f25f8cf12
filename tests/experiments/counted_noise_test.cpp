// Images whose own noise is part of their error: intervals cover what other random numbers would give. Counts outside
// of 400 intervals of 95 % are at most 42 (binomial with 0.05: mean 20, standard deviation 4.4, five of them).
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/judging/metrics.h"
#include "scene/base/error.h"
#include "tests/experiments/noisy_films.h"

namespace counted_noise_test {

using namespace airlight::experiments;
using namespace airlight::test;
using airlight::scene::Film;

namespace {

constexpr int width = 16, height = 12, repeats = 400;
constexpr double off = 0.01;  // relative, of the image beside its noise

double biased(int x, int y, int c) { return gradient(x, y, c) * (1 + ((x + y) % 2 ? 1 : -0.5) * off); }

// A film with grey noise, equal in all channels of a pixel, from four samples, as a path tracer stores it: mean, se and
// n. The noise is gamma distributed as in noisy().
Film four_samples(const Value& value, double sigma, unsigned seed) {
  Film film(width, height);
  std::mt19937_64 random(seed);
  std::gamma_distribution<double> gamma(2, 1);
  auto &mean = film.add("mean"), &se = film.add("se");
  film.add("n").assign(mean.size(), 4.0f);
  for (int p = 0; p < width * height; ++p) {
    double sum = 0, squares = 0;
    for (int k = 0; k < 4; ++k) {
      const double noise = (gamma(random) - 2) / std::sqrt(2.0) * sigma * 2;
      sum += noise / 4;
      squares += noise * noise / 4;
    }
    for (int c = 0; c < 3; ++c) {
      const double v = value(p % width, p / width, c);
      mean[std::size_t(3 * p + c)] = float(v * (1 + sum));
      se[std::size_t(3 * p + c)] = float(v * std::sqrt((squares - sum * sum) / 3));
    }
  }
  return film;
}

// The mean over all values of what `of` makes of the truth g and of the expected squared error there.
template <class F>
double mean_of(double sigma, F of) {
  double sum = 0;
  for (int i = 0; i < 3 * width * height; ++i) {
    const int x = i / 3 % width, y = i / 3 / width, c = i % 3;
    const double g = gradient(x, y, c), a = biased(x, y, c);
    sum += of(g, (a - g) * (a - g) + sigma * sigma * a * a) / (3 * width * height);
  }
  return sum;
}

// By the definitions, with E (d + noise)^2 = d^2 + sigma^2 A^2.
double truth(const std::string& name, double sigma) {
  const double error = mean_of(sigma, [](double, double e) { return e; });
  const double signal = mean_of(sigma, [](double g, double) { return g * g; });
  const double mean = mean_of(sigma, [](double g, double) { return g; });
  if (name == "rmse") return std::sqrt(error);
  if (name == "rel_l2") return std::sqrt(error / signal);
  if (name == "rel_l2_squared") return error / signal;
  if (name == "rel_mse") return mean_of(sigma, [&](double g, double e) { return e / (g * g + 0.01 * mean * mean); });
  double sum = 0;
  for (int i = 0; i < 3 * width * height; ++i) sum += biased(i / 3 % width, i / 3 / width, i % 3);
  return sum / (3 * width * height) / mean - 1;
}

template <class Image, class Reference>
void check_coverage(double sigma, Image image, Reference reference) {
  const std::vector<std::string> names{"rmse", "rel_l2", "rel_l2_squared", "rel_mse", "bias"};
  std::vector<int> outside(names.size(), 0);
  std::vector<double> sum(names.size(), 0), squares(names.size(), 0), half(names.size(), 0);
  for (unsigned seed = 0; seed < repeats; ++seed) {
    const auto found = measure(names, image(seed), reference(seed), "mean", {}, ImageNoise::counted);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Measure& m = found[i];
      const double want = truth(names[i], sigma);
      outside[i] += m.low > want || m.high < want;
      sum[i] += m.value / repeats;
      squares[i] += m.value * m.value / repeats;
      half[i] += (m.high - m.low) / 2 / repeats;
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double scatter = std::sqrt(squares[i] - sum[i] * sum[i]);
    CAPTURE(names[i], outside[i], sum[i], truth(names[i], sigma), scatter, half[i]);
    CHECK(outside[i] <= 42);
    CHECK(half[i] < 2 * 2.13 * scatter);  // no interval that covers because it says nothing
  }
}

}  // namespace

TEST_CASE("counted noise of few samples: intervals from standard errors", "[metrics]") {
  SECTION("against a noisy reference") {
    check_coverage(
        0.1, [](unsigned seed) { return four_samples(biased, 0.1, seed); },
        [](unsigned seed) { return noisy(width, height, gradient, 0.01, 1000 + seed); });
  }
  SECTION("against an exact one") {
    check_coverage(
        0.1, [](unsigned seed) { return four_samples(biased, 0.1, seed); },
        [](unsigned) { return exact(width, height, gradient); });
  }
}

TEST_CASE("counted noise of sixteen batches: intervals from the jackknife", "[metrics][thorough]") {
  SECTION("against a noisy reference") {
    check_coverage(
        0.05, [](unsigned seed) { return noisy(width, height, biased, 0.05, seed); },
        [](unsigned seed) { return noisy(width, height, gradient, 0.02, 1000 + seed); });
  }
  SECTION("against an exact one") {
    check_coverage(
        0.02, [](unsigned seed) { return noisy(width, height, biased, 0.02, seed); },
        [](unsigned) { return exact(width, height, gradient); });
  }
}

// Noise uniform in [-u, u] on 1: |error| / 1.01 is uniform in [0, u / 1.01], its 95th percentile 0.95 u / 1.01.
TEST_CASE("counted noise: percentiles of one draw", "[metrics]") {
  const Film reference = exact(30, 30, [](int, int, int) { return 1.0; });
  int outside = 0;
  for (unsigned seed = 0; seed < repeats; ++seed) {
    Film image = reference;
    image.add("se").assign(2700, 0.05f);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-0.1, 0.1);
    for (int p = 0; p < 900; ++p) {
      const double noise = uniform(random);
      for (int c = 0; c < 3; ++c) image.layers["mean"][std::size_t(3 * p + c)] = float(1 + noise);
    }
    const Measure m = measure({"p95"}, image, reference, "mean", {}, ImageNoise::counted)[0];
    outside += m.low > 0.095 / 1.01 || m.high < 0.095 / 1.01;
    CHECK(m.high - m.low < 0.01);
  }
  CHECK(outside <= 42);
}

TEST_CASE("counted noise that is not known is refused, exact images are exact", "[metrics]") {
  const Film reference = exact(4, 4, gradient);
  const auto counted = [&](const Film& image) {
    return measure({"rmse"}, image, reference, "mean", {}, ImageNoise::counted)[0];
  };
  const Measure same = counted(exact(4, 4, biased));
  CHECK(same.low == same.high);
  Film one_sample = exact(4, 4, biased);
  one_sample.add("se").assign(48, 0.0f);
  one_sample.add("n").assign(48, 1.0f);
  CHECK_THROWS_WITH(counted(one_sample), Catch::Contains("noisy"));
  one_sample.add("n").assign(48, 2.0f);
  CHECK(counted(one_sample).value == Approx(same.value));
  // Without ImageNoise::counted noise is removed from the error, which needs batches.
  CHECK_THROWS_WITH(measure({"rmse"}, one_sample, reference, "mean", {}), Catch::Contains("noisy"));
}

// By hand: two values in one pixel, differences 1 and 2, standard errors 0.1 and 0.2, four samples: variance of the
// mean of squares (sqrt(4 * 0.01 - 2e-4 + 2e-4/3) + sqrt(4 * 4 * 0.04 - 2 * 16e-4 (1 - 1/3)))^2 / 4.
TEST_CASE("counted noise: one pixel by hand", "[metrics]") {
  Film reference(1, 1), image(1, 1);
  reference.add("mean") = {1, 1, 5};
  image.add("mean") = {2, 3, 5};
  image.add("se") = {0.1f, 0.2f, 0};
  image.add("n").assign(3, 4.0f);
  const auto counted = [&](const std::string& name) {
    return measure({name}, image, reference, "mean", {}, ImageNoise::counted)[0];
  };
  const double first = std::sqrt(0.04 - 2e-4 * 2 / 3), second = std::sqrt(0.64 - 32e-4 * 2 / 3);
  const double half = 1.959963985 * (first + second) / 3;
  CHECK(std::pow(counted("rmse").high, 2) == Approx(5.0 / 3 + half).epsilon(1e-6));
  CHECK(std::pow(counted("rmse").low, 2) == Approx(5.0 / 3 - half).epsilon(1e-6));
  CHECK(counted("rel_l2_squared").high == Approx((5.0 / 3 + half) / 9).epsilon(1e-6));  // mean R^2: 27/3
  // Sums 10 and 7; standard errors of channels that share their samples add to 0.3.
  CHECK(counted("bias").value == Approx(3.0 / 7).epsilon(1e-6));
  CHECK(counted("bias").high - counted("bias").value == Approx(1.959963985 * 0.3 / 7).epsilon(1e-6));
  CHECK(counted("bias").floor == Approx(0.3 / 7).epsilon(1e-6));
}

}  // namespace counted_noise_test
