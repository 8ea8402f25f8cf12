// The table of extremes (corrected mathematics, section 12): every variant ends finite, or says why in a line.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "methods/legendre_fluids/light.h"
#include "tests/methods/legendre_fluids/extreme_scenes.h"
#include "tests/methods/legendre_fluids/flows.h"

namespace extremes_test {

using namespace airlight;
using namespace airlight::legendre_fluids::testing;
using Catch::Contains;

namespace {

const std::vector<Given> variants = {{{"variant", "galerkin"}},
                                     {{"variant", "paper"}},
                                     {{"variant", "paper"}, {"truncation", "l2"}},
                                     {{"variant", "paper_repaired"}},
                                     {{"variant", "paper_repaired"}, {"truncation", "l2"}}};

bool is_paper(const Given& variant) { return variant.count("variant") && variant.at("variant") == "paper"; }

// With Chebyshev's T the paper's advection is no isometry, repaired or not: it may end, with a line.
bool may_grow(const Given& variant) {
  return is_paper(variant) ||
         (variant.count("variant") && variant.at("variant") == "paper_repaired" && !variant.count("truncation"));
}

Given with_n(Given settings, int n) {
  settings["n"] = std::to_string(n);
  return settings;
}

// A swirl with a blob in a box whose half sizes are those of the basis.
FlowProblem swirl_and_blob(double viscosity) {
  FlowProblem problem = box(2);
  problem.box = {Point3(-1, -1, 0), Point3(1, 1, 0)};
  problem.velocity = scene::Swirl{1};
  problem.viscosity = problem.diffusivity = viscosity;
  problem.blobs.push_back({Point3(0.2, 0.1, 0), 0.5, 1, 0});
  return problem;
}

struct End {
  std::string says;  // empty: all steps were taken
  scene::Totals before, after;
};

// Throws what is not a scene::Unstable.
End run_to_end(const FlowProblem& problem, const Given& settings, double dt, int steps) {
  const auto flow = start(problem, settings);
  End end;
  end.before = flow->totals();
  try {
    run(*flow, steps, dt);
    end.after = flow->totals();
  } catch (const scene::Unstable& e) {
    end.says = e.what();
  }
  return end;
}

void check_finite(const End& end) {
  for (const double value : {end.after.energy, end.after.enstrophy, end.after.mass, end.after.density_least,
                             end.after.density_greatest, end.after.greatest_speed, end.after.divergence})
    CHECK(std::isfinite(value));
}

}  // namespace

TEST_CASE("legendre fluids, extremes: no step and no viscosity makes a value that is no number", "[legendre_fluids]") {
  for (const Given& variant : variants)
    for (const int n : {2, 3, 8})
      for (const double viscosity : {0.0, 1e-12, 1e-3, 1.0, 1e3})
        for (const double dt : {1e-4, 0.1, 10.0}) {
          const End end = run_to_end(swirl_and_blob(viscosity), with_n(variant, n), dt, 5);
          CAPTURE(variant, n, viscosity, dt, end.says);
          CHECK((end.says.empty() || may_grow(variant)));
          CHECK(end.says.find('\n') == std::string::npos);
          if (!end.says.empty()) {
            CHECK_THAT(end.says, Contains("step "));
            continue;
          }
          check_finite(end);
          if (may_grow(variant)) continue;
          CHECK(end.after.energy <= end.before.energy * (1 + 1e-10) + 1e-300);
          if (viscosity * dt >= 1e3) CHECK(end.after.energy == 0);
        }
}

TEST_CASE("legendre fluids, extremes: the paper's diffusion stops with a line where it amplifies",
          "[legendre_fluids]") {
  for (const int n : {4, 8, 16}) {
    const End end = run_to_end(swirl_and_blob(1e3), {{"variant", "paper"}, {"n", std::to_string(n)}}, 1, 3);
    CAPTURE(n);
    CHECK_THAT(end.says, Contains("step 1, t = 0 s") && Contains("energy"));
  }
}

TEST_CASE("legendre fluids, extremes: steps of a tenth of a millisecond keep the energy to rounding",
          "[legendre_fluids]") {
  const End end = run_to_end(swirl_and_blob(0), {{"n", "8"}}, 1e-4, 200);
  CHECK(std::abs(end.after.energy / end.before.energy - 1) < 200 * 2e-15);
  CHECK(std::abs(end.after.mass / end.before.mass - 1) < 200 * 2e-15);
}

TEST_CASE("legendre fluids, extremes: one coefficient is a fluid at rest, 32 keep their promises",
          "[legendre_fluids]") {
  for (const Given& variant : variants) {
    CAPTURE(variant);
    const End one = run_to_end(swirl_and_blob(0.1), with_n(variant, 1), 0.1, 3);
    check_finite(one);
    CHECK(one.after.energy == one.before.energy);
    CHECK(one.after.mass == Approx(one.before.mass).epsilon(1e-14));
    if (is_paper(variant)) {
      CHECK_THAT(objections(swirl_and_blob(0), with_n(variant, 32)).at(0),
                 Contains("1024 coefficients of a field: it solves dense systems of at most 1000"));
      continue;
    }
    const End many = run_to_end(swirl_and_blob(0.01), with_n(variant, 32), 0.01, 3);
    CHECK(many.says.empty());
    check_finite(many);
    CHECK(many.after.energy < many.before.energy);
    CHECK(many.after.divergence < 1e-11);
  }
}

TEST_CASE("legendre fluids, extremes: what is no number, no count and no box is refused in a line",
          "[legendre_fluids]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Given& variant : variants) {
    CAPTURE(variant);
    FlowProblem problem = swirl_and_blob(0);
    problem.blobs[0].density = nan;
    CHECK_THROWS_WITH(run(*start(problem, with_n(variant, 6)), 1, 0.1), Contains("no longer finite"));
    problem = swirl_and_blob(0);
    problem.velocity = scene::Swirl{nan};
    CHECK_THROWS_AS(run(*start(problem, with_n(variant, 6)), 1, 0.1), scene::Unstable);
    for (const char* n : {"0", "-3", "2.5", "nan", "65"}) {
      Given bad = variant;
      bad["n"] = n;
      CHECK_THROWS_WITH(start(box(2), bad), Contains("n = ") && Contains("expected"));
    }
  }
  for (const char* box :
       {"{ lo = [0, 0], hi = [0, 1] }", "{ lo = [0, 1], hi = [1, 0] }", "{ lo = [0, nan], hi = [1, 1] }"})
    CHECK_THROWS_WITH(
        scene::parse_flow(std::string("[flow]\ndimensions = 2\nduration = 1\nbox = ") + box, "f.toml", "."),
        Contains("f.toml:4:") && Contains("expected"));
}

