// The oracle vectors of tests/vectors/fogshop.json, and a comparison in relative error.
#pragma once
#include <cmath>

#include "scene/media/gaussian_sum.h"
#include "tests/oracle_vectors.h"

namespace fogshop_test {

using airlight::test::json;
using airlight::test::number;
using airlight::test::vec;

inline std::vector<json> vectors_of(const std::string& kind) { return airlight::test::vectors_of("fogshop", kind); }

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
