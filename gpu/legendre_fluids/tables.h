// The matrices of a ConfinedSpace in one list of single precision, as gpu/legendre_fluids/fields.glsl reads them.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "gpu/legendre_fluids/interface.h"
#include "methods/legendre_fluids/confined_space.h"

namespace airlight::gpu::legendre_fluids {

constexpr int most_coefficients = 16;  // of an axis

using airlight::legendre_fluids::Array;
using airlight::legendre_fluids::ConfinedSpace;

class Tables {
 public:
  // Tables for a space with n > 1. Filters damp coefficient k of an axis by exp(-rate (k / (n-1))^filter_order t).
  Tables(const ConfinedSpace&, double filter_order);

  // A uniform block, within the 16 KiB that OpenGL promises for n up to most_coefficients.
  const std::vector<float>& values() const { return values_; }
  // The names of fields.glsl, and where everything begins, in vectors of four.
  const Definitions& definitions() const { return definitions_; }

 private:
  void begin(const std::string& name);
  void rows(const Eigen::MatrixXd&);

  std::vector<float> values_;
  Definitions definitions_;
};

// A field of the host with its entries of phi_0, and back. `component` as for ConfinedSpace, -1: a scalar.
void put_field(const ConfinedSpace&, int component, const Array&, std::vector<float>& at_end);
Array take_field(const ConfinedSpace&, int component, const float* from);

}  // namespace airlight::gpu::legendre_fluids
