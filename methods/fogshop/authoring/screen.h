// Between the screen, where an author draws, and the world.
#pragma once
#include <optional>
#include <vector>

#include "methods/fogshop/authoring/gaussian_list.h"
#include "scene/camera.h"

namespace airlight::fogshop::authoring {

struct View {
  scene::Camera camera;
  int width = 800, height = 600;  // [pixels]
};

using ScreenPoint = Eigen::Vector2d;  // [pixels], (0, 0) the top left corner of the film

// The plane dot(normal, x) = d.
struct Canvas {
  Vec3 normal = Vec3::UnitZ();  // unit
  double d = 0;                 // [m]
};

// Where the ray through the screen point meets the plane; nothing if it is parallel to it or the plane lies behind.
std::optional<Point3> unproject(const View&, const ScreenPoint&, const Canvas&);

// Nothing for points at most `near` [m] in front of the camera.
std::optional<ScreenPoint> project(const View&, const Point3&, double near = 0);

// Ids of the Gaussians whose centres lie in front of the near plane and project into x0 <= x < x1, y0 <= y < y1.
std::vector<Id> select(const GaussianList&, const View&, const ScreenPoint& lo, const ScreenPoint& hi, double near);

}  // namespace airlight::fogshop::authoring
