// Light that the medium scatters onto a surface, reflected: Zhou et al. 2007, section 4, Eqs. 18 to 25, for point
// lights.
//
// A point light at optical depth T reaches a surface unscattered, I/d^2 e^-T from one direction, and spread around it:
// I/d^2 T e^-T NPSF. The spread light is kept in zonal harmonics around the light's direction; their inner product with
// the reflectance is the integral of the reflectance times a polynomial (Eq. 20 without the visibility of occluders).
// Taking the medium between light and surface as homogeneous is the paper's approximation; it is exact where it is so
// everywhere. One more form is Sun et al.'s without harmonics (sun_reflection.h).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "methods/fogshop/environment_psf.h"
#include "methods/fogshop/sun_reflection.h"
#include "methods/fogshop/surface_pass.h"

namespace airlight::fogshop {

class ScatteredReflection {
 public:
  // `follows_depth`: g_l of the depth at hand, from a table (improved); else those of T = 1 for every depth, as
  // printed. `order` bands, 1 to 12; the paper uses 4 to 6.
  ScatteredReflection(int order, bool follows_depth);

  // Without harmonics instead: by these tables. The bands are then unused.
  void use(SunReflection sun) { sun_ = std::move(sun); }
  const std::optional<SunReflection>& sun() const { return sun_; }

  // L_p of the scattered light alone [W/m^2/sr] towards `to_view`, the medium's albedo included. `reflectance` is B_pv
  // in the world's axes, times the visibility if light is shadowed; unused without harmonics.
  Rgb operator()(const scene::Scene&, const Model&, const SurfacePoint&, const Vec3& to_view,
                 const std::vector<Rgb>& reflectance, Crossings&, double& evaluations,
                 std::vector<LightDepth>* found = nullptr) const;

  const PsfBands& bands() const { return bands_; }

 private:
  PsfBands bands_;
  std::optional<SunReflection> sun_;
};

// The kind of reflection that the settings ask for.
std::unique_ptr<ScatteredReflection> make_reflection(const scene::Scene&, const Options&);

// Why these surfaces cannot be lit so; empty if they can.
std::vector<std::string> objections_to_surfaces(const scene::Scene&, const Options&);

}  // namespace airlight::fogshop
