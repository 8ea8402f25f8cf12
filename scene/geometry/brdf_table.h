// An isotropic reflectance in a table, f(theta_in, theta_out, delta_phi) [1/sr].
//
// Both polar angles are even over [0, pi/2], both ends included; the angle between the two azimuths is even over
// [0, pi] (isotropic and mirror symmetric), both ends included; linear between entries in each. This parametrisation,
// and not that by half and difference angle, because what a reflectance must obey can be checked here, not sampled:
// - reciprocity is the symmetry of the table in its first two indices, which linear interpolation keeps;
// - the albedo is linear in theta_in between entries, so one that is at most 1 at the entries is so at every angle.
// A sharp highlight needs many entries; the surfaces that this is for are smooth (harmonics of order 4 to 6).
#pragma once
#include <string>
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

class BrdfTable {
 public:
  // values[phis * (thetas * i + j) + k]: theta_in i, theta_out j, delta_phi k; thetas and phis 2 to 256. Throws Error,
  // naming the entry by its angles, for a value that is negative or not finite, for f(i, j, k) and f(j, i, k) that
  // differ by more than 1e-5 of the greater (below that their mean is taken), for a value at theta = 0 that depends on
  // delta_phi (no more than 1e-5 of it), and for an albedo above 1.
  BrdfTable(int thetas, int phis, std::vector<Rgb> values);

  // Zero below the horizon; `in` and `out` unit, both away from the surface.
  Rgb operator()(const Vec3& normal, const Vec3& in, const Vec3& out) const;
  // By the angles [rad].
  Rgb at(double theta_in, double theta_out, double delta_phi) const;
  // Share of the light from theta_in [rad] that is reflected: the exact integral of f cos theta_out over the
  // hemisphere.
  Rgb albedo(double theta_in) const;
  Rgb greatest_albedo() const { return greatest_albedo_; }

  int thetas() const { return thetas_; }
  int phis() const { return phis_; }
  const std::vector<Rgb>& values() const { return values_; }

 private:
  std::size_t place(int i, int j, int k) const { return std::size_t(phis_) * (std::size_t(thetas_) * i + j) + k; }
  std::string angles(int i, int j, int k) const;
  void check_values() const;
  void make_reciprocal();
  void check_albedo();

  int thetas_, phis_;
  std::vector<Rgb> values_;
  std::vector<Rgb> albedo_;  // by theta_in
  Rgb greatest_albedo_ = Rgb::Zero();
};

// Reads a text file: two integers, thetas and phis, then one line "r g b" for each entry in the order above (theta_in
// slowest); comments from '#'. Throws Error (file, line, what was found, what was expected).
BrdfTable read_brdf_table(const std::string& path);

}  // namespace airlight::scene
