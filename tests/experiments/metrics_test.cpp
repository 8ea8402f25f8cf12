#include "experiments/judging/metrics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "experiments/judging/equality.h"
#include "scene/base/error.h"
#include "tests/experiments/noisy_films.h"

namespace metrics_test {

using namespace airlight::experiments;
using airlight::Error;
using airlight::scene::Film;
using namespace airlight::test;

namespace {

Measure one(const std::string& name, const Film& a, const Film& r, const Masks& masks = {}) {
  return measure({name}, a, r, "mean", masks).at(0);
}

}  // namespace

// Image = 1.1 times a reference that is 2 everywhere: every metric by hand. Films are floats: 2.2 is off by 1e-7.
TEST_CASE("metrics of exact images are their definitions", "[metrics]") {
  const Film r = exact(8, 4, [](int, int, int) { return 2.0; });
  const Film a = exact(8, 4, [](int, int, int) { return 2.2; });
  const auto near = [](double x) { return Approx(x).epsilon(1e-6); };
  CHECK(one("rmse", a, r).value == near(0.2));
  CHECK(one("rel_l2", a, r).value == near(0.1));
  CHECK(one("rel_l2_squared", a, r).value == near(0.01));
  CHECK(one("rel_mse", a, r).value == near(0.04 / (4 + 0.04)));
  CHECK(one("bias", a, r).value == near(0.1));
  CHECK(one("p95", a, r).value == near(0.2 / 2.02));
  // Two of 100 pixels are off: the 95th percentile does not see them, the 99th and the 99.9th do.
  const Film ones = exact(10, 10, [](int, int, int) { return 1.0; });
  const Film two_off = exact(10, 10, [](int x, int y, int) { return y == 0 && x < 2 ? 1.5 : 1.0; });
  CHECK(one("p95", two_off, ones).value == 0);
  CHECK(one("p99", two_off, ones).value == near(0.5 / 1.01));
  CHECK(one("p999", two_off, ones).value == near(0.5 / 1.01));
  CHECK(std::isnan(one("rmse_range", a, r).value));  // a constant reference has no range
  const Measure m = one("rel_l2", a, r);
  CHECK(m.low == m.value);
  CHECK(m.high == m.value);
  CHECK(m.floor == 0);
  CHECK_FALSE(m.below_floor);
  CHECK(text(m) == "0.1");
}

// A ramp 0..7 in x, smoothed over 3x3 with borders cut: its ends become 0.5 and 6.5.
TEST_CASE("the range is that of the smoothed reference", "[metrics]") {
  const Film r = exact(8, 4, [](int x, int, int) { return double(x); });
  const Film a = exact(8, 4, [](int x, int, int) { return x + 0.6; });
  CHECK(one("rmse_range", a, r).value == Approx(0.6 / 6).epsilon(1e-6));
}

TEST_CASE("masks, foreground and channels choose the values", "[metrics]") {
  Film r = exact(4, 2, [](int, int, int) { return 1.0; });
  Film a = r;
  a.layers["mean"][3 * 5 + 1] = 2;  // green of pixel (1, 1)
  Masks masks;
  CHECK(one("rmse", a, r).value == Approx(std::sqrt(1.0 / 24)));
  CHECK(one("rmse.g", a, r).value == Approx(std::sqrt(1.0 / 8)));
  CHECK(one("rmse.r", a, r).value == 0);
  masks.left_out.assign(8, 0);
  masks.left_out[5] = 1;
  CHECK(one("rmse", a, r, masks).value == 0);
  r.add("transmittance").assign(24, 1.0f);
  r.layers["transmittance"][3 * 5 + 2] = 0.5f;
  masks = {{}, foreground_mask(r)};
  CHECK(one("foreground.rmse.g", a, r, masks).value == Approx(1));
  CHECK_THROWS_WITH(one("foreground.rmse", a, r), Catch::Contains("foreground"));
  CHECK_THROWS_WITH(one("rel_l3", a, r), Catch::Contains("nearest: rel_l2"));
}

// The reference has 2 % noise per pixel; a relative error of 1 % is below the raw noise, and yet comes out right.
// Where noise dominates, the delete-one jackknife of a mean over pairs overstates its variance by up to 2 (the pairs
// are nearly uncorrelated), with 7 of 8 batches in a half by (8/7)^2 more: intervals are up to 1.6 times too wide,
// never too narrow. Over 400 images the count outside a true 0.95 has a standard deviation of 4.4: 42 is 5 of them
// above 20.
TEST_CASE("noise is taken out of every square, and the intervals cover", "[metrics]") {
  const Film truth = exact(24, 16, gradient);
  const Film image = exact(24, 16, [](int x, int y, int c) { return gradient(x, y, c) * ((x + y) % 2 ? 1.01 : 0.99); });
  const std::vector<std::string> names = {"rmse", "rel_l2", "rel_l2_squared", "rel_mse", "bias"};
  std::vector<std::vector<Measure>> measured;  // of each image
  for (unsigned seed = 0; seed < 400; ++seed)
    measured.push_back(measure(names, image, noisy(24, 16, gradient, 0.02, seed), "mean", {}));
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& name = names[k];
    CAPTURE(name);
    const bool rooted = name == "rmse" || name == "rel_l2";
    const double right = one(name, image, truth).value;
    int outside = 0;
    double sum = 0, squares = 0, half_widths = 0;
    for (const std::vector<Measure>& of_image : measured) {
      const Measure& m = of_image[k];
      outside += m.low > right || m.high < right;
      const auto plain = [&](double x) { return rooted ? x * x : x; };
      sum += plain(m.value) / 400;
      squares += plain(m.value) * plain(m.value) / 400;
      half_widths += (plain(m.high) - plain(m.low)) / 2 / 400;
    }
    const double want = rooted ? right * right : right;
    const double sigma = std::sqrt(squares - sum * sum);
    CAPTURE(outside, sum, want, sigma, half_widths);
    CHECK(outside <= 42);
    // 2.13 sigma is right for Student's t with 15 degrees; the scatter itself is known to 1/sqrt(800) = 3.5 %.
    CHECK(half_widths > 0.85 * 2.13 * sigma);
    CHECK(half_widths < 1.8 * 2.13 * sigma);
    // Unbiased: 4.5 standard errors of the mean of 400.
    CHECK(std::abs(sum - want) < 4.5 * sigma / 20);
  }
}

