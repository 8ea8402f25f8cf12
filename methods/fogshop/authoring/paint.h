// The paintbrush: Gaussians at equal distances along a stroke, moved aside at random (Zhou et al. 2007, section 6).
#pragma once
#include <cstdint>
#include <optional>

#include "methods/fogshop/authoring/gaussian_list.h"

namespace airlight::fogshop::authoring {

struct Paint {
  std::vector<Point3> stroke;     // [m], at least one point
  Gaussian brush;                 // a, c, colour, tag of all that it places
  std::optional<double> spacing;  // [m] along the stroke, > 0; the paper's 0.75 / a if not given
  std::optional<double> jitter;   // [m], >= 0: no centre is moved by as much; 1 / a if not given
  std::uint32_t seed = 0;
};

// A place on the stroke before the jitter.
struct StrokePoint {
  Point3 position;
  Vec3 tangent;  // unit; zero for a stroke without length
};

// Points at j * spacing of arc length, j = 0 .. floor(length / spacing); what is left of one edge is carried to the
// next. A stroke without length gives one point. Throws Error if there would be more points than a list may have.
std::vector<StrokePoint> resample(const std::vector<Point3>& stroke, double spacing);

// Offsets are uniform in the open disc of radius `jitter` perpendicular to the stroke at that place; none where it has
// no direction. Ids in the order of the stroke. The caller begins the step.
std::vector<Id> paint(GaussianList&, const Paint&);

}  // namespace airlight::fogshop::authoring
