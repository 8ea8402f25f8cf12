// The grid of cells on which a flow of coefficients is shown, and its sums.
#pragma once
#include <vector>

#include "methods/legendre_fluids/fluid.h"
#include "methods/legendre_fluids/reference_box.h"
#include "scene/flow/flow.h"

namespace airlight::legendre_fluids {

struct Cells {
  Cells(const ReferenceBox&, const Point3& low, int along_longest);
  ReferenceBox box;
  Point3 low;                                       // corner of the first cell [m]
  double size;                                      // [m]
  Eigen::Vector3i count = Eigen::Vector3i::Ones();  // per axis; 1 of an axis that is absent

  // Centres along each axis, along one its faces, in the reference box.
  Components positions(int faces = -1) const;
  // A scalar at the centres, x fastest; nothing for no coefficients.
  std::vector<float> values(const ConfinedSpace&, const Array& r) const;
  // Not below 0: the polynomial itself, in two dimensions one cell deep; a grid above LegendreBox::most coefficients along an axis.
  scene::DensityField medium(const ConfinedSpace&, const Array& density) const;
  scene::Frame frame(const Fluid&) const;  // without densities

 private:
  scene::GridPointer grid(const ConfinedSpace&, const Array& density) const;
};

// Energy, enstrophy, mass and its centre are integrals of polynomials, exact; extremes are those at the cells' centres, divergence at the
// Gauss points. `cfl` is left 0.
scene::Totals totals_of(const Fluid&, const Array& density, const Cells&);

}  // namespace airlight::legendre_fluids
