// A camera as shaders read it: in single precision (common/camera.glsl), or where places must be exact in double
// (raster/view.glsl).
#pragma once
#include <cmath>

#include "gpu/linked_program.h"
#include "scene/renderer.h"

namespace airlight::gpu {

// Work groups over a picture are squares of this many pixels to a side.
inline constexpr int pixel_tile = 8;

// Half the film's size: at distance 1, or in metres where the camera is orthographic.
struct HalfFilm {
  double x, y;
};
inline HalfFilm half_film(const scene::View& view) {
  const scene::Camera& camera = view.camera;
  const bool perspective = camera.kind == scene::Camera::Kind::perspective;
  const double y = perspective ? std::tan(0.5 * camera.vertical_fov) : 0.5 * camera.height;
  return {y * view.width / view.height, y};
}

// The uniforms that camera_ray reads, places relative to `origin` [m].
inline void set_camera(LinkedProgram& program, const scene::View& view, const Point3& origin = Point3::Zero()) {
  const scene::Camera& camera = view.camera;
  const HalfFilm half = half_film(view);
  program.set("perspective", camera.kind == scene::Camera::Kind::perspective);
  program.set("camera_position", Vec3(camera.position - origin));
  program.set("camera_forward", camera.forward);
  program.set("camera_right", Vec3(half.x * camera.right));
  program.set("camera_up", Vec3(half.y * camera.up));
  program.set("width", view.width);
  program.set("height", view.height);
}

// The uniforms that view_ray reads.
inline void set_view(LinkedProgram& program, const scene::View& view) {
  const scene::Camera& camera = view.camera;
  const HalfFilm half = half_film(view);
  program.set("view_perspective", camera.kind == scene::Camera::Kind::perspective);
  program.set_double("view_position", camera.position);
  program.set_double("view_forward", camera.forward);
  program.set_double("view_right", Vec3(half.x * camera.right));
  program.set_double("view_up", Vec3(half.y * camera.up));
  program.set("view_width", view.width);
  program.set("view_height", view.height);
}

}  // namespace airlight::gpu
