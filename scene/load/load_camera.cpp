#include <fmt/format.h>

#include "scene/base/error.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"

namespace airlight::scene::load {

Camera read_camera(TableReader reader) {
  const bool perspective = reader.type({"perspective", "orthographic"}, "perspective") == "perspective";
  reader.allow({"type", "position", "look_at", "up", perspective ? "vertical_fov" : "height"});
  const Vec3 position = reader.vector("position");
  const Vec3 target = reader.vector("look_at");
  const Vec3 up = reader.direction("up", Vec3::UnitY());
  if (!((target - position).norm() >= least_length))
    reader.expected("look_at", fmt::format("a point {} m or more from the camera's position", least_length));
  Camera camera;
  try {
    camera = look_at(position, target, up);
  } catch (const Error& e) {
    reader.fail(reader.has("up") ? "up" : "look_at", e.what());
  }
  camera.kind = perspective ? Camera::Kind::perspective : Camera::Kind::orthographic;
  if (perspective)
    camera.vertical_fov = reader.number("vertical_fov", field_of_view, 0.7);
  else
    camera.height = reader.number("height", length);
  return camera;
}

}  // namespace airlight::scene::load
