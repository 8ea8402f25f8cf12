// Light that the medium scatters onto a surface, reflected: Zhou et al. 2007, section 4, Eqs. 18 to 25, for point
// lights.
//
// A point light at optical depth T reaches a surface unscattered, I/d^2 e^-T from one direction, and spread around it:
// I/d^2 T e^-T NPSF. The spread light is kept in zonal harmonics around the light's direction; their inner product with
// the reflectance is the integral of the reflectance times a polynomial (Eq. 20 without the visibility of occluders).
// Taking the medium between light and surface as homogeneous is the paper's approximation; it is exact where it is so
// everywhere.
//
// Two more forms: Sun et al.'s without harmonics (sun_reflection.h), and light shadowed by surfaces, the triple product
// with a visibility (radiance_transfer.h).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "methods/fogshop/environment_psf.h"
#include "methods/fogshop/radiance_transfer.h"
#include "methods/fogshop/reflectance_table.h"
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
  // Materials in harmonics by surface: for those that are not Lambert, in place of a quadrature for every light.
  void use(std::vector<std::optional<ReflectanceTable>> tables) { reflectances_ = std::move(tables); }
  // Scattered light is shadowed by surfaces from now on. Not together with SunReflection, which has no harmonics.
  void shadow(std::shared_ptr<const RadianceTransfer> transfer) { transfer_ = std::move(transfer); }

  // L_p of the scattered light alone [W/m^2/sr] towards `to_view`, the medium's albedo included.
  Rgb operator()(const scene::Scene&, const Model&, const SurfacePoint&, const Vec3& to_view, Crossings&,
                 double& evaluations, std::vector<LightDepth>* found = nullptr) const;

  // The depths of the bands' table, ascending, even in log T; one where it does not follow the depth.
  std::vector<double> depths() const;
  // g_l, l < order, at depth T.
  std::vector<double> bands(double T) const { return bands_(T); }
  // Integral of brdf * cosine * (the light spread by these bands around `to_light`) over the hemisphere, per channel.
  // Lambert in closed form; others by 512 directions, which resolve Phong exponents up to about 50.
  static Rgb reflect(const scene::Material&, const Vec3& normal, const Vec3& to_view, const Vec3& to_light,
                     const std::vector<double>& bands);

 private:
  PsfBands bands_;
  Rgb reflect_one(const scene::Material&, const SurfacePoint&, const Vec3& to_view, const Vec3& to_light,
                  double T) const;

  std::optional<SunReflection> sun_;
  std::vector<std::optional<ReflectanceTable>> reflectances_;  // by surface; none: quadrature
  std::shared_ptr<const RadianceTransfer> transfer_;           // null: none
};

// What the settings ask for, without the transfer; `tables` of the reflectances make it quick.
std::unique_ptr<ScatteredReflection> make_reflection(const scene::Scene&, const Options&, bool tables = true);

// Why these surfaces cannot be lit so; empty if they can.
std::vector<std::string> objections_to_surfaces(const scene::Scene&, const Options&);

}  // namespace airlight::fogshop
