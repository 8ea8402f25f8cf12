// Faults of oracle vectors of the fluid of Legendre coefficients.
#include <catch2/catch.hpp>
#include <sstream>

#include "experiments/verify/verify.h"
#include "scene/base/error.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace legendre_fluid_vectors_test {

using namespace airlight;
using experiments::verify;
using experiments::VerifyProfile;

TEST_CASE("legendre fluids: vectors of other shapes are refused by name", "[legendre_fluids][verify]") {
  TemporaryFolder folder;
  const std::string good = R"({"kind": "project", "id": "x", "n": 2, "a": [[1, 2]], "b": [[1], [2]], "a_proj": [[0, 0]],
      "b_proj": [[0], [0]], "div_before": [[0, 1], [1, 4]], "energy_before": 1, "energy_after": 0})";
  const auto complaint = [&](const std::string& from, const std::string& to) {
    const std::string text = test::replaced(good, from, to);
    folder.write("vectors.json", R"({"topic": "legendre_fluids", "vectors": [)" + text + "]}");
    std::ostringstream out;
    return test::message_of([&] { verify({folder.file("vectors.json")}, "", VerifyProfile::quick, out); });
  };
  CHECK_THAT(complaint("[[1, 2]]", "[[1, 2, 3]]"), Catch::Contains("axis x"));
  CHECK_THAT(complaint("\"n\": 2", "\"n\": 99"), Catch::Contains("32"));
  CHECK_THAT(complaint("[[0, 1], [1, 4]]", "[1, 1]"), Catch::Contains("2 coefficients"));
}

}  // namespace legendre_fluid_vectors_test
