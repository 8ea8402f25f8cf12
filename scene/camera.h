// Perspective and orthographic cameras.
#pragma once
#include "scene/math/types.h"

namespace airlight::scene {

struct Camera {
  enum class Kind { perspective, orthographic };
  Kind kind = Kind::perspective;
  Point3 position = Point3::Zero();
  Vec3 forward = -Vec3::UnitZ();  // unit
  Vec3 right = Vec3::UnitX();     // unit
  Vec3 up = Vec3::UnitY();        // unit, the top of the image
  double vertical_fov = 0.7;      // [rad], perspective, in (0, pi)
  double height = 1;              // [m], orthographic: height of the film in the world
};

// Right-handed frame: right = forward x up. Throws Error if look_at equals position, or if up is along the view.
Camera look_at(const Point3& position, const Point3& target, const Vec3& up);

// Ray through film position (x, y) in pixels, (0, 0) the top left corner of the film, (0.5, 0.5) the centre of the top
// left pixel.
Ray camera_ray(const Camera&, double x, double y, int width, int height);

}  // namespace airlight::scene
