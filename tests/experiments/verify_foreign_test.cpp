// Oracle vectors that are not ours: other ids, other values that follow from ours by a law, and others made by scripts of their own.
#include <algorithm>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "experiments/application/json.h"
#include "experiments/verify/check.h"
#include "experiments/verify/verify.h"
#include "scene/base/error.h"
#include "scene/math/types.h"
#include "tests/temporary_folder.h"

namespace verify_foreign_test {

using namespace airlight;
using experiments::VerifyProfile;
using nlohmann::json;

namespace {

const std::string vectors = AIRLIGHT_SOURCE_DIR "/tests/vectors/";

// Reads a number as the files store it: a JSON number, or a decimal in quotes.
double number(const json& value) {
  if (!value.is_string()) return value.get<double>();
  const std::string& text = value.get_ref<const std::string&>();
  double result = 0;
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result;
}
void scale(json& value, double by) {
  if (value.is_array())
    for (json& one : value) scale(one, by);
  else
    value = by * number(value);
}

struct Result {
  int code = 0, numbers = 0, out = 0;
  std::string text;
};
Result verified(const json& file, const std::string& kind = "") {
  const TemporaryFolder folder;
  folder.write("foreign.json", file.dump());
  std::ostringstream out;
  std::vector<experiments::VerifyKind> kinds;
  Result result;
  result.code = experiments::verify({folder.file("foreign.json")}, kind, VerifyProfile::quick, out, &kinds);
  for (const auto& k : kinds) result.numbers += k.numbers, result.out += k.out;
  result.text = out.str();
  return result;
}

// The vectors of a file that `wanted` takes, each under another id.
json renamed(const std::string& name, const std::function<bool(const json&)>& wanted) {
  json file = experiments::read_json(vectors + name + ".json");
  json kept = json::array();
  for (json& v : file["vectors"])
    if (wanted(v)) {
      v["id"] = "foreign " + std::to_string(kept.size());
      kept.push_back(v);
    }
  if (file.contains("count")) file["count"] = kept.size();
  file["vectors"] = kept;
  return file;
}
json of_kind(const std::string& name, const std::string& kind) {
  return renamed(name, [&](const json& v) { return v["kind"] == kind; });
}

}  // namespace

TEST_CASE("vectors of every kind are known by what they say, not by their ids", "[verify]") {
  // Everything is read before anything is computed; computed is what takes no time.
  for (const auto& [name, kind] : {std::pair("references", "phase_function"),
                                   {"fogshop", "F"},
                                   {"shadow_planes", "spot"},
                                   {"wavelet_fog", "family"},
                                   {"legendre_fluids", "truncation"},
                                   {"compensated_ray_marching", "sh_exponential"}}) {
    const Result result = verified(renamed(name, [](const json&) { return true; }), kind);
    CAPTURE(name, kind, result.text);
    CHECK(result.code == 0);
    CHECK(result.numbers > 0);
  }
  // Flows, of which there are many in one kind: those that take no time.
  const auto quick = [](const json& v) {
    const std::string& id = v["id"];
    return id == "fluid-diffusion" || id == "fluid-poisson" || id == "fluid-confinement" || id == "fluid-amplification";
  };
  const json flows = renamed("references", [&](const json& v) { return v["kind"] == "fluid" && quick(v); });
  REQUIRE(flows["vectors"].size() == 4);
  const Result result = verified(flows);
  CAPTURE(result.text);
  CHECK(result.code == 0);
}

TEST_CASE("values that follow from our vectors by a law are met, too", "[verify]") {
  struct Law {
    const char *file, *kind;
    std::function<void(json&)> change;
  };
  const Law laws[] = {
      {"fogshop", "line_integral", [](json& v) { scale(v["in"]["c"], 2.5), scale(v["value"], 2.5); }},
      {"shadow_planes", "airlight",
       [](json& v) {
         scale(v["input"]["intensity"], 3), scale(v["expect"]["L"], 3);
         if (v["expect"].contains("log10_L") && std::isfinite(number(v["expect"]["log10_L"])))
           v["expect"]["log10_L"] = number(v["expect"]["log10_L"]) + std::log10(3.0);
       }},
      // Light that grows along a ray: depths below 0.
      {"wavelet_fog", "optical_depth",
       [](json& v) {
         const double depth = -number(v["expected"]["optical_depth"]);
         if (depth < -100) return;  // exp(-depth) is beyond all doubles
         scale(v["sigma"], -1);
         v["expected"]["optical_depth"] = depth;
         v["expected"]["transmittance"] = std::exp(-depth);
         v["expected"]["opacity"] = -std::expm1(-depth);
       }},
      // Viscosity above 1: u = exp(-2 pi^2 nu t) u(0).
      {"legendre_fluids", "taylor-green",
       [](json& v) {
         const double before = number(v["nu"]) * number(v["t"]), nu = 1.5, t = 0.05;
         const double factor = std::exp(-2 * pi * pi * (nu * t - before));
         v["nu"] = nu, v["t"] = t;
         scale(v["energy"], factor * factor);
         for (json& p : v["points"]) scale(p["u"], factor);
       }},
      {"references", "fluid",
       [](json& v) {
         if (v["input"].value("rows", "") != "nu,dt,N,k,factor") return;
         json rows = json::array();
         for (const auto& [nu, dt, n, k] : {std::tuple(0.3, 0.7, 20, 3), {2.5, 11.0, 48, 7}, {1e-4, 0.2, 12, 1}})
           rows.push_back({nu, dt, n, k, 1 / (1 + nu * dt * 4.0 * n * n * std::pow(std::sin(pi * k / n), 2))});
         v["expected"]["rows"] = rows;
       }},
      // Backwards: band l changes its sign l times.
      {"compensated_ray_marching", "hg_zh",
       [](json& v) {
         scale(v["input"]["g"], -1);
         for (std::size_t l = 1; l < v["expected"].size(); l += 2) scale(v["expected"][l], -1);
       }},
      {"compensated_ray_marching", "sh_basis",
       [](json& v) {
         scale(v["input"]["direction"], -1);
         for (std::size_t i = 0; i < v["expected"].size(); ++i)
           if (int(std::sqrt(double(i))) % 2) scale(v["expected"][i], -1);
       }},
      {"compensated_ray_marching", "sh_triple_product",
       [](json& v) {
         std::swap(v["input"]["f"], v["input"]["g"]);
         scale(v["input"]["f"], 2), scale(v["expected"], 2);
       }},
  };
  for (const Law& law : laws) {
    json file = of_kind(law.file, law.kind);
    if (law.kind == std::string("fluid")) {
      file = renamed(law.file, [](const json& v) { return v["id"] == "fluid-diffusion"; });
      REQUIRE(file["vectors"].size() == 1);
    }
    for (json& v : file["vectors"]) law.change(v);
    const Result result = verified(file);
    CAPTURE(law.file, law.kind, result.text);
    CHECK(result.code == 0);
    CHECK(result.numbers > 0);
  }
}

namespace {

// Kinds that are measured by Monte Carlo, or take seconds for another reason.
bool is_slow(const std::string& kind) {
  return kind.starts_with("slab_") || kind.starts_with("sphere_") || kind == "halfspace" || kind == "identity" ||
         kind == "single_scattering_environment" || kind == "multiple_scattering_monte_carlo";
}

// By a renderer; tests/second_opinion has solvers for the others.
bool is_computed(const std::string& file, const json& vector) {
  using namespace experiments::verification;
  const std::string kind = vector["kind"];
  return bool(find_reader(file, kind)(Value(vector, kind)).job);
}

// Ten tolerances on every number that the vector names.
json made_wrong(json v) {
  const json wrong = v["wrong"];
  for (const auto& [pointer, by] : wrong.items()) {
    json& at = v[json::json_pointer(pointer)];
    if (by.is_string())
      at = by;
    else if (at.is_number_integer() && by.is_number_integer())
      at = at.get<int>() + by.get<int>();
    else
      at = number(at) + by.get<double>();
  }
  return v;
}

void check_others(bool slow) {
  for (const char* name :
       {"references", "fogshop", "shadow_planes", "wavelet_fog", "legendre_fluids", "compensated_ray_marching"}) {
    json file = experiments::read_json(vectors + "other/" + name + ".json");
    std::set<std::string> kinds;
    const json all = file["vectors"];
    for (const json& v : all) {
      kinds.insert(v["kind"]);
      if (is_slow(v["kind"]) != slow || !is_computed(name, v)) continue;
      file["vectors"] = json::array({v});
      const Result right = verified(file);
      file["vectors"] = json::array({made_wrong(v)});
      const Result wrong = verified(file);
      CAPTURE(name, v["id"].get<std::string>(), right.text, wrong.text);
      CHECK(right.code == 0);
      CHECK(right.numbers > 0);
      CHECK(wrong.code == 1);
      CHECK(v["wrong"].size() > 0);
      CHECK(wrong.out >= int(v["wrong"].size()));
    }
    const std::vector<std::string> known = experiments::verification::known_kinds(name);
    CHECK(kinds == std::set<std::string>(known.begin(), known.end()));
  }
}

}  // namespace

TEST_CASE("vectors of every kind that others made are met, and wrong ones are not", "[verify]") { check_others(false); }
TEST_CASE("measured vectors that others made are met, and wrong ones are not", "[verify][thorough]") {
  check_others(true);
}

TEST_CASE("cosines that are no numbers are refused with file and vector", "[verify]") {
  for (const char* name : {"0.5x", "x", "", "1e999", "nan", "0", "1.5"}) {
    json file = of_kind("references", "slab_exit_radiance");
    file["vectors"][0]["expected"]["L_reflected"] = {{name, 0.1}};
    const TemporaryFolder folder;
    folder.write("foreign.json", file.dump());
    std::ostringstream out;
    CAPTURE(name);
    CHECK_THROWS_WITH(experiments::verify({folder.file("foreign.json")}, "", VerifyProfile::quick, out),
                      Catch::Contains("foreign.json: vector 0 'foreign 0'") && Catch::Contains("as its name"));
  }
}

// Each was read beyond its end, or not refused by name.
TEST_CASE("vectors whose sizes do not agree are refused with file and vector", "[verify]") {
  struct Fault {
    const char *file, *id, *pointer;
    json value;
    const char* expected;
  };
  const Fault faults[] = {
      {"wavelet_fog", "mr-cdf22-1.0", "/height", -6, "an integer from 1 to 4096"},
      {"wavelet_fog", "od-1x1", "/height", 50, "width times height numbers"},
      {"wavelet_fog", "ana2d-cdf22", "/expected/dd/width", 9, "width times height numbers"},
      {"wavelet_fog", "fam-haar", "/offsets", {0, 0, 0}, "four offsets"},
      {"compensated_ray_marching", "conv_hg", "/input/zonal", {1, 2, 3, 4, 5, 6, 7}, "a coefficient for every band"},
      {"references", "fluid-confinement", "/expected/f_theta", {0.1}, "a number for every r"},
      {"references", "fluid-poisson", "/input/n", {2, 2, 2}, "three digits, a cell, as its name"},
      {"references", "fluid-diffusion", "/expected/rows/0/2", 1e9, "a whole number from 1 to 4096"},
      {"references", "bound-gauss", "/expected/sampled", {0.5}, "two numbers"},
      {"references", "fluid-cavity-lid", "/expected", {{"a", {0.5}}}, "a number from 0.001 to 1000000"},
      {"legendre_fluids", "dg-3d-n3", "/E_d_coeffs", json::array({json::array({json::array({1.0})})}),
       "3 coefficients along each axis"},
  };
  for (const Fault& fault : faults) {
    json file = experiments::read_json(vectors + fault.file + ".json");
    const json all = file["vectors"];
    const auto found = std::find_if(all.begin(), all.end(), [&](const json& v) { return v["id"] == fault.id; });
    REQUIRE(found != all.end());
    file["vectors"] = json::array({*found});
    if (file.contains("count")) file["count"] = 1;
    file["vectors"][0][json::json_pointer(fault.pointer)] = fault.value;
    CAPTURE(fault.id, fault.pointer);
    CHECK_THROWS_WITH(verified(file), Catch::Contains("foreign.json: vector ") && Catch::Contains(fault.id) &&
                                          Catch::Contains(fault.expected));
  }
}

}  // namespace verify_foreign_test
