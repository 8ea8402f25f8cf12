// Light in Legendre boxes, variant `ray`: closed forms, extremes, quadrature of high order.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>

#include "methods/legendre_fluids/light.h"
#include "reference/deterministic/renderer.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

using namespace airlight;
using namespace airlight::test;
using namespace airlight::legendre_fluids::testing;

namespace {

const legendre_fluids::LegendreLight method;
bool figures() { return std::getenv("AIRLIGHT_TEST_FIGURES") != nullptr; }

}  // namespace

TEST_CASE("legendre light: rays equal quadrature at every optical depth", "[legendre_fluids][light]") {
  double worst = 0;
  for (const int n : {4, 6})
    for (const double decay : {2.0, 0.0})
      for (const double depth : {1e-2, 1e-1, 1.0, 5.0, 20.0, 100.0, 1e3, 1e4}) {
        const auto scene =
            lit_scene(smoke(random_density({n, n, n}, 3, decay), 0.5 * depth), oblique_light, oblique_view, 16, 16);
        const scene::Rendering got = render(method, scene);
        const scene::Film truth = picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-9"}});
        const double error = relative_l2(got.film, truth);
        worst = std::max(worst, error);
        if (figures())
          fmt::print("n {} decay {} depth {}: error {:.1e}, transmittance {:.1e}; {:.1f} us, {:.1f} points a ray\n", n, decay,
                     depth, error, relative_l2(got.film, truth, "transmittance"), got.times[0].seconds / 256 * 1e6,
                     got.counters.at("points") / 256);
        CHECK(error <= 4e-6);
      }
  if (figures()) fmt::print("worst {:.1e}\n", worst);
}
