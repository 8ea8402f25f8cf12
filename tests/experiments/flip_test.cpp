// HDR-FLIP beside its authors' own program (flip_oracle.py), and what it must be by its definition.
#include "experiments/judging/flip.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "experiments/judging/metrics.h"
#include "tests/experiments/noisy_films.h"

namespace flip_test {

using namespace airlight::experiments;
using airlight::scene::Film;

namespace {

constexpr int width = 48, height = 36;

struct Pair {
  std::vector<float> image, reference;
};

// Makes the pictures of flip_oracle.py.
Pair pictures(const std::string& kind) {
  Pair pair;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float smooth = float(2 * x + 3 * y + 20 * c + 10) / 200.0F;
        const float third = float((37 * x + 101 * y + 59 * c + 7 * x * y) % 97) / 97.0F;
        const float rough = third * third * third;
        const int steps = (13 * x + 29 * y + 17 * c) % 11 - 5;
        const float bump = float(steps) / 5.0F;
        const bool inside = x >= 16 && x < 30 && y >= 8 && y < 22;
        float image = 0, reference = smooth;
        if (kind == "brighter") image = smooth * 1.2F;
        if (kind == "noise") image = smooth * (1 + 0.25F * bump);
        if (kind == "edge") image = inside ? smooth * 0.5F : smooth;
        if (kind == "rough") reference = rough, image = rough * (1 + 0.1F * bump);
        if (kind == "range") reference = (inside ? 60.0F : 1.0F) * smooth, image = reference * (1 + 0.05F * bump);
        if (kind == "colour") image = smooth * (c == 2 ? 0.7F : 1.0F);
        if (kind == "partly black") {
          reference = y < 12 ? 0 : smooth;
          image = inside ? reference + 0.1F : reference;
        }
        pair.image.push_back(image);
        pair.reference.push_back(reference);
      }
  return pair;
}

struct Known {
  const char* kind;
  double mean, greatest, start, stop;
  std::size_t exposures;
};

}  // namespace

TEST_CASE("FLIP is what its authors' program finds", "[metrics][flip]") {
  // Its arithmetic is of 32 bits, and it filters two axes at once.
  constexpr double rounding = 2e-5;
  const Known known[] = {
      {"brighter", 0.1319614, 0.2372439, 0.905749, 1.736289, 2},
      {"noise", 0.0432217, 0.1714495, 0.905749, 1.736289, 2},
      {"edge", 0.0702767, 0.5201437, 0.905749, 1.736289, 2},
      {"rough", 0.0298052, 0.0981138, 1.556143, 3.414050, 2},
      {"range", 0.0149933, 0.0573476, -4.391061, 1.616623, 7},
      {"colour", 0.2205153, 0.2802058, 0.905749, 1.736289, 2},
      {"partly black", 0.0630378, 0.9720121, 0.905749, 1.830010, 2},
  };
  for (const Known& k : known) {
    INFO(k.kind);
    const Pair p = pictures(k.kind);
    const std::vector<double> exposures = flip_exposures(p.reference);
    REQUIRE(exposures.size() == k.exposures);
    CHECK(exposures.front() == Approx(k.start).margin(1e-5).epsilon(0));
    CHECK(exposures.back() == Approx(k.stop).margin(1e-5).epsilon(0));
    CHECK(flip(p.image, p.reference, width, height) == Approx(k.mean).margin(rounding).epsilon(0));
    const std::vector<double> map = flip_map(p.image, p.reference, width, height);
    CHECK(*std::max_element(map.begin(), map.end()) == Approx(k.greatest).margin(10 * rounding).epsilon(0));
  }
}

TEST_CASE("FLIP of a picture with itself is 0, and of black ones, too", "[metrics][flip]") {
  const Pair p = pictures("rough");
  CHECK(flip(p.reference, p.reference, width, height) == 0);
  const std::vector<float> black(p.reference.size(), 0);
  CHECK(flip_exposures(black).empty());
  CHECK(flip(black, black, width, height) == 0);
}

TEST_CASE("The exposures of a mostly black picture are those of what is lit", "[metrics][flip]") {
  Pair p = pictures("brighter");
  const std::vector<double> lit = flip_exposures(p.reference);
  std::vector<float> with_black(p.reference.size() * 2, 0);
  with_black.insert(with_black.end(), p.reference.begin(), p.reference.end());
  CHECK(flip_exposures(with_black) == lit);
}

TEST_CASE("The metric flip leaves pixels out, and knows the noise of its reference", "[metrics][flip]") {
  const auto brighter = [](int x, int y, int c) { return 1.2 * airlight::test::gradient(x, y, c); };
  const Film clean = airlight::test::exact(width, height, airlight::test::gradient);
  const Film image = airlight::test::exact(width, height, brighter);
  const Measure exact = measure({"flip"}, image, clean, "mean", {}, ImageNoise::removed).front();
  CHECK(exact.value == flip(image.layer("mean"), clean.layer("mean"), width, height));
  CHECK(exact.value > 0.05);
  CHECK((exact.low == exact.value && exact.high == exact.value && exact.floor == 0 && !exact.below_floor));

  const std::vector<unsigned char> all(std::size_t(width) * height, 1);
  CHECK(measure({"flip"}, image, clean, "mean", {all, {}}, ImageNoise::removed).front().value == 0);

  const Film noisy = airlight::test::noisy(width, height, airlight::test::gradient, 0.01, 1);
  const Measure off = measure({"flip"}, image, noisy, "mean", {}, ImageNoise::removed).front();
  CHECK(off.floor > 0);
  CHECK(off.floor < 0.5 * off.value);
  CHECK((off.low < exact.value && exact.value < off.high));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Film drawn = airlight::test::noisy(width, height, airlight::test::gradient, 0.01, seed);
    const Measure none = measure({"flip"}, clean, drawn, "mean", {}, ImageNoise::removed).front();
    CHECK(none.below_floor);
    CHECK(none.low == 0);
    CHECK(none.value == Approx(none.floor / 1.2).epsilon(0.1));
  }
  CHECK_THROWS(measure({"foreground.flip"}, image, clean, "mean", {{}, all}, ImageNoise::removed));
}

}  // namespace flip_test
