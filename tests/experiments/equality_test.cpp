// The tests of equality: power, range, and small cases by hand.
#include "experiments/judging/equality.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/judging/metrics.h"
#include "experiments/judging/statistics.h"
#include "tests/experiments/noisy_films.h"

namespace equality_test {

using namespace airlight::experiments;
using namespace airlight::test;

namespace {

double unit(int, int, int) { return 1; }

Film constant(int w, int h, double value) {
  return exact(w, h, [=](int, int, int) { return value; });
}

// Grey, normal, `sigma` per batch.
Film normal_noise(int w, int h, double sigma, unsigned seed) {
  std::normal_distribution<double> normal(0, sigma);
  const Noise noise = [&](std::mt19937_64& random) {
    const double x = normal(random);
    return std::array<double, 3>{x, x, x};
  };
  return noisy(w, h, unit, noise, seed);
}

// Bright samples that come `per_block` times in 64 pixels and 16 batches, and carry all the light: the mean over a
// block has the skewness of a Poisson number, 1 / sqrt(per_block).
Film fireflies(int w, int h, double per_block, unsigned seed) {
  const double rate = per_block / 1024;
  std::poisson_distribution<int> poisson(rate);
  const Noise noise = [&](std::mt19937_64& random) {
    const double x = poisson(random) / rate - 1;
    return std::array<double, 3>{x, x, x};
  };
  return noisy(w, h, unit, noise, seed);
}

}  // namespace

// One block of 8x8 pixels and sixteen batches of sigma 0.05: the mean has 0.05 / 32. A bias of what the noncentral t
// asks for is found in 0.95 of 2000 images (standard deviation 0.0049; 0.022 is 4.5 of them), and what is reported is
// that bias, up to the noise of the standard error (0.02 of its root mean square in 2000).
TEST_CASE("detectable_bias is found with probability 0.95", "[equality]") {
  const double sigma = 0.05 / 32, shift = detectable_shift(student_quantile(1 - 1e-4 / 6, 15), 15, 0.95);
  int found = 0;
  double squares = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    const Equality e =
        compare_equal(constant(8, 8, 1 + shift * sigma), normal_noise(8, 8, 0.05, seed), "mean", {}, 1e-4);
    found += std::abs(e.image_z) > e.image_threshold;
    squares += e.detectable_bias * e.detectable_bias / 2000;
  }
  CAPTURE(found, std::sqrt(squares) / sigma, shift);
  CHECK(std::abs(found / 2000.0 - 0.95) < 0.022);
  CHECK(std::sqrt(squares) == Approx(shift * sigma).epsilon(0.02));
}

// With 3 bright samples a block nine of ten equal images are told apart, by blocks that caught few or none: those
// objections are not sure. With 1000 they are as rare as they should be, and the test is within its range.
TEST_CASE("fireflies are out of the tests' range", "[equality]") {
  int alarms = 0, sure = 0, out = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Film image = constant(64, 48, 1), reference = fireflies(64, 48, 3, seed);
    const Equality e = compare_equal(image, reference, "mean", {}, 1e-4);
    alarms += objections(e, 1e-4) > 0;
    sure += sure_objections(e, 1e-4) > 0;
    out += !e.blocks_in_range;
    CHECK(e.block_skewness == Approx(-1 / std::sqrt(3.0)).epsilon(0.35));
    CHECK_FALSE(e.tested);
    CHECK_THAT(text(e), Catch::Contains("not tested"));
    const Measure m = measure({"objections"}, image, reference, "mean", {})[0];
    CHECK(m.value == objections(e, 1e-4));
    CHECK(m.low == 0);
  }
  CHECK(alarms > 40);
  CHECK(sure == 0);
  CHECK(out == 50);
  // 50 images at 1e-4: one alarm in 200 runs of the test.
  int rare_alarms = 0, rare_out = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Equality e = compare_equal(constant(64, 48, 1), fireflies(64, 48, 1000, seed), "mean", {}, 1e-4);
    rare_alarms += objections(e, 1e-4) > 0;
    rare_out += !e.blocks_in_range || !e.image_in_range;
  }
  CHECK(rare_alarms == 0);
  CHECK(rare_out == 0);
}

// A whole image of some 30 bright samples: even its mean is too skewed (0.18), so nothing is said about what it could
// show.
TEST_CASE("an image of few bright samples has no detectable bias", "[equality]") {
  const Film reference = fireflies(32, 24, 30.0 / 12, 5);
  const Equality e = compare_equal(constant(32, 24, 1), reference, "mean", {}, 1e-4);
  CHECK_FALSE(e.image_in_range);
  CHECK(std::isnan(measure({"detectable_bias"}, constant(32, 24, 1), reference, "mean", {})[0].value));
  CHECK(sure_objections(compare_equal(constant(32, 24, 100), reference, "mean", {}, 1e-4), 1e-4) == 0);
}

