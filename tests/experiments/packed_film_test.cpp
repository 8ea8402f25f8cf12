// Packed films of committed references: rounding adds the noise that it states, and no bias.
#include "experiments/driver/packed_film.h"

#include <catch2/catch.hpp>

#include "experiments/judging/batches.h"
#include "experiments/judging/metrics.h"
#include "tests/experiments/noisy_films.h"
#include "tests/temporary_folder.h"

namespace packed_film_test {

using namespace airlight::experiments;
using namespace airlight::test;
using airlight::TemporaryFolder;

namespace {

constexpr int width = 96, height = 64;

Film packed_and_read(const Film& film, const std::string& layer = "mean") {
  const TemporaryFolder folder;
  write_packed(folder.file("a.exr"), film, layer);
  return read_packed(folder.file("a.exr"));
}

}  // namespace

TEST_CASE("a film without noise is kept exactly, and only its layer", "[packed_film]") {
  Film film = exact(width, height, gradient);
  film.layers["airlight"] = film.layers["mean"];
  film.layers["airlight"][5] = 1.0f / 3;
  film.metadata["scene"] = "fog";
  const Film read = packed_and_read(film, "airlight");
  CHECK(read.layers.size() == 1);
  CHECK(read.layer("airlight") == film.layer("airlight"));
  CHECK(read.metadata.at("scene") == "fog");
  CHECK(read.metadata.at("kept") == "layer airlight exactly");
}

// Errors in units of the step: uniform in [-1/2, 1/2], independent of those of other batches. A test at z = 4.9 errs once in
// a million; there are three.
TEST_CASE("rounding of batches is unbiased, uniform and independent", "[packed_film]") {
  const Film film = noisy(width, height, gradient, 0.02, 1);
  const Film read = packed_and_read(film);
  const auto before = batches(film, "mean", "before"), after = batches(read, "mean", "after");
  REQUIRE(after.size() == 16);
  double sum = 0, squares = 0, products = 0, count = 0, pairs = 0;
  for (std::size_t i = 0; i < before[0].size(); i += 3) {  // one channel: they share the random numbers
    double mean = 0, variance = 0;
    for (const auto& b : before) mean += b[i] / 16;
    for (const auto& b : before) variance += (b[i] - mean) * (b[i] - mean) / 15;
    const double step = std::exp2(std::floor(std::log2(std::sqrt(variance))));
    double last = 0;
    for (std::size_t b = 0; b < 16; ++b) {
      const double error = (double(after[b][i]) - before[b][i]) / step;
      REQUIRE(std::abs(error) <= 0.5 + 1e-4);
      sum += error;
      squares += error * error;
      count += 1;
      if (b % 2 == 1) {
        products += error * last;
        pairs += 1;
      }
      last = error;
    }
  }
  const double twelfth = 1.0 / 12;
  CHECK(std::abs(sum) < 4.9 * std::sqrt(count * twelfth));
  CHECK(std::abs(squares / count - twelfth) < 4.9 * std::sqrt((1.0 / 80 - twelfth * twelfth) / count));
  CHECK(std::abs(products) < 4.9 * std::sqrt(pairs) * twelfth);
}

TEST_CASE("metrics against a packed film see its noise, 1 to 4 % more than before", "[packed_film]") {
  const Film reference = noisy(width, height, gradient, 0.02, 2);
  const Film image = exact(width, height, [](int x, int y, int c) { return 1.03 * gradient(x, y, c); });
  const Film read = packed_and_read(reference);
  for (const std::string name : {"rel_l2", "bias", "rel_mse"}) {
    CAPTURE(name);
    const Measure before = measure({name}, image, reference, "mean", {})[0];
    const Measure after = measure({name}, image, read, "mean", {})[0];
    // Both are right: the error is 3 %, which squared and averaged as rel_mse does is a little less.
    CHECK(after.low <= before.high);
    CHECK(after.high >= before.low);
    if (name != "rel_mse") {
      CHECK(after.low <= 0.03);
      CHECK(after.high >= 0.03);
    }
    if (name == "rel_l2") {
      CHECK(after.floor > 1.005 * before.floor);
      CHECK(after.floor < 1.045 * before.floor);
    }
  }
}

TEST_CASE("values without scatter keep their value and standard error, the others get theirs from the batches",
          "[packed_film]") {
  Film film = noisy(width, height, gradient, 0.02, 3);
  auto& errors = film.add("se");
  std::fill(errors.begin(), errors.end(), 7.0f);  // of the samples: not kept
  for (int b = 0; b < 16; ++b) film.layers[batch_name(b)][30] = film.layers[batch_name(b)][31] = 1.0f / 3;
  film.layers["mean"][30] = film.layers["mean"][31] = 1.0f / 3;
  errors[30] = 0.123456789f;
  errors[31] = 0;
  const Film read = packed_and_read(film);
  for (const std::size_t i : {30, 31}) {
    CHECK(read.layer("mean")[i] == film.layer("mean")[i]);
    CHECK(read.layer("se")[i] == errors[i]);
    CHECK(read.layer("batch.07")[i] == 1.0f / 3);
  }
  CHECK(unresolved(read, "mean", "film") == unresolved(film, "mean", "film"));
  double mean = 0, variance = 0;
  for (int b = 0; b < 16; ++b) mean += read.layer(batch_name(b))[500] / 16;
  for (int b = 0; b < 16; ++b) variance += std::pow(read.layer(batch_name(b))[500] - mean, 2) / 15;
  CHECK(read.layer("mean")[500] == Approx(mean));
  CHECK(read.layer("se")[500] == Approx(std::sqrt(variance / 16)));
}

TEST_CASE("noise of any size is rounded by at most half its scatter", "[packed_film]") {
  for (const double scale : {1e-30, 1.0, 1e30})
    for (const double sigma : {1e-7, 1e-3, 0.5}) {  // the first is the last bit of single precision
      CAPTURE(scale, sigma);
      const Film film = noisy(
          16, 8, [&](int x, int y, int c) { return scale * gradient(x, y, c); }, sigma, 4);
      const Film read = packed_and_read(film);
      for (std::size_t i = 0; i < film.layer("mean").size(); ++i) {
        double mean = 0, variance = 0;
        for (int b = 0; b < 16; ++b) mean += film.layer(batch_name(b))[i] / 16.0;
        for (int b = 0; b < 16; ++b) variance += std::pow(film.layer(batch_name(b))[i] - mean, 2) / 15;
        for (int b = 0; b < 16; ++b) {
          const float before = film.layer(batch_name(b))[i], after = read.layer(batch_name(b))[i];
          CHECK(std::abs(double(after) - before) <= 0.5001 * std::sqrt(variance) + 0x1p-24 * std::abs(before));
        }
      }
    }
}

TEST_CASE("a noisy film without batches, and a file that is no packed film, are refused", "[packed_film]") {
  const TemporaryFolder folder;
  Film film = exact(8, 8, gradient);
  film.add("se")[0] = 1;
  CHECK_THROWS_WITH(write_packed(folder.file("a.exr"), film, "mean"), Catch::Contains("0 batches"));
  CHECK_THROWS_WITH(write_packed(folder.file("a.exr"), film, "airlight"), Catch::Contains("airlight"));
  airlight::scene::write_exr(folder.file("b.exr"), film);
  CHECK_THROWS_WITH(read_packed(folder.file("b.exr")), Catch::Contains("b.exr: no committed reference"));
}

}  // namespace packed_film_test
