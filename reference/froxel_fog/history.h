// The last frame of another camera, looked up where a froxel of this frame was in it: reprojection, as engines do while the camera moves.
#pragma once
#include <optional>

#include "reference/froxel_fog/volume.h"

namespace airlight::froxel_fog {

class History {
 public:
  // `volume`: before filter and integration, seen by `view`.
  History(Volume volume, const scene::View& view) : volume_(std::move(volume)), view_(view) {}

  // Light and media at a point, trilinear between the middles of froxels; nothing where it was outside the frustum or the slices.
  std::optional<Froxel> at(const Point3&) const;

 private:
  Volume volume_;
  scene::View view_;
};

}  // namespace airlight::froxel_fog