// A bias in range is sure: the interval of `objections` is its value.
TEST_CASE("objections in range are sure", "[equality]") {
  const Measure m = measure({"objections"}, constant(32, 24, 1.01), normal_noise(32, 24, 0.05, 1), "mean", {})[0];
  CHECK(m.value >= 2);
  CHECK(m.low == m.value);
  CHECK(m.high == m.value);
}

// Two pixels of one block, six batches: means 1, 2, 1, 2, 1, 2 (1.5, variance of one 0.3, of the mean 0.05) against 1.
TEST_CASE("one block by hand", "[equality]") {
  Film reference(2, 1);
  reference.add("mean").assign(6, 1.5f);
  for (int b = 0; b < 6; ++b) reference.add(batch_name(b)).assign(6, b % 2 ? 2.0f : 1.0f);
  const Equality e = compare_equal(constant(2, 1, 1), reference, "mean", {}, 0.06);
  const double z = normal_from_student(0.5 / std::sqrt(0.05), 5);
  CHECK(e.blocks == 3);  // one in each channel
  CHECK(e.largest_z == Approx(z));
  CHECK(e.image_z == Approx(-z));
  CHECK(e.chi_square == Approx(z * z));
  CHECK(e.chi_square_probability == Approx(2 * chi_square_above(z * z, 1)));
  CHECK(e.largest_threshold == Approx(sidak_threshold(3, 0.02)));
  CHECK(e.image_threshold == Approx(normal_quantile(1 - 0.01)));
  CHECK(e.detectable_bias == Approx(detectable_shift(student_quantile(0.99, 5), 5, 0.95) * std::sqrt(0.05) / 1.5));
  CHECK(e.block_skewness == Approx(0).margin(1e-9));
  CHECK(e.differing == 0);
  // Both noisy and alike: Welch's degrees are 10, the variances add.
  Film other = reference;
  for (auto& [name, values] : other.layers)
    for (float& x : values) x += 1;
  const Equality two = compare_equal(other, reference, "mean", {}, 0.06);
  CHECK(two.image_z == Approx(normal_from_student(1 / std::sqrt(0.1), 10)));
  // One pixel left out, whatever it holds.
  Film changed = reference;
  changed.layers["mean"][0] = changed.layers["batch.03"][1] = 50;
  CHECK(compare_equal(constant(2, 1, 1), changed, "mean", {1, 0}, 0.06).largest_z == Approx(z));
  CHECK_THROWS_WITH(compare_equal(constant(2, 1, 1), changed, "mean", {1, 1}, 0.06),
                    Catch::Contains("nothing to compare"));
  CHECK(std::isnan(measure({"objections"}, constant(2, 1, 1), changed, "mean", {{1, 1}, {}})[0].value));
}

// One batch of six brighter by 6: means 0, ..., 6 have the third central moment (125 - 5) 6 / (5 * 4) = 36 and variance
// 6; their mean 36/36 and 6/6: skewness 1 (and -1 of the difference).
TEST_CASE("skewness by hand", "[equality]") {
  Film reference(1, 1);
  reference.add("mean").assign(3, 1.0f);
  for (int b = 0; b < 6; ++b) reference.add(batch_name(b)).assign(3, b == 2 ? 6.0f : 0.0f);
  const Equality e = compare_equal(constant(1, 1, 1), reference, "mean", {}, 0.06);
  CHECK(e.block_skewness == Approx(-1));
  CHECK(e.image_skewness == Approx(-1));
  // The skewness of six normal values has the variance 6 6 5 / (4 7 9), of their mean 5/7 / 6: 0.345. Twice that and
  // 0.1 are less than 1, but not less than half of it.
  CHECK_FALSE(e.blocks_in_range);
  CHECK_FALSE(e.image_in_range);
  for (std::size_t c = 0; c < 3; ++c)
    for (const auto& [batch, value] : {std::pair{0, 3.0f}, std::pair{1, 3.0f}, std::pair{2, 6.0f}})
      reference.layers[batch_name(batch)][c] = value;
  // 0, 0, 0, 3, 3, 6: mean 2, squares of differences 30, cubes 3 (-8) + 2 + 64 = 42. Third cumulant 42 6 / (5 4),
  // variance 6; of the mean a 36th and a sixth.
  const Equality milder = compare_equal(constant(1, 1, 1), reference, "mean", {}, 0.06);
  CHECK(milder.block_skewness == Approx(-42 * 6 / 20.0 / 36));
  CHECK(milder.blocks_in_range);
  CHECK(milder.image_in_range);
}

