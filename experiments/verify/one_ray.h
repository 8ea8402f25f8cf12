// A renderer's result along rays, for vectors: films of one pixel, from a preparation that is made once.
#pragma once
#include <map>
#include <memory>
#include <string>

#include "scene/renderer.h"

namespace airlight::experiments::verification {

using Given = std::map<std::string, std::string>;

inline scene::Camera camera_along(const Point3& origin, const Vec3& direction) {
  const Vec3 forward = direction.normalized(), up = std::abs(forward.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX();
  return scene::look_at(origin, origin + forward, up);
}

// View of one pixel along a ray. With `height` > 0 [m] the camera is orthographic: it looks at
// everything from the ray's direction.
inline scene::View view_along(const Ray& ray, double height) {
  scene::View view{camera_along(ray.origin, ray.direction), 1, 1};
  if (height > 0) view.camera.kind = scene::Camera::Kind::orthographic, view.camera.height = height;
  return view;
}

class OneRay {
 public:
  OneRay(const scene::Renderer& renderer, std::shared_ptr<const scene::Scene> s, const Given& given = {})
      : prepared(renderer.prepare(std::move(s), {renderer.settings(), given}, {1, {}})) {}
  OneRay(const scene::Renderer& renderer, const scene::Scene& s, const Given& given = {})
      : OneRay(renderer, finished(s), given) {}

  scene::Film operator()(const Ray& ray, double height = 0) const {
    return prepared->render(view_along(ray, height), {1, {}}).film;
  }
  std::unique_ptr<scene::Prepared> prepared;

 private:
  static std::shared_ptr<const scene::Scene> finished(const scene::Scene& s) {
    auto copy = std::make_shared<scene::Scene>(s);
    copy->width = copy->height = 1;
    finish(*copy);
    return copy;
  }
};

}  // namespace airlight::experiments::verification
