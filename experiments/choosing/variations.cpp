#include "experiments/choosing/variations.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "experiments/driver/next_frames.h"
#include "scene/math/random.h"

namespace airlight::experiments {
namespace {

class Uniform {
 public:
  explicit Uniform(int variation) : variation_(std::uint32_t(variation)) {}
  // Between -1 and 1.
  double next() { return 2 * uniform32(philox4x32_10({count_++, 0, 0, 0}, {variation_, 0})[0]) - 1; }
  double factor(double most) { return std::exp(next() * std::log(most)); }

 private:
  std::uint32_t variation_, count_ = 0;
};

scene::Light varied(const scene::Light& light, const scene::Scene& scene, Uniform& uniform) {
  if (const auto ball = scene::ball(light)) {
    const double reach = 0.2 * (ball->center - scene.camera.position).norm();
    for (int attempt = 0; attempt < 16; ++attempt) {
      // Compilers evaluate the arguments of a call in any order.
      const double z = uniform.next(), y = uniform.next(), x = uniform.next();
      const Vec3 by = reach * Vec3(x, y, z);
      const Ray way{ball->center, by.normalized()};
      if (!scene.geometry || !scene.geometry->occluded(way, by.norm() + 2 * ball->radius))
        return scene::moved(light, by);
    }
    return light;
  }
  if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) {
    scene::DirectionalLight turned = *sun;
    turned.to_light[1] *= uniform.factor(1.5);
    turned.to_light = (Eigen::AngleAxisd(uniform.next(), Vec3::UnitY()) * turned.to_light).normalized();
    return turned;
  }
  return scene::turned(light, std::numbers::pi * uniform.next());
}

}  // namespace

std::shared_ptr<const scene::Scene> varied(const scene::Scene& scene, int variation) {
  auto changed = std::make_shared<scene::Scene>(scene);
  if (variation == 0) return changed;
  Uniform uniform(variation);
  for (scene::Medium& medium : changed->media) {
    medium.sigma_t *= uniform.factor(2.5);
    medium.albedo = (1 - (1 - medium.albedo) * uniform.factor(2.5)).max(0);
  }
  for (scene::Light& light : changed->lights) light = varied(light, scene, uniform);
  Moving turn{Moving::What::camera};
  turn.turn = 0.3 * uniform.next();
  const double zoom = 1 + 0.15 * uniform.next();
  if (const auto seen = moved_back(*changed, turn)) {
    changed->camera = seen->camera;
    changed->camera.vertical_fov *= zoom;
    changed->camera.height *= zoom;
  }
  finish(*changed);
  changed->geometry = scene.geometry;
  changed->name = fmt::format("{}, variation {}", scene.name, variation);
  return changed;
}

}  // namespace airlight::experiments
