// One resolution of the fog as the paper walks it before deconstruction: in every cell that a ray crosses, all basis
// functions that reach there, phi phi or those of the three bands of wavelets. Giroud and Biri 2010, section 4.2, eq. 11.
#pragma once
#include "methods/wavelet_fog/decomposition.h"
#include "methods/wavelet_fog/levels.h"
#include "methods/wavelet_fog/path_table.h"

namespace airlight::wavelet_fog {

class BandGrid {
 public:
  // Splines alone: the map itself, an approximation, or a detail after deconstruction; cells 2^level times as large.
  BandGrid(const scene::SplineMap&, int level);
  // phi psi, psi phi and psi psi of one level of a decomposition, which leads to cells 2^level times as large.
  BandGrid(const Bands&, const Family&, int level);

  const UnitPieces& pieces() const { return pieces_; }
  // A cell in which an exponential falls by more than that many scale heights is no lookup.
  static constexpr double most_fall = 0.3;

  // Integral over t [its unit] of f h. With a table, whole cells are lookups where h has no break in them; h is taken along them as the
  // straight line through its values at two Gauss points, which it is but for an exponential. A table without moments is for h = 1.
  double integral(const scene::HeightProfile&, const scene::MapLine&, Interval t, const PathTable*, Visits&) const;

 private:
  struct Band {
    bool wavelet_u, wavelet_v;
    Coefficients coefficients;
    int reach[2];  // functions that reach a cell along each axis
    int first[2];  // function i begins at cell i + first
  };
  void add_band(const Coefficients&, bool wavelet_u, bool wavelet_v);
  void lay_cells();
  double coefficient(const Band&, int i, int j) const;
  double in_cell(int i, int j, double u, double v) const;
  double looked_up(int i, int j, double entry, double exit, const double (&factor)[2], const PathTable&) const;
  double walked(const scene::HeightProfile&, const scene::MapLine&, int i, int j, Interval t) const;

  UnitPieces pieces_;
  int level_;
  std::vector<Band> bands_;
  scene::SplineMap cells_;  // of degree 0: where there are any
  long per_cell_ = 0;       // coefficients
};

}  // namespace airlight::wavelet_fog
