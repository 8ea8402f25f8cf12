#include "reference/froxel_fog/history.h"

#include "scene/camera_rays.h"

namespace airlight::froxel_fog {

std::optional<Froxel> History::at(const Point3& x) const {
  const Vec3 place = scene::film_position(view_.camera, x, view_.width, view_.height);
  const double z = place[2];
  const Interval range = volume_.slices().range();
  if (!(z >= range.lo && z <= range.hi)) return {};
  if (!(place[0] >= 0 && place[0] <= view_.width && place[1] >= 0 && place[1] <= view_.height)) return {};
  return volume_.froxel_at(place[0], place[1], volume_.slices().encode(z));
}

}  // namespace airlight::froxel_fog
