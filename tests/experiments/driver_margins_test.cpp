// How far gates are from failing.
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/driver/margins.h"

namespace driver_margins_test {

using namespace airlight::experiments;
using Catch::Contains;

namespace {

GateResult gate(const std::string& name, bool upper, double bound, double value) {
  GateResult result;
  result.name = "g/e: " + name;
  result.passed = true;
  result.upper = upper;
  result.bound = bound;
  result.measured = Estimate{value, value, value};
  result.kind = "deterministic";
  result.scene = name;
  return result;
}

}  // namespace

// 0.3 / 0.1 = 3; a figure of 0.8 that must be at least 0.2 could be 4 times less; 0 at most 0 is as tight as can be.
TEST_CASE("the margin of a gate is how many times worse its figure could be", "[driver]") {
  CHECK(margin(gate("a", true, 0.3, 0.1)) == Approx(3));
  CHECK(margin(gate("a", false, 0.2, 0.8)) == Approx(4));
  CHECK(margin(gate("a", true, 0, 0)) == 1);
  CHECK(margin(gate("a", true, 0, 0.1)) == 0);
  CHECK(std::isinf(margin(gate("a", true, 0.1, 0))));
  CHECK(std::isnan(margin(gate("bias", true, 0.1, -0.05))));
  CHECK(margin(gate("bias", true, -0.2, -0.3)) == Approx(1.5));     // at most -0.2: it may shrink by 1.5
  CHECK(margin(gate("bias", false, -0.05, -0.02)) == Approx(2.5));  // at least -0.05: it may grow by 2.5
  CHECK(std::isnan(margin(gate("bias", true, 0, -0.1))));
  GateResult undefined = gate("a", true, 0.1, 0);
  undefined.measured.reset();
  CHECK(std::isnan(margin(undefined)));
}

TEST_CASE("margins are counted up to the end of each class", "[driver]") {
  std::vector<GateResult> gates{gate("zero", true, 1, 0), gate("bias", true, 1, -1)};
  for (const double bound : {1.5, 1.51, 3.0, 3.01, 10.0, 10.01, 100.0, 100.1})
    gates.push_back(gate("a", true, bound, 1));
  CHECK_THAT(margins_text(gates), Contains("up to 1.5: 1, up to 3: 2, up to 10: 2, up to 100: 2, above 100: 1, above a "
                                           "measured 0: 1, without a ratio: 1\n"));
}

TEST_CASE("margins are listed with the loosest first, and counted", "[driver]") {
  GateResult failed = gate("failed", true, 0.1, 0.2), noisy = gate("noisy", true, 0.1, 0.02);
  failed.passed = false;
  failed.setting = "8, and \"more\"";
  failed.position = "e.toml:12:1";
  noisy.measured = Estimate{0.02, 0.01, 0.03};
  noisy.kind = "Monte Carlo";
  const std::vector<GateResult> gates{gate("tight", true, 0, 0), noisy, failed, gate("nothing", true, 0.1, 0)};
  const std::string text = margins_text(gates);
  CAPTURE(text);
  const auto at = [&](const char* name) { return text.find(std::string("g/e: ") + name); };
  CHECK(at("nothing") < at("noisy"));
  CHECK(at("noisy") < at("tight"));
  CHECK(at("tight") < at("failed"));
  CHECK_THAT(text, Contains("0.02 [0.01, 0.03]") && Contains("g/e: failed (FAILED)\n") &&
                       Contains("up to 1.5: 2, up to 10: 1, above a measured 0: 1\n"));
  CHECK_THAT(margins_csv(gates),
             Contains("\n5,at_most,0.1,0.02,0.01,0.03,Monte Carlo,ok,g/e,noisy,,,,\n") &&
                 Contains("\n0.5,at_most,0.1,0.2,0.2,0.2,deterministic,FAILED,g/e,failed,,\"8, and \"\"more\"\"\",,"
                          "e.toml:12:1\n"));
}

}  // namespace driver_margins_test