// Blocks without noise differ or they do not; where the standard error knows of more than the batches, nothing is sure.
TEST_CASE("blocks without noise", "[equality]") {
  Film reference = normal_noise(16, 8, 0.05, 3);
  const auto silence = [](Film& film) {  // the left block
    for (auto& [name, values] : film.layers)
      for (std::size_t i = 0; i < values.size(); ++i)
        if (i / 3 % 16 < 8) values[i] = 0;
  };
  silence(reference);
  Film image = constant(16, 8, 1);
  silence(image);
  CHECK(compare_equal(image, reference, "mean", {}, 1e-4).differing == 0);
  CHECK(compare_equal(image, reference, "mean", {}, 1e-4).blocks == 3);
  for (std::size_t i = 0; i < 384; ++i)
    if (i / 3 % 16 < 8) image.layers["mean"][i] = 1e-6f;
  const Equality differs = compare_equal(image, reference, "mean", {}, 1e-4);
  CHECK(differs.differing == 3);
  CHECK(objections(differs, 1e-4) == 1);
  CHECK(sure_objections(differs, 1e-4) == 1);
  // An upper end of 64e-6, shared by the 64 pixels there, which are off by 1e-6 each: z is 1. A sixteenth of it is too
  // little.
  reference.add("se").assign(384, 0.0f);
  for (std::size_t i = 0; i < 384; ++i) reference.layers["se"][i] = i / 3 % 16 < 8 ? 64e-6f : 0.01f;
  const Equality unknown = compare_equal(image, reference, "mean", {}, 1e-4);
  CHECK(unknown.differing == 0);
  CHECK(unknown.blocks == 6);
  CHECK(unknown.largest_z < 4);
  CHECK(objections(unknown, 1e-4) == 0);
  for (std::size_t i = 0; i < 384; ++i) reference.layers["se"][i] = i / 3 % 16 < 8 ? 4e-6f : 0.01f;
  CHECK(objections(compare_equal(image, reference, "mean", {}, 1e-4), 1e-4) > 0);
}

// A standard error far above the scatter in every other block, whose batches are all equal at one pixel: those blocks are
// far too alike, and say nothing of the noise. The others' lower tail is as rare as it should be: each of three
// independent channels objects at 0.05, so that 0.1426 of images do (57 of 400, standard deviation 7.0; 28 is 4 of them).
TEST_CASE("blocks whose variance is an upper end are not too alike", "[equality]") {
  std::normal_distribution<double> normal(0, 0.05);
  const Noise noise = [&](std::mt19937_64& random) {
    const double r = normal(random), g = normal(random);
    return std::array<double, 3>{r, g, normal(random)};
  };
  const auto know_more = [](Film film) {
    auto& se = film.add("se");
    se.assign(film.layers["mean"].size(), 0.0125f);
    for (int y = 0; y < film.height; y += 8)
      for (int x = (y / 8) % 2 * 8; x < film.width; x += 16)
        for (int c = 0; c < 3; ++c) {
          const auto i = std::size_t(3 * (y * film.width + x) + c);
          se[i] = 2;
          film.layers["mean"][i] = 1;
          for (int b = 0; b < 16; ++b) film.layers[batch_name(b)][i] = 1;
        }
    return film;
  };
  int alarms = 0, others = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Film reference = know_more(noisy(64, 48, unit, noise, seed));
    const Equality e = compare_equal(constant(64, 48, 1), reference, "mean", {}, 0.9);
    REQUIRE(e.blocks == 144);
    alarms += e.too_alike;
    others += !e.too_alike && e.chi_square_probability < 0.1;
  }
  CAPTURE(alarms, others);
  CHECK(std::abs(alarms - 57) < 28);
  CHECK(others == 0);  // the upper tail is of all blocks
  // Images that share their random numbers are still found out, by the blocks that know their noise.
  const Film same = know_more(noisy(64, 48, unit, noise, 1));
  CHECK(compare_equal(same, same, "mean", {}, 1e-4).too_alike);
}

// An image that is its reference: every z is 0, and no chance makes 36 of them so.
TEST_CASE("shared random numbers scatter too little", "[equality]") {
  const Film reference = noisy(32, 24, gradient, 0.05, 1);
  const Equality e = compare_equal(reference, reference, "mean", {}, 1e-4);
  CHECK(e.largest_z == 0);
  CHECK(e.chi_square_probability < 1e-9);
  CHECK(objections(e, 1e-4) == 1);
  CHECK_FALSE(e.equal);
  CHECK_THAT(text(e), Catch::StartsWith("different, too alike"));
  const Equality biased = compare_equal(constant(32, 24, 1.01), normal_noise(32, 24, 0.05, 1), "mean", {}, 1e-4);
  CHECK_THAT(text(biased), Catch::StartsWith("different: "));
}

}  // namespace equality_test
