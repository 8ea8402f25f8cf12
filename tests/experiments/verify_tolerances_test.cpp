// Tolerances of oracle vectors, and their use by the readers.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "experiments/application/json_value.h"
#include "experiments/verify/check.h"
#include "experiments/verify/monte_carlo.h"
#include "experiments/verify/verify.h"
#include "tests/temporary_folder.h"

namespace verify_tolerances_test {

using namespace airlight;
using airlight::experiments::verify;
using airlight::experiments::VerifyProfile;

// The greatest allowed |got - expected|, tested at nine tenths and at eleven tenths of it.
TEST_CASE("tolerances are what they say", "[verify]") {
  using namespace airlight::experiments::verification;
  for (const double sign : {1.0, -1.0}) {
    CHECK(relative("", -20, -20 + sign * 0.9 * 20 * 1e-3, 1e-3).ok());
    CHECK_FALSE(relative("", -20, -20 + sign * 1.1 * 20 * 1e-3, 1e-3).ok());
    CHECK(absolute("", 20, 20 + sign * 0.9e-3, 1e-3).ok());
    CHECK_FALSE(absolute("", 20, 20 + sign * 1.1e-3, 1e-3).ok());
    // Standard errors 3 and 4 make 5; 2 of them and an accuracy of 1 are 11.
    CHECK(statistical("", 20, 3, 20 + sign * 10.9, 4, 2, 1).ok());
    CHECK_FALSE(statistical("", 20, 3, 20 + sign * 11.1, 4, 2, 1).ok());
  }
  CHECK(absolute("", 1, 1.5, 0.5).ok());  // the tolerance itself is within
  CHECK(relative("", 0, 1e-300, 1e-3).ok());
  CHECK_FALSE(relative("", 0, 1.1e-300, 1e-3).ok());
  CHECK(relative("", 0, 0.5, 1e-3, 0.5).ok());
  CHECK(truth("", true).ok());
  CHECK_FALSE(truth("", false).ok());
  CHECK(absolute("", infinity, infinity, 0).ok());
  CHECK_FALSE(absolute("", infinity, -infinity, 1).ok());
  for (const auto& [expected, got] : {std::pair{std::nan(""), 1.0}, std::pair{1.0, std::nan("")}})
    CHECK_FALSE(absolute("", expected, got, infinity).ok());
  // Once in 1.5e5 normal comparisons.
  CHECK(std::erfc(accept_se / std::sqrt(2.0)) == Approx(1 / 1.5e5).epsilon(0.03));
}

namespace {

// Every number below, moved by `share` of its tolerance; what is no fraction is a name or a count.
void move(nlohmann::json& v, double relative, double absolute) {
  if (v.is_structured())
    for (auto& item : v) move(item, relative, absolute);
  else if (v.is_number_float())
    v = v.get<double>() * (1 + relative) + absolute;
}

// The vectors of a kind, each as a file of its own, with their expected numbers moved by so many of their tolerances.
std::vector<std::string> moved(const std::string& kind, double tolerances) {
  std::ifstream in(AIRLIGHT_SOURCE_DIR "/tests/vectors/references.json");
  nlohmann::json file = nlohmann::json::parse(in);
  std::vector<std::string> files;
  for (nlohmann::json v : file["vectors"]) {
    if (v["kind"] != kind || !v["accuracy"].is_object()) continue;
    const bool relative = v["accuracy"].contains("rel");
    const double step = tolerances * v["accuracy"][relative ? "rel" : "abs"].get<double>();
    move(v["expected"], relative ? step : 0, relative ? 0 : step);
    files.push_back(nlohmann::json{{"part", "references"}, {"vectors", {v}}}.dump());
  }
  return files;
}

int verdict(const std::string& text) {
  const TemporaryFolder folder;
  folder.write("vectors.json", text);
  std::ostringstream out;
  return verify({folder.file("vectors.json")}, "", VerifyProfile::quick, out);
}

}  // namespace

// A number that verifies, moved by three times the tolerance that its vector states, is out: tolerances that a reader
// makes ten times as wide, or its own, would pass.
TEST_CASE("readers use the tolerance of the vector", "[verify]") {
  for (const char* kind : {"single_scattering_sphere", "single_scattering_box", "single_scattering_gaussians",
                           "optical_depth", "phase_function", "sampling", "statistics"})
    for (const double tolerances : {3.0, -3.0}) {
      CAPTURE(kind, tolerances);
      const std::vector<std::string> right = moved(kind, 0), wrong = moved(kind, tolerances);
      int compared = 0;
      for (std::size_t i = 0; i < right.size(); ++i) {
        if (verdict(right[i]) != 0) continue;  // of a method to come
        CHECK(verdict(wrong[i]) == 1);
        ++compared;
      }
      CHECK(compared > 0);
    }
}

// Every expected number of two vectors a kind that state their tolerance, moved by twenty of them: at least as many are out as there are vectors.
// All vectors of a kind have one reader. Kinds
// of whole numbers alone, which `move` leaves as they are, and those of Monte Carlo and of seconds are left out.
TEST_CASE("numbers of compensated ray marching are compared at the vectors' own tolerances", "[verify]") {
  std::ifstream in(AIRLIGHT_SOURCE_DIR "/tests/vectors/compensated_ray_marching.json");
  nlohmann::json file = nlohmann::json::parse(in), wrong = file;
  wrong["vectors"].clear();
  std::map<std::string, int> taken;
  for (nlohmann::json v : file["vectors"]) {
    const std::string kind = v["kind"];
    if (++taken[kind] > 2) continue;
    if (kind == "sh_triple_counts" || kind == "psh_address" || kind == "ol_table" || kind == "march_single_scattering")
      continue;
    const double rtol = v["rtol"], atol = v["atol"];
    move(v["expected"], 20 * rtol, 20 * atol + (rtol + atol == 0 ? 1 : 0));
    wrong["vectors"].push_back(v);
  }
  const TemporaryFolder folder;
  folder.write("vectors.json", wrong.dump());
  std::ostringstream out;
  std::vector<airlight::experiments::VerifyKind> kinds;
  CHECK(verify({(folder.path() / "vectors.json").string()}, "", VerifyProfile::quick, out, &kinds) == 1);
  CHECK(kinds.size() == 26);
  for (const auto& kind : kinds) {
    CAPTURE(kind.kind, kind.numbers, kind.out);
    CHECK(kind.out >= kind.vectors);
  }
}

}  // namespace verify_tolerances_test
