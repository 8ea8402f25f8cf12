// The oracle vectors of tests/vectors/references.json.
#pragma once
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "scene/math/types.h"

namespace airlight::path_tracer::test {

// By reference, so that a loop over a part of it is a loop over something that lives.
inline const nlohmann::json& vector_of(const std::string& id) {
  std::ifstream in(std::string(AIRLIGHT_SOURCE_DIR) + "/tests/vectors/references.json");
  static const nlohmann::json file = nlohmann::json::parse(in);
  for (const auto& v : file.at("vectors"))
    if (v.at("id") == id) return v;
  throw std::runtime_error("no vector " + id);
}

inline Vec3 vec(const nlohmann::json& j) { return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()}; }

}  // namespace airlight::path_tracer::test
