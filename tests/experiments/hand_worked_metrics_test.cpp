// Metrics of films of few values and few batches, worked by hand.
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/judging/batches.h"
#include "experiments/judging/metrics.h"
#include "experiments/judging/statistics.h"
#include "scene/base/error.h"

namespace hand_worked_metrics_test {

using namespace airlight::experiments;
using airlight::scene::Film;
using Catch::Contains;

namespace {

// All values of all pixels alike.
Film constant(double value, int w = 1, int h = 1) {
  Film film(w, h);
  film.add("mean").assign(3 * film.pixels(), float(value));
  return film;
}

std::string batch_name(std::size_t b) { return (b < 10 ? "batch.0" : "batch.") + std::to_string(b); }

// One pixel (or as many alike) from its batches.
Film from_batches(const std::vector<double>& batches, int w = 1, int h = 1) {
  double mean = 0;
  for (const double x : batches) mean += x / double(batches.size());
  Film film = constant(mean, w, h);
  for (std::size_t b = 0; b < batches.size(); ++b) film.add(batch_name(b)).assign(3 * film.pixels(), float(batches[b]));
  return film;
}

Measure one(const std::string& name, const Film& a, const Film& r, const Masks& masks = {},
            ImageNoise noise = ImageNoise::removed) {
  return measure({name}, a, r, "mean", masks, noise).at(0);
}

Approx near(double x) { return Approx(x).epsilon(2e-6).margin(1e-7); }

void same(const Measure& m, const Estimate& e) {
  CHECK(m.value == near(e.value));
  CHECK(m.low == near(e.low));
  CHECK(m.high == near(e.high));
}

}  // namespace

// Image 5, batches of the reference 1, 3, 2, 2: mean 2, variance of the mean (2/3)/4 = 1/6. Pairs of differences
// 4, 2, 3, 3: 9 - 1/6 = 53/6; of the reference 4 - 1/6 = 23/6. Without one batch: 7 (3, 2, 2 without 1), 11, 26/3,
// 26/3, and of the reference 16/3, 8/3, 11/3, 11/3.
TEST_CASE("squares of four batches by hand", "[metrics]") {
  const Film image = constant(5), reference = from_batches({1, 3, 2, 2});
  const Estimate squared = jackknife(53.0 / 6, std::vector<double>{7, 11, 26.0 / 3, 26.0 / 3});
  REQUIRE(squared.low > 0);
  const Measure rmse = one("rmse", image, reference);
  same(rmse, {std::sqrt(squared.value), std::sqrt(squared.low), std::sqrt(squared.high)});
  CHECK(rmse.floor == near(std::sqrt(1.0 / 6)));
  const Estimate ratio =
      jackknife(53.0 / 23, std::vector<double>{7 / (16.0 / 3), 11 / (8.0 / 3), 26.0 / 11, 26.0 / 11});
  const Measure squared_ratio = one("rel_l2_squared", image, reference);
  CHECK(squared_ratio.value == near(ratio.value));
  CHECK(squared_ratio.high == near(ratio.high));
  CHECK(squared_ratio.low == near(std::max(0.0, ratio.low)));
  CHECK(squared_ratio.floor == near(1.0 / 23));
  CHECK(one("rel_l2", image, reference).floor == near(std::sqrt(1.0 / 23)));
  // 5/2 - 1, and 5 over the means 7/3, 5/3, 2, 2.
  const Measure bias = one("bias", image, reference);
  same(bias, jackknife(1.5, std::vector<double>{8.0 / 7, 2, 1.5, 1.5}));
  CHECK(bias.floor == near((bias.high - bias.low) / 2 / 3.182446305));
  // With the image's batches the differences are 4, 0, 3, 1: mean 2, pairs 4 - (10/3)/4 = 19/6.
  CHECK(one("rmse", from_batches({5, 3, 5, 3}), reference).value == near(std::sqrt(19.0 / 6)));
}

// The image's batches 5, 3, 4, 4: mean 4, and its noise counts. Against 1 the squares are 9, and without one batch
// (11/3 - 1)^2, (13/3 - 1)^2, 9, 9 less what three batches have more noise than four: variances 1/3, 1/3, 1, 1 times
// 1/3 - 1/4.
TEST_CASE("counted noise of four batches by hand", "[metrics]") {
  const Film image = from_batches({5, 3, 4, 4});
  const auto counted = [&](const Film& reference) { return one("rmse", image, reference, {}, ImageNoise::counted); };
  const Estimate e = jackknife(9, std::vector<double>{85.0 / 12, 133.0 / 12, 107.0 / 12, 107.0 / 12});
  same(counted(constant(1)), {3, std::sqrt(e.low), std::sqrt(e.high)});
  CHECK(counted(constant(1)).floor == 0);
  // Against the batches 1, 3, 2, 2: pairs of differences 3, 1, 2, 2; without one (2/3, 5/3, 5/3), (10/3, 7/3, 7/3),
  // (3, 1, 2) twice, less the same. The floor is the reference's alone.
  const Estimate both = jackknife(23.0 / 6, std::vector<double>{59.0 / 36, 251.0 / 36, 43.0 / 12, 43.0 / 12});
  const Measure m = counted(from_batches({1, 3, 2, 2}));
  CHECK(m.value == near(std::sqrt(both.value)));
  CHECK(m.high == near(std::sqrt(both.high)));
  CHECK(m.low == near(std::sqrt(std::max(0.0, both.low))));
  CHECK(m.floor == near(std::sqrt(1.0 / 6)));
  CHECK(m.below_floor == (both.low <= 0));
}

// Image 5, batches 1, 3, 2 | 2, 4, 3: differences 4, 2, 3 | 3, 1, 2 with mean pairs 26/3 | 11/3 and denominators
// 1.01 * 2^2 | 1.01 * 3^2, each from the other half. One batch less: its half has a single pair and a mean of two.
TEST_CASE("rel_mse uses both halves, each above the other", "[metrics]") {
  const auto value = [](double pair1, double r1, double pair2, double r2) {
    return 0.5 * (pair1 / (1.01 * r2 * r2) + pair2 / (1.01 * r1 * r1));
  };
  const std::vector<double> without{value(6, 2.5, 11.0 / 3, 3), value(12, 1.5, 11.0 / 3, 3), value(8, 2, 11.0 / 3, 3),
                                    value(26.0 / 3, 2, 2, 3.5), value(26.0 / 3, 2, 6, 2.5),  value(26.0 / 3, 2, 3, 3)};
  const double whole = value(26.0 / 3, 2, 11.0 / 3, 3);
  const Estimate e = jackknife(jackknife_value(whole, without), without);
  const Measure m = one("rel_mse", constant(5), from_batches({1, 3, 2, 2, 4, 3}));
  CHECK(m.value == near(e.value));
  CHECK(m.high == near(e.high));
  CHECK(m.low == near(std::max(0.0, e.low)));
  // Variance of one batch 1.1, of the mean of six 1.1/6; mean 2.5.
  CHECK(m.floor == near(1.1 / 6 / (1.01 * 2.5 * 2.5)));
}

// Errors 0, 1/1000, ... of 1000 pixels against 1; halves of the batches agree, so that only the tails of the interval
// are left: half of what is above the percentile, on both sides.
TEST_CASE("percentiles and their tails by hand", "[metrics]") {
  Film reference = constant(1, 40, 25), image = reference;
  for (std::size_t b = 0; b < 16; ++b) reference.add(batch_name(b)).assign(3000, b % 2 ? 1.25f : 0.75f);
  for (std::size_t i = 0; i < 3000; ++i) image.layers["mean"][i] = float(1 + double(i / 3) / 1000);
  const auto at = [](double i) { return near(i / 1000 / 1.01); };
  const Measure m = one("p95", image, reference);
  CHECK(m.value == at(949));
  CHECK(m.low == at(924));
  CHECK(m.high == at(974));
  CHECK(m.floor == 0);
  CHECK_FALSE(m.below_floor);
  CHECK(one("p99", image, reference).value == at(989));
  CHECK(one("p99", image, reference).low == at(984));
  CHECK(one("p999", image, reference).value == at(998));
  // Halves that differ by 0.02 everywhere: half of that is the noise.
  for (std::size_t b = 0; b < 16; ++b)
    for (float& x : reference.layers[batch_name(b)]) x += b < 8 ? 0.01f : -0.01f;
  const Measure noisy = one("p95", image, reference);
  CHECK(noisy.floor == near(0.01 / 1.01));
  CHECK(noisy.low == near(0.914 / 1.01));
  CHECK(noisy.high == near(0.984 / 1.01));
}

// 1 - transmittance of 0.9e-3 and of 1.1e-3, in one channel.
TEST_CASE("the foreground begins at 1e-3", "[metrics]") {
  Film film = constant(1, 4, 1);
  film.add("transmittance").assign(12, 1.0f);
  film.layers["transmittance"][0] = 1 - 0.9e-3f;
  film.layers["transmittance"][3 + 1] = 1 - 1.1e-3f;
  film.layers["transmittance"][6 + 2] = 0;
  CHECK(foreground_mask(film) == std::vector<unsigned char>{0, 1, 1, 0});
  CHECK(foreground_mask(constant(1)).empty());
}

// Pixels left out are left out of all that a metric looks at, the mean and the range of the reference too.
TEST_CASE("what is left out counts nowhere", "[metrics]") {
  Film reference(4, 1), image(4, 1);
  reference.add("mean") = {1, 1, 1, 2, 2, 2, 3, 3, 3, 1000, 1000, 1000};
  image.add("mean") = {1.5, 1.5, 1.5, 2, 2, 2, 3.5, 3.5, 3.5, 0, 0, 0};
  Masks masks;
  masks.left_out = {0, 0, 0, 1};
  CHECK(one("rmse", image, reference, masks).value == near(std::sqrt(0.5 / 3)));
  CHECK(one("bias", image, reference, masks).value == near(1.0 / 6));
  // Smoothed: (1 + 2) / 2 and (2 + 3) / 2.
  CHECK(one("rmse_range", image, reference, masks).value == near(std::sqrt(0.5 / 3)));
  CHECK(one("rel_mse", image, reference, masks).value == near(0.25 / 3 * (1 / 1.04 + 1 / 9.04)));
  CHECK(one("p95", image, reference, masks).value == near(0.5 / 1.03));
  CHECK(one("wrong", image, reference, masks).value == near(2.0 / 3));
  masks.left_out = {0, 1, 1, 1};
  masks.foreground = {0, 1, 1, 1};
  CHECK(std::isnan(one("foreground.rmse", image, reference, masks).value));  // nothing is left
}

TEST_CASE("what a measure says", "[metrics]") {
  CHECK(text({"", 0.12344, 0.1, 0.2, 0, false}) == "0.1234 [0.1, 0.2]");
  CHECK(text({"", 0.1, 0.1, 0.1, 0, false}) == "0.1");
  CHECK(text({"", 0.1, -0.3, 0.2, 0, true}) == "below noise floor, <= 0.3");
  CHECK(text({"", std::nan(""), 0, 0, 0, false}) == "undefined");
}

// Three batches are no noise that can be known; other layers have batches of their own.
TEST_CASE("batches are found by their layer, four or more", "[metrics]") {
  CHECK_THROWS_WITH(batches(from_batches({1, 2, 3}), "mean", "it"), Contains("it") && Contains("has 3 batches"));
  CHECK(batches(from_batches({1, 2, 3, 4}), "mean", "it").size() == 4);
  CHECK(batches(constant(1), "mean", "it").empty());
  Film film = from_batches({1, 2, 3, 4});
  film.add("airlight").assign(3, 1.0f);
  CHECK_THROWS_WITH(batches(film, "airlight", "it"), Contains("has 0 batches"));
  for (int b = 0; b < 5; ++b) film.add("airlight.batch.0" + std::to_string(b)).assign(3, float(b));
  CHECK(batches(film, "airlight", "it").size() == 5);
  CHECK(batches(film, "airlight", "it")[3][2] == 3);
  CHECK_THROWS_WITH(one("rmse", from_batches({1, 2, 3, 4, 5}), from_batches({1, 2, 3, 4})), Contains("5 batches"));
}

// No sample met anything: the batches are 0, and the standard error says how much may be there all the same.
TEST_CASE("a pixel without a contributing sample is not exact", "[metrics]") {
  Film reference = from_batches({0, 0, 0, 0, 0, 0}, 2, 1);
  reference.add("se").assign(6, 0.0f);
  for (int i = 0; i < 3; ++i) {  // the second pixel: mean 3, seen by the batches
    reference.layers["se"][3 + i] = 0.5f;
    reference.layers["mean"][3 + i] = 3;
    for (std::size_t b = 0; b < 6; ++b) reference.layers[batch_name(b)][3 + i] = b % 2 ? 4.0f : 2.0f;
  }
  Film image(2, 1);
  image.add("mean") = {0.1f, 0.1f, 0.1f, 3, 3, 3};
  CHECK(unresolved(reference, "mean", "it").empty());
  const Measure certain = one("bias", image, reference);
  for (int i = 0; i < 3; ++i) reference.layers["se"][i] = 0.2f;
  CHECK(unresolved(reference, "mean", "it") == std::vector<float>{0.2f, 0.2f, 0.2f, 0, 0, 0});
  const Measure bias = one("bias", image, reference);
  CHECK(bias.value == near(certain.value));
  CHECK(bias.high - certain.high == near(0.2 / 3));  // 3 channels of 0.2 over a sum of 9
  CHECK(certain.low - bias.low == near(0.2 / 3));
  // 0.1 against 0 up to 0.2: the square is between 0 and 0.09 instead of 0.01; half of the pixels.
  image.layers["mean"] = {0.1f, 0.1f, 0.1f, 10, 10, 10};
  Film sure = reference;
  sure.layers["se"].assign(6, 0.0f);
  const Measure wide = one("rmse", image, reference), narrow = one("rmse", image, sure);
  const auto squared = [](double x) { return Approx(x * x).epsilon(1e-6); };
  CHECK(wide.high * wide.high - 0.04 == squared(narrow.high));
  CHECK(wide.low * wide.low + 0.005 == squared(narrow.low));
  CHECK(wide.floor * wide.floor - 0.02 == squared(narrow.floor));
  // Percentiles: 0.2 over 0 + 0.01 * 3.
  CHECK(one("p95", image, reference).floor == near(0.2 / 0.03));
  // Both pixels without a contribution: of all their samples together 3 may have been missed, not 3 in each.
  Film alike = from_batches({1, 1, 1, 1, 1, 1}, 2, 1);
  alike.add("se").assign(6, 0.2f);
  CHECK(one("bias", image, alike).high - one("bias", image, alike).value == near(3 * 0.2 / 6));
  reference.layers["se"][0] = -1;
  CHECK_THROWS_WITH(one("bias", image, reference), Contains("below 0"));
}

}  // namespace hand_worked_metrics_test
