// Back to front as the paper sorts shadow planes: Biri et al. 2006, section 5.1.4, stage 4.
#pragma once
#include <vector>

#include "methods/shadow_planes/shadow_volumes.h"
#include "scene/camera.h"

namespace airlight::shadow_planes {

// The paper's distance of a plane from the camera: the cosine at the light between the camera and a point of the
// silhouette, in [-1, 1]; least is drawn first. `to_camera`: unit.
inline double order_key(const Vec3& from_light, const Vec3& to_camera) {
  return from_light.normalized().dot(to_camera);
}

// The keys of all planes of a light, every edge in equal pieces with a key for the middle of each. Computed once; where
// the camera is orthographic every ray begins elsewhere, and has keys of its own.
class PlaneOrder {
 public:
  PlaneOrder(const ShadowVolumes&, const scene::Camera&, int pieces);  // keeps a reference to the first

  // Sorts the crossings of a ray: sets the keys of the crossed pieces, then sorts by key, and by edge
  // number where keys are equal.
  void sort(const Ray&, Crossing* begin, Crossing* end) const;

 private:
  double key(int edge, int piece, const Vec3& to_camera) const;

  const ShadowVolumes& shadows_;
  int pieces_;
  std::vector<double> keys_;  // by edge, then piece; empty: orthographic
};

}  // namespace airlight::shadow_planes