// The reference has 8 % noise, its halves 11 %: 1 / R^2 is too large by 3 of its squares, 3.8 %. An error of 30 %, so
// that the mean of 400 is known to 0.4 %; what is left is of fourth order, some 15 * 0.11^4 = 0.3 %, and as much again
// from the jackknife (8 and 7 batches instead of a series). Intervals: 42 as above.
TEST_CASE("rel_mse is not biased by noise below it", "[metrics]") {
  const Film image = exact(24, 16, [](int x, int y, int c) { return gradient(x, y, c) * ((x + y) % 2 ? 1.3 : 0.7); });
  const double want = one("rel_mse", image, exact(24, 16, gradient)).value;
  int outside = 0;
  double sum = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Measure m = one("rel_mse", image, noisy(24, 16, gradient, 0.08, seed));
    outside += m.low > want || m.high < want;
    sum += m.value / 400;
  }
  CAPTURE(outside, sum / want);
  CHECK(outside <= 42);
  CHECK(std::abs(sum / want - 1) < 0.02);
}

TEST_CASE("an image that differs by noise alone is below the noise floor", "[metrics]") {
  const Film truth = exact(24, 16, gradient);
  int below = 0, below_both = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Film r = noisy(24, 16, gradient, 0.02, seed);
    const Measure m = one("rel_l2", truth, r);
    below += m.below_floor;
    CHECK(m.floor == Approx(0.02).epsilon(0.2));
    below_both += one("rel_l2", noisy(24, 16, gradient, 0.02, 1000 + seed), r).below_floor;
    if (m.below_floor) CHECK_THAT(text(m), Catch::StartsWith("below noise floor, <= "));
  }
  // At least 0.95 of them, binomial: 85 is more than 4.5 standard deviations below.
  CHECK(below >= 85);
  CHECK(below_both >= 85);
}

TEST_CASE("percentiles give the range that the noise leaves", "[metrics]") {
  const Film truth = exact(32, 32, gradient);
  const Film image = exact(32, 32, [](int x, int y, int c) { return gradient(x, y, c) * (x < 8 ? 1.2 : 1.0); });
  const double right = one("p95", image, truth).value;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Measure m = one("p95", image, noisy(32, 32, gradient, 0.01, seed));
    CHECK(m.low <= right);
    CHECK(m.high >= right);
    CHECK(m.high - m.low < 0.1);
  }
}

