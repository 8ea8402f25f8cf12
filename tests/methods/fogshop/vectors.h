// The oracle vectors of tests/vectors/fogshop.json, and a comparison in relative error.
#pragma once
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/math/types.h"
#include "scene/media/gaussian_sum.h"

namespace fogshop_test {

using nlohmann::json;

inline std::vector<json> vectors_of(const std::string& kind) {
  std::ifstream file(std::string(AIRLIGHT_SOURCE_DIR) + "/tests/vectors/fogshop.json");
  const json all = json::parse(file);
  std::vector<json> found;
  for (const json& v : all.at("vectors"))
    if (v.at("kind") == kind) found.push_back(v);
  return found;
}

inline double number(const json& v) { return v.is_string() ? std::stod(v.get<std::string>()) : v.get<double>(); }

inline airlight::Vec3 vec(const json& v) { return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()}; }

// The medium of a vector's input; a = 1/width, c = amplitude in 1/m.
inline airlight::scene::GaussianSum fog_of(const json& in) {
  airlight::scene::GaussianSum fog;
  for (const json& g : in.at("gaussians"))
    fog.gaussians.push_back({vec(g.at("b")), 1 / g.at("a").get<double>(), g.at("c").get<double>()});
  fog.constant = in.at("beta0");
  return fog;
}

// |got - expected| relative to expected, with 1e-300 for nothing.
inline double relative_error(double got, double expected) {
  return std::abs(got - expected) / std::max(std::abs(expected), 1e-300);
}

}  // namespace fogshop_test
