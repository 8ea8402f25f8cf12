// Any medium as a Legendre box: the L2 projection of its density, with Lanczos' factors and a limiter against the waves that a jump leaves.
// Gupta and Narasimhan 2007, section 4 (the projection); Lanczos' factors sinc(k/n) and the limiter theta of Zhang and Shu are ours.
#pragma once
#include <optional>
#include <string>

#include "scene/math/legendre.h"
#include "scene/media/medium.h"

namespace airlight::scene {

struct ProjectionOptions {
  TensorShape shape = {12, 12, 12};  // coefficients along the axes, 1 to LegendreBox::most
  std::optional<Box> box;            // by default the medium's box
  bool lanczos = true;               // coefficient (i, j, k) times sinc(i/n) sinc(j/n) sinc(k/n)
  // r <- mean + theta (r - mean) with the greatest theta that leaves r positive (a thousandth of the mean at least): keeps the mass.
  bool limiter = true;
  int cells = 24;  // along an axis, four Gauss points each: those of a medium with faces in between are met exactly
};

struct LegendreProjection {
  LegendrePointer field;
  double theta = 1;           // of the limiter; 1 where it was not needed
  double error = 0;           // relative L2 of the polynomial, not clamped, at points other than those that made it
  double clamped_error = 0;   // of the density, clamped
  double mass_ratio = 1;      // integral of the polynomial over that of the medium in the box
  double negative_share = 0;  // of the box, where the polynomial is below 0
  Interval values;            // of the polynomial: rigorous, the ends 1 % off where the search ended in time
};

// Throws Error for a box without end, or options out of range.
LegendreProjection project_to_legendre(const Medium&, const ProjectionOptions&);

// The coefficients as the CSV file that a medium of type "legendre" names; those below 1e-20 are left out and read as 0. Throws Error.
void write_legendre_csv(const std::string& path, const LegendreBox&);

}  // namespace airlight::scene
