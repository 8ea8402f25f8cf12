#include "experiments/verify/verify.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "scene/base/error.h"
#include "scene/math/types.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace verify_test {

using namespace airlight;
using airlight::experiments::verify;
using airlight::experiments::VerifyProfile;

namespace {

const std::string vectors = AIRLIGHT_SOURCE_DIR "/tests/vectors/";

// A file that goes away with the test.
struct TemporaryFile {
  airlight::TemporaryFolder folder;
  std::string path = folder.file("vectors.json");
  explicit TemporaryFile(const std::string& text) { folder.write("vectors.json", text); }
};

std::string complaint(const std::string& text) {
  const TemporaryFile file(text);
  std::ostringstream out;
  const std::string says = test::message_of([&] { verify({file.path}, "", VerifyProfile::quick, out); }, file.path);
  CHECK_THAT(says, Catch::Contains(file.path));
  return says;
}

std::string fogshop_file(const std::string& entry) {
  return R"({"format": "airlight-fogshop-vectors-1", "vectors": [)" + entry + "]}";
}

const std::string good = R"({"id": "a", "kind": "F", "in": {"u": 0.0, "v": 0.7}, "value": "0.7"})";

}  // namespace

// No other test repeats these checks of an implementation.
TEST_CASE("deterministic vectors verify at their stated tolerance", "[verify][slow]") {
  for (const char* kind :
       {"single_scattering_sphere", "single_scattering_box", "single_scattering_gaussians", "optical_depth",
        "field_bounds", "phase_function", "statistics", "sampling", "random_numbers"}) {
    std::ostringstream out;
    CAPTURE(kind);
    const int code = verify({vectors + "references.json"}, kind, VerifyProfile::quick, out);
    CAPTURE(out.str());
    CHECK(code == 0);
  }
  for (const auto& [file, vectors_in_it] : {std::pair{"fogshop.json", 80},
                                            {"shadow_planes.json", 66},
                                            {"wavelet_fog.json", 76},
                                            {"legendre_fluids.json", 39},
                                            {"compensated_ray_marching.json", 96}}) {
    std::ostringstream out;
    std::vector<experiments::VerifyKind> kinds;
    CHECK(verify({vectors + file}, "", VerifyProfile::quick, out, &kinds) == 0);
    CAPTURE(out.str());
    int count = 0, without_renderer = 0;
    for (const auto& kind : kinds) {
      count += int(kind.vectors);
      without_renderer += kind.not_yet;
    }
    CHECK(count + without_renderer == vectors_in_it);
    CHECK(without_renderer == (file == std::string("compensated_ray_marching.json") ? 22 : 0));
  }
}

