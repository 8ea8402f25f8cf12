// Tone curves of 8-bit pictures: fixed points, order, range.
#include "scene/film/tone_curve.h"

#include <catch2/catch.hpp>

namespace tone_curve_test {

using namespace airlight;
using namespace airlight::scene;

TEST_CASE("tone curves: black and far above white, and no brighter light is darker", "[film]") {
  for (const auto& [name, tone] : tones()) {
    CAPTURE(name);
    CHECK(toned(tone, Rgb::Zero()).maxCoeff() < 1e-3);
    CHECK(toned(tone, Rgb::Constant(-1)).maxCoeff() < 1e-3);
    CHECK(toned(tone, Rgb::Constant(1e6)).minCoeff() > 0.999);
    double before = -1;
    for (double x = 1e-4; x < 1e3; x *= 1.3) {
      const double now = toned(tone, Rgb::Constant(x))[0];
      CHECK(now >= before);
      CHECK(now <= 1);
      before = now;
    }
  }
}

TEST_CASE("tone curves: values that are known", "[film]") {
  CHECK(toned(Tone::clamp, Rgb(0.25, 2, 0))[0] == 0.25);
  CHECK(toned(Tone::clamp, Rgb(0.25, 2, 0))[1] == 1);
  // (2.51 + 0.03) / (2.43 + 0.59 + 0.14)
  CHECK(toned(Tone::aces, Rgb::Ones())[0] == Approx(2.54 / 3.16).epsilon(1e-12));
  // AgX keeps middle grey: its sigmoid's pivot. Its matrix keeps white to 2e-4.
  const Rgb grey = toned(Tone::agx, Rgb::Constant(0.18));
  CHECK(grey[0] == Approx(0.18).epsilon(1e-3));
  CHECK(grey[2] == Approx(0.18).epsilon(1e-3));
  // Pure red loses saturation.
  const Rgb red = toned(Tone::agx, Rgb(4, 0, 0));
  CHECK(red[0] > red[1]);
  CHECK(red[1] > 0.05);
}

}  // namespace tone_curve_test
