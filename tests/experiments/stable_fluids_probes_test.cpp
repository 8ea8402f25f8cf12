// Probes of Stable Fluids: what they count and compare, against closed forms and against one another. Times are the
// machine's.
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/probes.h"
#include "scene/base/error.h"
#include "tests/experiments/run_program.h"

namespace stable_fluids_probes_test {

using namespace airlight::experiments;
using Catch::Contains;

namespace {

Findings run(const std::string& name, const std::map<std::string, std::string>& settings, const std::string& file = "",
             int threads = 0) {
  const Probe& probe = find_probe(name, "test");
  airlight::scene::Execution execution;
  execution.threads = threads;
  return probe.run({file, {}, true}, {probe.settings(), settings}, execution);
}

double figure(const Findings& found, const std::string& name) {
  for (const Measure& m : found.figures)
    if (m.name == name) return m.value;
  FAIL("no figure " + name);
  return 0;
}

const std::string vectors = std::string(AIRLIGHT_SOURCE_DIR) + "/tests/vectors/references.json";

}  // namespace

TEST_CASE("cavity: closer the finer, and steady", "[stable_fluids][probes]") {
  const Findings coarse = run("cavity", {{"n", "12"}}, vectors), fine = run("cavity", {{"n", "24"}}, vectors);
  for (const char* name : {"u", "v"}) {
    CHECK(figure(coarse, name) < 0.06);
    CHECK(figure(fine, name) < 0.8 * figure(coarse, name));
    CHECK(figure(fine, std::string(name) + "_rms") <= figure(fine, name));
  }
  CHECK(figure(fine, "steps") == 25 * 24);
  CHECK(figure(fine, "change") < 1e-5);
  CHECK(figure(fine, "divergence") < 1e-12);
  const auto& y = fine.columns.at("y");
  const auto& u = fine.columns.at("u");
  REQUIRE((y.size() == 25 && u.size() == 25));
  CHECK((y.front() == 0 && y.back() == 1));
  CHECK((std::abs(u.front()) < 1e-12 && std::abs(u.back() - 1) < 1e-12));  // the floor, and the lid at its middle
  // Soon after the start nothing is steady, and nothing is as it will be.
  const Findings early = run("cavity", {{"n", "24"}, {"seconds", "1"}}, vectors);
  CHECK(figure(early, "change") > 0.01);
  CHECK(figure(early, "u") > 2 * figure(fine, "u"));
  // Longer steps are worse.
  CHECK(figure(run("cavity", {{"n", "24"}, {"cfl", "4"}}, vectors), "u_rms") > 1.2 * figure(fine, "u_rms"));
}

TEST_CASE("cavity: known values beside the solver's", "[stable_fluids][probes]") {
  const Findings ghia = run("cavity", {{"curve", "ghia"}, {"lid", "unit"}}, vectors);
  CHECK(figure(ghia, "u") == Approx(0.00504).epsilon(0.01));  // their own difference, at y = 0.8516
  CHECK(ghia.columns.at("u").size() == 15);
  const Findings spectral = run("cavity", {{"curve", "spectral"}, {"lid", "unit"}}, vectors);
  CHECK(figure(spectral, "ghia_u") == figure(ghia, "u"));
  CHECK(spectral.columns.at("v").at(3) == 0.0575362);
  const auto refused = [](std::map<std::string, std::string> settings, const std::string& file,
                          const std::string& message) {
    CHECK_THROWS_WITH(run("cavity", settings, file), Contains(message));
  };
  refused({}, "", "needs a [[scene]]");
  refused({{"reynolds", "200"}}, vectors, "no values at a Reynolds number of 200");
  refused({{"curve", "ghia"}}, vectors, "lid = unit only");
  refused({{"curve", "ghia"}, {"lid", "unit"}, {"reynolds", "400"}}, vectors, "Ghia et al. have no values");
  refused({}, std::string(AIRLIGHT_SOURCE_DIR) + "/tests/vectors/fogshop.json", "fluid-cavity-regular");
}

TEST_CASE("flow_stability: limited schemes stay bounded, unlimited ones do not", "[stable_fluids][probes]") {
  std::map<std::string, std::string> s{{"n", "24"}, {"steps", "40"}, {"cfl_per_decade", "2"}};
  const Findings limited = run("flow_stability", s);
  s["limiter"] = "none";
  const Findings unlimited = run("flow_stability", s);
  CHECK(figure(limited, "cells") == 7 * 13);
  for (const Findings* found : {&limited, &unlimited}) CHECK(figure(*found, "not_finite") == 0);
  CHECK(figure(limited, "greatest_growth") < 1.5);
  CHECK(figure(unlimited, "greatest_growth") > 2);
  CHECK(figure(unlimited, "growing") > figure(limited, "growing"));
  CHECK_THAT(unlimited.note, Contains("grows most at CFL"));
  const FigureMap& map = limited.map.value();
  REQUIRE(map.values.size() == 7 * 13);
  CHECK((map.x.values.front() == Approx(0.1) && map.y.values.back() == Approx(1e6)));
  // Nearly no viscosity and a short step: little is lost in the first of them. Much: all but nothing is left of it.
  CHECK(map.values[0] > 0.9);
  for (std::size_t x = 0; x < 7; ++x) {
    CHECK(map.values[x * 13 + 12] < 1e-8);
    for (std::size_t y = 9; y < 13; ++y) CHECK(map.values[x * 13 + y] < map.values[x * 13 + y - 1]);
  }
}

TEST_CASE("flow_stability: implicit viscosity takes what its closed factor says", "[stable_fluids][probes]") {
  // Where hardly anything but the slowest shear is left, a step of viscosity nu multiplies the energy by about
  // (1 / (1 + nu dt lambda))^2: in the map, ten times the viscosity is a hundredth of the energy.
  const Findings found =
      run("flow_stability", {{"n", "16"}, {"steps", "1"}, {"cfl_per_decade", "1"}, {"precision", "double"}});
  const FigureMap& map = found.map.value();
  for (std::size_t x = 0; x < 4; ++x)
    CHECK(map.values[x * 13 + 11] / map.values[x * 13 + 12] == Approx(100).epsilon(0.02));
  // One thread and two give equal values.
  const std::map<std::string, std::string> s{{"n", "8"}, {"steps", "3"}, {"cfl_per_decade", "1"}, {"dimensions", "3"}};
  const Findings one = run("flow_stability", s, "", 1), two = run("flow_stability", s, "", 2);
  CHECK(one.map->values == two.map->values);
}

TEST_CASE("pressure_solvers: iterations and what is left", "[stable_fluids][probes]") {
  const auto solved = [](const char* solver, const char* n, bool ball, const char* start, bool fine) {
    return run("pressure_solvers", {{"solver", solver},
                                    {"n", n},
                                    {"obstacle", ball ? "ball" : "none"},
                                    {"start", start},
                                    {"precision", fine ? "double" : "float"},
                                    {"tolerance", fine ? "1e-10" : "1e-6"},
                                    {"runs", "2"}});
  };
  for (const char* start : {"noise", "buoyancy"}) {
    const Findings direct = solved("transforms", "12", false, start, true);
    CHECK(figure(direct, "iterations") == 0);
    CHECK(figure(direct, "divergence") < 1e-13);
    CHECK(direct.runs == 2);
    // The preconditioner is the inverse.
    const Findings guess = solved("transforms_as_guess", "12", false, start, true);
    CHECK(figure(guess, "iterations") == 1);
    for (const bool fine : {false, true})
      for (const char* solver : {"incomplete_cholesky", "transforms_as_guess"}) {
        const Findings found = solved(solver, "12", true, start, fine);
        CHECK(found.counters.at("cells") == 1728);
        CHECK(found.counters.at("solid cells") == Approx(4 / 3. * airlight::pi * std::pow(0.2 * 12, 3)).epsilon(0.15));
        CHECK(figure(found, "iterations") > 3);
        CHECK(figure(found, "residual") <= (fine ? 1e-10 : 1e-6));
        CHECK(figure(found, "divergence") < (fine ? 1e-9 : 1e-5));
      }
  }
  const auto iterations = [&](const char* solver, const char* n) {
    return figure(solved(solver, n, true, "noise", true), "iterations");
  };
  CHECK(iterations("incomplete_cholesky", "24") > 1.3 * iterations("incomplete_cholesky", "10"));
  CHECK(iterations("transforms_as_guess", "24") < 1.3 * iterations("transforms_as_guess", "10"));
  const Findings plate =
      run("pressure_solvers", {{"solver", "incomplete_cholesky"}, {"n", "20"}, {"obstacle", "plate"}});
  CHECK(plate.counters.at("solid cells") == 16 * 2 * 20);
  CHECK_THROWS_WITH(solved("transforms", "8", true, "noise", true), Contains("without obstacles"));
}

}  // namespace stable_fluids_probes_test
