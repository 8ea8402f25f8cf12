#include "scene/phase.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "scene/math/types.h"

namespace phase_test {

using namespace airlight::scene;

namespace {

const std::vector<PhaseFunction> all_phases = {Isotropic{},
                                               Rayleigh{},
                                               HenyeyGreenstein{0.0},
                                               HenyeyGreenstein{1e-12},
                                               HenyeyGreenstein{0.3},
                                               HenyeyGreenstein{-0.5},
                                               HenyeyGreenstein{0.9},
                                               HenyeyGreenstein{-0.999},
                                               Hazy{},
                                               Murky{}};

// Integrates over c in [-1, 1] with the sampled cosine as the variable: c = 1 - 2 s^k concentrates nodes where lobes
// are. The mean over u of f(c(u)) with 200 000 midpoints.
template <class F>
double mean_over_samples(const PhaseFunction& phase, F f) {
  const int n = 200000;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f(sample_phase_cosine(phase, (i + 0.5) / n));
  return sum / n;
}

}  // namespace

// If cosines are drawn with density q(c) = 2 pi p(c), then the mean of 1/q over samples is the length of [-1, 1], which
// is 2, for any p that is positive: one identity checks both that p integrates to 1 and that sampling follows p. The
// midpoint rule in u of the bounded, piecewise smooth integrand converges as n^-1 at worst where 1/q is steep: 1e-3 at
// g = -0.999 (1/q varies over 9 decades).
TEST_CASE("phase functions are normalised and sampled as they are evaluated", "[phase]") {
  for (const PhaseFunction& phase : all_phases) {
    const bool steep =
        std::holds_alternative<HenyeyGreenstein>(phase) && std::abs(std::get<HenyeyGreenstein>(phase).g) > 0.95;
    CAPTURE(phase_name(phase), mean_cosine(phase));
    const double length =
        mean_over_samples(phase, [&](double c) { return 1 / (2 * airlight::pi * phase_value(phase, c)); });
    CHECK(length == Approx(2.0).epsilon(steep ? 1e-2 : 1e-6));
  }
}

TEST_CASE("the mean cosine of samples is the closed form", "[phase]") {
  for (const PhaseFunction& phase : all_phases) {
    CAPTURE(phase_name(phase), mean_cosine(phase));
    CHECK(mean_over_samples(phase, [](double c) { return c; }) == Approx(mean_cosine(phase)).margin(1e-6));
  }
}

TEST_CASE("cosines stay in range for the extreme uniforms", "[phase]") {
  for (const PhaseFunction& phase : all_phases)
    for (const double u : {0.0, std::nextafter(0.0, 1.0), 0.5, std::nextafter(1.0, 0.0), 1.0}) {
      const double c = sample_phase_cosine(phase, u);
      CAPTURE(phase_name(phase), u);
      CHECK(c >= -1);
      CHECK(c <= 1);
    }
}

}  // namespace phase_test