// Each took minutes to for ever: depths and albedos that lead to endless walks, tolerances that nothing meets.
TEST_CASE("vectors that would take for ever are refused in one line", "[verify]") {
  const auto file = [](const std::string& kind, const std::string& id, const std::string& fields) {
    return R"({"part": "references", "vectors": [{"kind": ")" + kind + R"(", "id": ")" + id + R"(", )" + fields +
           R"(, "accuracy": {"abs": 1e-9, "rel": 1e-9}}]})";
  };
  const auto collisions = Catch::Contains("collisions, expected at most 1e+08");
  const std::string sphere = R"("expected": {"J_centre": 1, "L": {"0.5": 1}, "orders_b0.5": [1, 1]})";
  CHECK_THAT(complaint(file("sphere_environment_all_orders", "x",
                            R"("input": {"optical_radius": 1e4, "albedo": 1}, )" + sphere)),
             collisions);
  CHECK_THAT(complaint(file("sphere_central_point", "x", R"("input": {"optical_radius": 1e4, "albedo": 1},
                            "expected": {"L1_L2_Lall": {"0.5": [1, 1, 1]}})")),
             collisions);
  CHECK_THAT(complaint(file("halfspace", "x", R"("input": {}, "expected":
                            {"albedo_mu1": {}, "albedo_mu0.5": {}, "H": {"0.9999999999": {"0.5": 1}}})")),
             collisions);
  CHECK_THAT(complaint(file("halfspace", "x", R"("input": {}, "expected":
                            {"albedo_mu1": {}, "albedo_mu0.5": {}, "H": {"1e300": {"0.5": 1}}})")),
             Catch::Contains("expected a number from 0 to 1"));
  CHECK_THAT(complaint(file("slab_orders", "x", R"("input": {"albedo": 1, "tau": 1e4},
                            "expected": {"R_order": [1], "T_order": [1]})")),
             collisions);
  const std::string columns = R"("input": {"columns": ["phase", "g", "albedo", "tau", "R_mu1", "T_mu1", "R_mu0.5",
                                 "T_mu0.5", "R_mu0.1", "T_mu0.1", "R_diffuse", "T_diffuse"]}, )";
  CHECK_THAT(complaint(file("slab_table", "x", columns + R"("expected": {"rows":
                            [["iso", 0, 1, 1e300, 1, 1, 1, 1, 1, 1, 1, 1]]})")),
             Catch::Contains("expected a number from 0 to 10000"));
  CHECK_THAT(complaint(file("single_scattering_environment", "x", R"("expected": {"L1": 1}, "input":
                            {"kind": "sphere", "sigma_t": 1e4, "albedo": 1, "phase": {"name": "isotropic"},
                             "o": [0.5, 0, -3], "d": [0, 0, 1]})")),
             collisions);
  const std::string light = R"("light": "environment L=1", "o": [0.5, 0, -3], "d": [0, 0, 1])";
  const std::string expected = R"("expected": {"all": [1, 1], "mean_collisions_analog": 1, "histories": 1000}, )";
  CHECK_THAT(complaint(file("multiple_scattering_monte_carlo", "x",
                            expected + R"("input": {"shape": "sphere",
                            "R": 1e4, "sigma_t": 1, "albedo": 1, "g": 0, )" +
                                light + "}")),
             collisions);
  CHECK_THAT(complaint(file("multiple_scattering_monte_carlo", "x",
                            expected + R"("input": {"shape": "sphere",
                            "R": 1, "sigma_t": 1, "albedo": 1, "g": 1, )" +
                                light + "}")),
             Catch::Contains("expected -1 < g < 1"));
  CHECK_THAT(
      complaint(file("identity", "furnace-collisions", R"("input": {"sphere_optical_radius": 1e4},
                            "expected": {"mean_collisions": 1, "slab_per_unit_tau": 1, "cube_per_unit_optical_edge": 1})")),
      Catch::Contains("vector 'furnace-collisions': 262144 paths") && Catch::Contains("collisions, expected at most"));
  // The quadrature: many Gaussians, lights and rays; and a tolerance that it cannot meet.
  const auto gaussians = [&](int count, const std::string& accuracy) {
    std::string text = R"({"part": "references", "vectors": [{"kind": "single_scattering_gaussians", "id": "x",
        "input": {"b0": 0, "albedo": 1, "phase": {"name": "isotropic"}, "eye": [0, 0, 0], "gaussians": [)";
    for (int i = 0; i < count; ++i) text += std::string(i ? "," : "") + "[1, 1, [0, 0, 5]]";
    text += R"(], "lights": [)";
    for (int i = 0; i < count; ++i)
      text += std::string(i ? "," : "") + R"({"type": "point", "pos": [0, 2, 5], "I": 1})";
    text += R"(]}, "expected": {"rays": [)";
    for (int i = 0; i < count; ++i) text += std::string(i ? "," : "") + R"({"p": [0, 0, 9], "L1": 1, "T": 1})";
    return text + R"(]}, "accuracy": {"rel": )" + accuracy + "}}]}";
  };
  CHECK_THAT(complaint(gaussians(100, "1e-9")), Catch::Contains("evaluations of terms of densities, not"));
  CHECK_THAT(complaint(gaussians(1, "1e-300")), Catch::Contains("expected a number from 1e-13 to 1"));
}

// Each was an unexpected failure of the library behind it: found by the fuzzer.
TEST_CASE("statistics of what has none are refused", "[verify]") {
  const auto file = [](const std::string& fields) {
    return R"({"part": "references", "vectors": [{"kind": "statistics", "accuracy": {"rel": 1e-9}, )" + fields + "}]}";
  };
  for (const char* alpha : {"10", "0", "-1"})
    CHECK_THAT(complaint(file(R"("id": "stat-sidak", "input": {"rows": ""}, "expected": {"rows": [[300, )" +
                              std::string(alpha) + ", 5.9]]}")),
               Catch::Contains("expected a number from 1e-300 to 0.999"));
  const std::string z =
      R"(, "expected": {"chi2": 1, "p_chi2": 1, "sidak_1e3": 1, "bonf_1e3": 1, "p_max_sidak": 1}, "id": "stat-z")";
  CHECK_THAT(complaint(file(R"("input": {"z": []})" + z)), Catch::Contains("expected a value at least"));
  CHECK_THAT(complaint(file(R"("input": {"z": [1, 1e300]})" + z)),
             Catch::Contains("expected a number from -1000000000"));
}

TEST_CASE("a number out of tolerance is found", "[verify]") {
  const TemporaryFile right(fogshop_file(good));
  const TemporaryFile wrong(
      fogshop_file(R"({"id": "a", "kind": "F", "in": {"u": 0.0, "v": 0.7}, "value": "0.70000000001"})"));
  std::ostringstream out;
  CHECK(verify({right.path}, "", VerifyProfile::quick, out) == 0);
  CHECK(verify({right.path, wrong.path}, "", VerifyProfile::quick, out) == 1);
  CHECK(out.str().find("OUT: a F") != std::string::npos);
}

TEST_CASE("vectors that no renderer computes are listed and counted, and compared with nothing they fail", "[verify]") {
  std::ostringstream out;
  CHECK(verify({vectors + "compensated_ray_marching.json"}, "halfspace_albedo_isotropic", VerifyProfile::quick, out) ==
        1);
  CHECK_THAT(out.str(), Catch::Contains("3 vectors: no renderer computes this") &&
                            Catch::Contains("0 vectors, 0 numbers compared: 0 ok, 0 out") &&
                            Catch::Contains("3 vectors that no renderer computes") &&
                            Catch::Contains("FAILED: no number was compared"));
}

TEST_CASE("a file without vectors is no success", "[verify]") {
  const TemporaryFile empty(fogshop_file("")), right(fogshop_file(good));
  std::ostringstream out;
  CHECK(verify({empty.path}, "", VerifyProfile::quick, out) == 1);
  CHECK_THAT(out.str(), Catch::Contains("FAILED: no number was compared"));
  // Beside one with numbers: each has a line of its own.
  std::ostringstream both;
  CHECK(verify({empty.path, right.path}, "", VerifyProfile::quick, both) == 0);
  CHECK_THAT(both.str(), Catch::Contains(empty.path + ": 0 vectors, 0 numbers") &&
                             Catch::Contains(right.path + ": 1 vectors, 1 numbers compared: 1 ok, 0 out") &&
                             Catch::Contains("all files: 1 vectors, 1 numbers compared: 1 ok, 0 out"));
}

TEST_CASE("figures per file and kind", "[verify]") {
  const TemporaryFile two(fogshop_file(good +
                                       R"(,{"id": "b", "kind": "F", "in": {"u": 0.0, "v": 0.7}, "value": "0.6"},)" +
                                       R"({"id": "c", "kind": "avg_depth", "in": {"u": 1.0}, "value": "5"})"));
  std::ostringstream out;
  std::vector<airlight::experiments::VerifyKind> kinds;
  CHECK(verify({two.path}, "F", VerifyProfile::quick, out, &kinds) == 1);
  REQUIRE(kinds.size() == 1);
  CHECK(kinds[0].kind == "F");
  CHECK(kinds[0].vectors == 2);
  CHECK(kinds[0].numbers == 2);
  CHECK(kinds[0].out == 1);
  CHECK(kinds[0].worst == "b F");
  // 0.7 where 0.6 +- 0.6e-12 is expected.
  CHECK(kinds[0].worst_relative_error == Approx(1.0 / 6).epsilon(1e-9));
  CHECK(kinds[0].worst_share == Approx(1 / 6e-12).epsilon(1e-6));
}

TEST_CASE("malformed vectors are refused with file and entry", "[verify]") {
  using Catch::Contains;
  CHECK_THAT(complaint(""), Contains("an empty file"));
  CHECK_THAT(complaint(fogshop_file(good).substr(0, 70)), Contains("not JSON"));
  CHECK_THAT(complaint("[1, 2]"), Contains("array"));
  CHECK_THAT(complaint(R"({"vectors": []})"), Contains("'format'"));
  CHECK_THAT(complaint(R"({"format": "airlight-fogshop-vectors-1"})"), Contains("missing field 'vectors'"));
  CHECK_THAT(complaint(fogshop_file(R"({"kind": "F"})")), Contains("missing field 'id'"));
  CHECK_THAT(complaint(fogshop_file(R"({"id": "a"})")), Contains("'a'") && Contains("missing field 'kind'"));
  CHECK_THAT(complaint(fogshop_file(R"({"id": "a", "kind": "G"})")),
             Contains("unknown kind 'G'") && Contains("nearest: F"));
  CHECK_THAT(
      complaint(fogshop_file(R"({"id": "a", "kind": "G"},{"id": "b", "kind": "H"},)" +
                             std::string(R"({"id": "c", "kind": "F", "in": {"u": 0.0, "v": 0.7}, "value": 1})"))),
      Contains("'a'") && Contains("2 of 3 vectors are of unknown kinds"));
  CHECK_THAT(complaint(fogshop_file(good + "," + good)), Contains("an id that no other vector has"));
  CHECK_THAT(complaint(fogshop_file(R"({"id": "a", "kind": "F", "in": {"u": 0.0}, "value": "0.7"})")),
             Contains("'a'.in: missing field 'v'"));
  CHECK_THAT(complaint(fogshop_file(R"({"id": "a", "kind": "F", "in": {"u": 0, "v": [1]}, "value": "0.7"})")),
             Contains("in.v: found array [1], expected a finite number"));
  for (const char* value : {R"("nan")", R"("0.7x")", R"("")", "null", R"("inf")", R"("1e999")"})
    CHECK_THAT(complaint(fogshop_file(R"({"id": "a", "kind": "F", "in": {"u": 0, "v": 1}, "value": )" +
                                      std::string(value) + "}")),
               Contains("'a'.value") && Contains("expected a finite number"));
  CHECK_THAT(complaint(fogshop_file(R"({"id": "a", "kind": "F", "in": {"u": 0, "v": NaN}, "value": "1"})")),
             Contains("not JSON"));
  CHECK_THAT(complaint(fogshop_file(R"({"id": "a", "kind": "F", "kind": "F"})")),
             Contains("key 'kind' is there twice"));
  // Numbers that would run for ever, or reach beyond a list.
  CHECK_THAT(complaint(fogshop_file(R"({"id": "a", "kind": "npsf_coef", "in": {"l": 1e9, "T": 4}, "value": "1"})")),
             Contains("found number 1000000000.0, expected an integer from 0 to 1000"));
  // Messages print what they found by recursion: 100,000 levels end the stack.
  const std::string deep(100000, '[');
  CHECK_THAT(complaint("{\"format\": 1,\n \"vectors\": " + deep + std::string(deep.size(), ']') + "}"),
             Contains(":2:44: found lists or objects in more than 32 levels"));
  CHECK_THAT(complaint(R"({"format": "airlight-fogshop-vectors-1", "vectors": [{"id": "a]\")" + std::string(40, '[') +
                       "\"}]}"),
             Contains("missing field 'kind'"));
}

// F(0, v) = v, so what is found is 0.5 whatever is expected.
TEST_CASE("the figures of a kind are those of its worst number", "[verify]") {
  const auto entry = [](const std::string& id, const std::string& expected) {
    return R"({"id": ")" + id + R"(", "kind": "F", "in": {"u": 0.0, "v": 0.5}, "value": ")" + expected + "\"}";
  };
  std::ostringstream out;
  const auto figures = [&](const std::string& entries) {
    const TemporaryFile file(fogshop_file(entries));
    std::vector<experiments::VerifyKind> kinds;
    verify({file.path}, "", VerifyProfile::quick, out, &kinds);
    REQUIRE(kinds.size() == 1);
    return kinds[0];
  };
  const auto relative = [&](const std::string& expected) { return figures(entry("a", expected)).worst_relative_error; };
  CHECK(relative("0.5") < 1e-9);
  CHECK(relative("0.4") == Approx(0.25));
  CHECK(relative("0.8") == Approx(0.375));
  CHECK(relative("-0.5") == Approx(2));
  CHECK(relative("1") == Approx(0.5));
  CHECK(std::isnan(relative("0")));  // relative to nothing
  const auto three = figures(entry("a", "0.4") + "," + entry("b", "0.8") + "," + entry("c", "0.5"));
  CHECK(three.worst_relative_error == Approx(0.375));
  CHECK(three.worst.find("b") == 0);
  CHECK(figures(entry("a", "0.4") + "," + entry("b", "0")).worst_relative_error == Approx(0.25));
  CHECK(three.vectors == 3);
  CHECK(three.numbers == 3);
  CHECK(three.out == 2);
  // A kind of two files has two lines.
  const TemporaryFile first(fogshop_file(entry("a", "0.4"))), second(fogshop_file(entry("a", "0.8")));
  std::vector<experiments::VerifyKind> kinds;
  verify({first.path, second.path}, "", VerifyProfile::quick, out, &kinds);
  REQUIRE(kinds.size() == 2);
  CHECK(kinds[1].file == second.path);
  CHECK(kinds[1].numbers == 1);
}

TEST_CASE("a kind that no file has is refused", "[verify]") {
  std::ostringstream out;
  CHECK_THROWS_AS(verify({vectors + "fogshop.json"}, "airlight_scenes", VerifyProfile::quick, out), Error);
  CHECK_THROWS_AS(verify({vectors + "absent.json"}, "", VerifyProfile::quick, out), Error);
}

}  // namespace verify_test
