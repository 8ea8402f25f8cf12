// The oracle vectors of tests/vectors/shadow_planes.json.
#pragma once
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "methods/shadow_planes/phase_form.h"
#include "scene/math/types.h"

namespace shadow_planes_test {

using nlohmann::json;

inline std::vector<json> vectors_of(const std::string& kind) {
  std::ifstream file(std::string(AIRLIGHT_SOURCE_DIR) + "/tests/vectors/shadow_planes.json");
  const json all = json::parse(file);
  std::vector<json> found;
  for (const json& v : all.at("vectors"))
    if (v.at("kind") == kind) found.push_back(v);
  return found;
}

// Some are below the least double: then 0.
inline double number(const json& v) {
  if (!v.is_string()) return v.get<double>();
  return std::strtod(v.get<std::string>().c_str(), nullptr);
}

inline airlight::Vec3 vec(const json& v) { return {number(v[0]), number(v[1]), number(v[2])}; }

inline airlight::scene::PhaseFunction phase_function_of(const json& in) {
  using namespace airlight::scene;
  const std::string name = in.at("phase");
  return name == "rayleigh" ? PhaseFunction(Rayleigh{})
         : name == "hazy"   ? PhaseFunction(Hazy{})
         : name == "murky"  ? PhaseFunction(Murky{})
         : name == "hg"     ? PhaseFunction(HenyeyGreenstein{number(in.at("g"))})
                            : PhaseFunction(Isotropic{});
}

// Hazy and murky as printed: the vectors' normalisation.
inline airlight::shadow_planes::PhaseForm phase_of(const json& in) {
  return airlight::shadow_planes::phase_form(phase_function_of(in), true);
}

}  // namespace shadow_planes_test
