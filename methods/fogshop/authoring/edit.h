// Eraser, copy and move (Zhou et al. 2007, section 6).
#pragma once
#include "methods/fogshop/authoring/gaussian_list.h"
#include "methods/fogshop/authoring/screen.h"

namespace airlight::fogshop::authoring {

// A ball in the world that is set down at every point of the path, or a disc on the screen. At each place a Gaussian at
// distance r < radius loses strength * c0 * (1 - (r / radius)^2), c0 its amplitude before the operation; it is removed
// once nothing is left. The paper says only that density is reduced: the falloff is ours.
struct Eraser {
  double radius = 1;    // [m], or [pixels] on the screen; > 0
  double strength = 1;  // [-], in [0, 1]
};

// Ids of all that lost something, in the order of the list.
std::vector<Id> erase(GaussianList&, const std::vector<Point3>& path, const Eraser&);
// Only what lies in front of the camera.
std::vector<Id> erase(GaussianList&, const View&, const std::vector<ScreenPoint>& path, const Eraser&);

// b -> rotation (scale b) + translation, a -> a / scale.
struct Placement {
  Mat3 rotation = Mat3::Identity();
  double scale = 1;  // > 0
  Vec3 translation = Vec3::Zero();
  // Quantity that a change of scale keeps: the optical depth through the centre (c -> c / scale), or the
  // density (c unchanged).
  enum class Keep { depth, density } keep = Keep::depth;
};

// Throw Error for an id that no Gaussian has. `copy` returns the ids of the clones, at the end of the list in the order
// of the list; `move` those moved.
std::vector<Id> copy(GaussianList&, const std::vector<Id>&, const Placement&);
std::vector<Id> move(GaussianList&, const std::vector<Id>&, const Placement&);

}  // namespace airlight::fogshop::authoring
