// One medium with what its rays read: the map's levels, what is known of its blocks.
#pragma once
#include <optional>

#include "methods/wavelet_fog/band_grid.h"
#include "methods/wavelet_fog/blocks.h"
#include "methods/wavelet_fog/options.h"
#include "methods/wavelet_fog/polar_table.h"

namespace airlight::wavelet_fog {

constexpr int empty_blocks = 3;   // blocks of 2, 4, 8 cells that skip looks at
constexpr double upright = 1e-3;  // cells over the ground below which polar's table has nothing to say

// Integral of the density at which a ray ends [m]; infinite where it never does.
double enough_column(const scene::Medium&, const Options&);

class LeveledFog {
 public:
  // The medium is a fogmap and outlives this.
  LeveledFog(const scene::Medium&, const Options&);

  // Integral of the density from the ray's origin to `length` [m], which may be infinite; times sigma_t it is the optical
  // depth. By the variant of the settings: exact for direct and skip.
  double column(const Ray&, double length, Visits&) const;
  // The column of a ray from the eye, looked up in the table made for this eye.
  double column(const PolarTable&, const Ray&, double length, Visits&) const;
  // The table for a perspective view, over the directions in the view.
  PolarTable polar_table(const scene::View&, const scene::Execution&) const;
  const scene::Medium& medium() const { return *medium_; }

  // Switches to another fogmap medium while the previous one still exists. If the map is unchanged its levels are kept,
  // even if the fog has moved, turned or grown.
  void become(const scene::Medium&);

 private:
  bool needs_moments() const;
  void lay_bands();
  double summed_bands(const scene::HeightProfile&, const scene::MapLine&, Interval inside, double length,
                      Visits&) const;

  const scene::Medium* medium_;
  const scene::Fogmap* fog_;
  Options options_;
  Levels levels_;
  std::optional<Blocks> blocks_;
  std::vector<BandGrid> bands_;  // of pre, and of a table: as they are summed, the coarsest first
  std::optional<PathTable> table_;
  double enough_;  // column at which a ray ends
};

}  // namespace airlight::wavelet_fog
