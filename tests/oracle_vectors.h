// The oracle vectors of tests/vectors, for implementations that `airlight verify` does not run: those that it does are
// checked by its own test.
#pragma once
#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/application/json_value.h"
#include "scene/math/types.h"

namespace airlight::test {

using nlohmann::json;

// All of a file, "references", "fogshop" or "shadow_planes".
inline const json& vectors_in(const std::string& file) {
  static std::map<std::string, json> files;
  json& all = files[file];
  if (all.is_null()) {
    std::ifstream in(AIRLIGHT_SOURCE_DIR "/tests/vectors/" + file + ".json");
    all = json::parse(in).at("vectors");
  }
  return all;
}

inline std::vector<json> vectors_of(const std::string& file, const std::string& kind) {
  std::vector<json> found;
  for (const json& v : vectors_in(file))
    if (v.at("kind") == kind) found.push_back(v);
  return found;
}

// By reference, so that a loop over a part of it is a loop over something that lives.
inline const json& vector_of(const std::string& id) {
  for (const json& v : vectors_in("references"))
    if (v.at("id") == id) return v;
  throw std::runtime_error("no vector " + id);
}

// Some are infinite, or below the least double: then 0.
inline double number(const json& v) {
  return v.is_string() ? std::strtod(v.get<std::string>().c_str(), nullptr) : v.get<double>();
}

inline std::vector<double> numbers(const json& list) {
  std::vector<double> values;
  for (const json& v : list) values.push_back(number(v));
  return values;
}

// Lists in lists, up to three deep: their lengths, and their numbers, the last index fastest.
struct Tensor {
  std::array<int, 3> shape{1, 1, 1};
  std::vector<double> values;
  explicit Tensor(const json& v) { add(v, 0); }
  void add(const json& v, std::size_t axis) {
    if (!v.is_array()) return values.push_back(number(v));
    shape.at(axis) = int(v.size());
    for (const json& part : v) add(part, axis + 1);
  }
  Eigen::VectorXd array() const {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
  }
};

inline Vec3 vec(const json& v) { return {number(v[0]), number(v[1]), number(v[2])}; }

}  // namespace airlight::test
