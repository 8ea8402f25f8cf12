// Light that the medium scatters onto Lambert and Phong surfaces, without harmonics: Sun et al. 2005 with the depth
// integrated along the path, the alternative at the end of section 4.3 of Zhou et al. 2007.
//
// The integral of reflectance times cosine times the NPSF of a homogeneous medium of depth T depends, for Lambert, on T
// and the angle between normal and light alone. For a Phong lobe the integral of the vector `in` times lobe times NPSF
// lies in the plane of mirror direction and light and depends on T and the angle between the two; its product with the
// normal is the wanted integral, if the lobe does not dip below the horizon (where it would count negative).
// (Sun et al.'s G_n leaves the cosine out of the lobe; here it is in, as in scene::brdf.)
#pragma once
#include <vector>

#include "scene/geometry/surface.h"
#include "scene/math/types.h"

namespace airlight::fogshop {

// Functions of (T, angle): log T over [1e-3, 30], angle over [0, pi], linear between entries.
class DepthAngleTable {
 public:
  // kernel(angle, gamma): mean of the function over the ring at gamma around the light, which is at `angle` from the
  // function's axis. The table is 2 pi integral kernel NPSF_T sin gamma dgamma.
  template <class Kernel>
  explicit DepthAngleTable(const Kernel& kernel);
  double operator()(double T, double cosine) const;
  const std::vector<double>& values() const { return values_; }  // [depth][angle]

  static constexpr int depths = 64, angles = 257;
  static constexpr double least_depth = 1e-3, greatest_depth = 30;

 private:
  void fill(const std::vector<std::vector<double>>& kernel);
  std::vector<double> values_;
};

class SunReflection {
 public:
  // Tables for Lambert and for every exponent among these; throws Error for a material that is neither Lambert nor
  // Phong.
  explicit SunReflection(const std::vector<scene::Surface>&);

  // Integral of brdf * cosine * NPSF_T around `to_light` over the hemisphere [-], per channel. Against quadrature:
  // Lambert 1e-3 of the light from straight above; Phong likewise while the lobe stays above the horizon.
  Rgb reflect(const scene::Material&, const Vec3& normal, const Vec3& to_view, const Vec3& to_light, double T) const;

  struct Lobe {
    double exponent;
    DepthAngleTable along, across;  // components along the mirror direction, and perpendicular to it towards the light
  };
  const DepthAngleTable& lambert() const { return lambert_; }
  const std::vector<Lobe>& lobes() const { return lobes_; }

 private:
  static Lobe make_lobe(double exponent);

  DepthAngleTable lambert_;
  std::vector<Lobe> lobes_;
};

}  // namespace airlight::fogshop
