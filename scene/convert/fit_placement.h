// Where a fit's Gaussians begin, and where the least useful ones are sent.
#pragma once
#include "scene/convert/fit_bounds.h"
#include "scene/convert/fit_objective.h"

namespace airlight::scene {

// n Gaussians over the filled voxels: these are halved n - 1 times, always the part whose densities differ most from their mean (by the
// sum of squares, with half of their own squares added, so that even smoke is divided too), across its longest side at equal mass.
// Fewer than n where there are fewer voxels to part. Amplitudes are not fitted yet.
std::vector<Gaussian> place_gaussians(const Eigen::Vector3i& size, const float* values, double scale, int n,
                                      const FitBounds&);

// Where density is missing most, about the last value() of the objective and what was added since: cells two least widths wide, by their
// sum of E, the most negative first; the places are the means of their missing density.
std::vector<Point3> missing_places(const FitObjective<float>&, const FitBounds&, std::size_t most);

// Filled voxels at random, the same for the same seed; fewer than `most` where fewer are filled.
std::vector<Point3> random_places(const Eigen::Vector3i& size, const float* values, std::uint32_t seed,
                                  std::size_t most);

// A new Gaussian at x, of the width and amplitude that lower the objective most; and by how much. Gain 0: none does.
struct Placed {
  Gaussian gaussian;
  double gain = 0;
};
Placed place_at(const FitObjective<float>&, const FitBounds&, const Point3& x);

// Sends up to `most` of the least significant Gaussians (least amplitude^2 width^3, which is what the objective loses at most) to where
// density is missing most, as long as more is gained there than lost here. Zhou et al. 2008, section 5.1, sends one at a time, that of
// the least amplitude width^3. With `places` they are sent to those instead. Gives back how many moved: 0, and the list as it was, unless
// the objective falls.
int teleport(FitObjective<float>&, const FitBounds&, std::vector<Gaussian>&, int most,
             const std::vector<Point3>& places = {});

}  // namespace airlight::scene