TEST_CASE("legendre light, extremes: every row by rays and by the paper's systems", "[legendre_fluids][light]") {
  const legendre_fluids::LegendreLight method;
  for (const ExtremeLight& row : extreme_lights()) {
    check_light(row, test::picture(method, row.scene));
    for (const char* closure : {"least_squares", "upwind"})
      for (const char* n : {"1", "6"})
        check_paper_light(row,
                          test::picture(method, row.scene, {{"variant", "paper"}, {"closure", closure}, {"n", n}}));
  }
}

// The smallest depths keep their digits: light scattered is in proportion to the depth, to its square.
TEST_CASE("legendre light, extremes: a medium of depth 1e-6 sends a millionth", "[legendre_fluids][light]") {
  const legendre_fluids::LegendreLight method;
  const auto thin = [&](double depth) {
    return test::picture(method,
                         lit_scene(smoke(random_density({4, 4, 4}, 3), depth), oblique_light, oblique_view, 9, 7))
        .layer("airlight");
  };
  const std::vector<float> small = thin(1e-6), less = thin(1e-12);
  for (std::size_t i = 0; i < small.size(); ++i)
    CHECK(double(small[i]) == Approx(1e6 * double(less[i])).epsilon(1e-5).margin(1e-18));
}

}  // namespace extremes_test
