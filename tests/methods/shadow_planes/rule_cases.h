// Random lit parts for the mapped rule, and what its errors are.
#pragma once
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "methods/shadow_planes/phase_form.h"
#include "scene/math/types.h"

namespace shadow_planes_test {

// Greatest relative errors over rule_cases(): of single precision with 8 and 16 nodes, of double with 32 and 64. The
// specification's table has one digit of the greatest error among cases of its own: ours are .4 to 2.6 times those.
struct RuleErrors {
  airlight::shadow_planes::PhaseForm phase;
  double float_8, float_16, double_32, double_64;
};
inline std::vector<RuleErrors> rule_errors() {
  using Kind = airlight::shadow_planes::PhaseForm::Kind;
  return {{{Kind::isotropic, 0, 1}, 3e-4, 2e-6, 1e-10, 1e-14},
          {{Kind::rayleigh, 0, 1}, 8e-4, 4e-6, 6e-10, 1e-14},
          {{Kind::hazy, 0, 1}, 5e-3, 3e-5, 2e-8, 1e-14},
          {{Kind::murky, 0, 1}, 1e-2, 1e-4, 1e-6, 8e-14},
          {{Kind::henyey_greenstein, 0.7, 1}, 3e-4, 2e-6, 1e-10, 1e-14},
          {{Kind::henyey_greenstein, 0.9, 1}, 3e-4, 2e-6, 1e-10, 1e-14},
          {{Kind::henyey_greenstein, -0.7, 1}, 3e-3, 1e-5, 6e-10, 1e-14},
          {{Kind::henyey_greenstein, -0.9, 1}, 4e-2, 1e-4, 2e-8, 3e-14}};
}

// h = 1: a in [1e-6, 1e4], angles to 1e-5 of +-pi/2, lengths from 1e-6 to infinite.
struct RuleInput {
  float a, d0, length;
};
inline std::vector<RuleInput> rule_cases() {
  using airlight::pi;
  std::mt19937_64 engine(5);
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine); };
  std::vector<RuleInput> cases;
  for (int i = 0; i < 4000; ++i) {
    const float a = float(std::pow(10, uniform(-6, 4)));
    const double limit = 0.5 * pi - 1e-5, theta = uniform(-limit, limit);
    const float d0 = float(std::tan(theta));
    const double kind = uniform(0, 1);
    const float length = kind < 0.25  ? std::numeric_limits<float>::infinity()
                         : kind < 0.5 ? float(std::pow(10, uniform(-6, 3)))
                                      : float(std::tan(uniform(theta, limit))) - d0;
    if (length > 0) cases.push_back({a, d0, length});
  }
  return cases;
}

}  // namespace shadow_planes_test
