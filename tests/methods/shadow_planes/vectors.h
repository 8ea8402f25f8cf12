// The oracle vectors of tests/vectors/shadow_planes.json.
#pragma once
#include "methods/shadow_planes/phase_form.h"
#include "scene/math/types.h"
#include "tests/oracle_vectors.h"

namespace shadow_planes_test {

using airlight::test::json;
using airlight::test::number;
using airlight::test::vec;

inline std::vector<json> vectors_of(const std::string& kind) {
  return airlight::test::vectors_of("shadow_planes", kind);
}

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
