// One medium with what its rays read: the map's levels, what is known of its blocks.
#pragma once
#include <optional>

#include "methods/wavelet_fog/bands.h"
#include "methods/wavelet_fog/blocks.h"
#include "methods/wavelet_fog/options.h"
#include "methods/wavelet_fog/polar_table.h"

namespace airlight::wavelet_fog {

class LeveledFog {
 public:
  // The medium is a fogmap and outlives this.
  LeveledFog(const scene::Medium&, const Options&);

  // Integral of the density from the ray's origin to `length` [m], which may be infinite; times sigma_t it is the optical
  // depth. By the variant of the settings: exact for direct and skip.
  double column(const Ray&, double length, Visits&) const;
  // The same of a ray from the eye that the table was made for.
  double column(const PolarTable&, const Ray&, double length, Visits&) const;
  // Of a perspective view, over the directions in it.
  PolarTable polar_table(const scene::View&, const scene::Execution&) const;
  const scene::Medium& medium() const { return *medium_; }

 private:
  const scene::Medium* medium_;
  const scene::Fogmap* fog_;
  Options options_;
  Levels levels_;
  std::optional<Blocks> blocks_;
  std::optional<Decomposition> wavelets_;  // of `bands`
  double enough_;                          // column at which a ray ends
};

}  // namespace airlight::wavelet_fog