TEST_CASE("images that cannot be judged are refused", "[metrics]") {
  const Film r = exact(8, 8, gradient);
  CHECK_THROWS_WITH(one("rmse", exact(8, 7, gradient), r), Catch::Contains("8x7") && Catch::Contains("8x8"));
  Film bad = r;
  bad.layers["mean"][3 * 9 + 1] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(one("rmse", bad, r), Catch::Contains("nan at pixel (1, 1)"));
  Film unknown_noise = r;
  unknown_noise.add("se");
  CHECK_THROWS_WITH(one("rmse", r, unknown_noise), Catch::Contains("noisy"));
  CHECK_THROWS_AS(compare_equal(r, r, "mean", {}, 1e-3), Error);
}

TEST_CASE("wrong pixels are counted", "[metrics]") {
  const Film r = exact(8, 8, gradient);
  double mean = 0;
  for (const float v : r.layers.at("mean")) mean += v / double(r.layers.at("mean").size());
  Film image = r;
  image.layers["mean"][0] += float(1.1e-4 * mean);
  image.layers["mean"][1] += float(1.1e-4 * mean);  // of the same pixel
  image.layers["mean"][5] -= float(0.8e-4 * mean);  // too little
  image.layers["mean"][3 * 9 + 2] -= float(mean);
  CHECK(one("wrong", r, r).value == 0);
  CHECK(one("wrong", image, r).value == 2.0 / 64);
  CHECK(one("wrong.r", image, r).value == 1.0 / 64);
  CHECK(std::isnan(one("wrong", r, noisy(8, 8, gradient, 0.01, 1)).value));
}

// False alarms of the three tests together at alpha = 0.05: binomial over 200 pairs, mean at most 10, standard
// deviation 3.1; 25 is 4.8 of them. Batches are skewed, blocks average 64 of them.
TEST_CASE("equal images pass the z-tests, biased ones do not", "[metrics]") {
  const Film truth = exact(32, 24, gradient);
  int alarms = 0;
  for (unsigned seed = 0; seed < 200; ++seed)
    alarms += !compare_equal(truth, noisy(32, 24, gradient, 0.05, seed), "mean", {}, 0.05).equal;
  CHECK(alarms <= 25);

  const Film other = noisy(32, 24, gradient, 0.05, 1);
  CHECK(compare_equal(noisy(32, 24, gradient, 0.05, 2), other, "mean", {}, 1e-4).equal);
  const auto scaled = [](double f) { return [f](int x, int y, int c) { return f * gradient(x, y, c); }; };
  const auto tested = [&](const Film& image) {
    return measure({"objections", "largest_z", "detectable_bias"}, image, other, "mean", {});
  };
  CHECK(tested(noisy(32, 24, gradient, 0.05, 2))[0].value == 0);
  CHECK(tested(exact(32, 24, scaled(1.01)))[0].value >= 1);
  CHECK(tested(exact(32, 24, scaled(1)))[2].value ==
        compare_equal(exact(32, 24, scaled(1)), other, "mean", {}, 1e-4).detectable_bias);
  CHECK(std::isnan(measure({"objections"}, exact(32, 24, gradient), exact(32, 24, gradient), "mean", {})[0].value));
  CHECK_THROWS_WITH(check_metric_name("foreground.objections", "here"), Catch::Contains("expected 'objections'"));
  const Equality biased = compare_equal(exact(32, 24, scaled(1.01)), other, "mean", {}, 1e-4);
  CHECK_FALSE(biased.equal);
  CHECK(biased.tested);
  CHECK(biased.detectable_bias < 0.01);
  const auto spot = [](int x, int y, int c) { return gradient(x, y, c) * (x < 8 && y < 8 ? 1.1 : 1.0); };
  const Equality local = compare_equal(exact(32, 24, spot), other, "mean", {}, 1e-4);
  CHECK_FALSE(local.equal);
  CHECK(local.largest_z > local.largest_threshold);
  // Shared random numbers: too little scatter, which the lower tail of chi-square finds.
  const Equality same = compare_equal(other, other, "mean", {}, 1e-4);
  CHECK_FALSE(same.equal);
}

}  // namespace metrics_test
