// A medium as the marcher sees it: a constant that needs no steps, plus a part that varies and is marched.
//
// The constant of a homogeneous medium, or of a sum of Gaussians, contributes length * constant to an optical depth in
// closed form; what is left is sampled, and only where it can be different from zero.
#pragma once
#include <memory>
#include <vector>

#include "reference/ray_marcher/kernels.h"
#include "reference/ray_marcher/options.h"
#include "scene/media/medium.h"

namespace airlight::ray_marcher {

struct Layer {
  const scene::Medium* medium;
  double constant = 0;   // [-] density in the whole region
  bool varies = false;   // is there anything besides the constant
  scene::Region varied;  // the varying part is zero (or negligible) outside this, or outside the medium's region
  // The varying part, laid out for the kernels. Both are null for a field without kernel, which is
  // marched by plain loops.
  std::shared_ptr<const GridField> grid;
  std::shared_ptr<const GaussianField> gaussians;
  LocalShape shape;  // the region for the kernels
  Frame shape_frame;
  double most_varied = 0;  // [-] upper bound of what varies
  // Sum over all layers that vary of the extinction per unit of density, in the thickest channel [1/m]. The step size
  // of shadow rays depends on it, so that a medium in two halves is stepped like the whole.
  double thickest = 0;
};

// Media that can be seen at all: some extinction, some density. `before`: layers of the frame before, whose media still live; what is laid
// out for the kernels is shared where the field is the same, and the samples of a grid where it has moved alone.
std::vector<Layer> make_layers(const std::vector<scene::Medium>&, const std::vector<Layer>& before = {});

// Where a ray meets the region; and where it meets the varying part, empty if there is none.
Interval constant_extent(const Layer&, const Ray&, Interval t);
Interval varied_extent(const Layer&, const Ray&, Interval t);

// Density minus the constant at a point inside the region [-]; negative only where a Gaussian is.
double varied_density(const Layer&, const Point3&);

// Steps of a march through `extent`: `count` of them, or as many of at most `length` if that is positive.
int steps_through(Interval extent, int count, double length);

// Optical depth per unit sigma_t along the ray [m]: closed form for the constant, midpoint rule for the rest, its steps
// divided where they are deep (depth.h). `steps` counts the evaluations. May be infinite if t is.
double marched_column(const Layer&, const Options&, const Ray&, Interval t, long long& steps);

}  // namespace airlight::ray_marcher
