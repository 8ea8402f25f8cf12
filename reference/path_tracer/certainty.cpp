#include "reference/path_tracer/certainty.h"

#include <algorithm>
#include <cmath>

#include "scene/geometry/brdf_table.h"

namespace airlight::path_tracer {
namespace {

constexpr double few = 4;

bool shines(const scene::Light& light, int c) {
  return scene::match(
      light, [c](const scene::PointLight& point) { return point.intensity[c] > 0; },
      [c](const scene::SpotLight& spot) { return spot.intensity[c] > 0; },
      [c](const scene::DirectionalLight& sun) { return sun.irradiance[c] > 0; },
      [c](const scene::EnvironmentLight& environment) { return environment.scale[c] > 0; });
}

bool reflects(const scene::Material& material, int c) {
  return scene::match(
      material, [c](const scene::Lambert& lambert) { return lambert.albedo[c] > 0; },
      [c](const scene::Phong& phong) { return phong.diffuse[c] + phong.specular[c] > 0; },
      [c](const scene::Tabulated& tabulated) { return tabulated.table->greatest_albedo()[c] > 0; });
}

}  // namespace

std::array<bool, 3> may_shine(const World& world, const Ray& ray) {
  const scene::RayEnd end = scene::camera_end(world.scene(), ray);
  std::array<bool, 3> may{};
  const Options& options = world.options();
  if (options.only_lit_surfaces() && !end.hit) return may;
  const bool behind = options.paths != Options::Paths::scattered;
  for (int c = 0; c < 3; ++c) {
    const auto& lights = world.scene().lights;
    if (std::none_of(lights.begin(), lights.end(), [&](const scene::Light& light) { return shines(light, c); }))
      continue;
    for (const int i : world.lights().environments())
      may[c] = may[c] || (behind && end.t == infinity && shines(world.lights().light(i), c));
    if (behind && end.hit && options.max_events != 0)
      may[c] = may[c] || reflects(world.scene().surfaces[end.hit->surface].material, c);
    for (const TrackedMedium& tracked : world.media().tracked())
      may[c] = may[c] || (options.max_order != 0 && options.max_events != 0 &&
                          tracked.medium->sigma_t[c] * tracked.medium->albedo[c] > 0 &&
                          !scene::extent(*tracked.medium, ray, {0, end.t}).empty());
  }
  return may;
}

std::array<bool, 3> may_shine(const World& world, const scene::View& view, int x, int y) {
  const int n = world.options().box_pixels ? 4 : 1;
  std::array<bool, 3> may{};
  for (int i = 0; i < n * n; ++i) {
    const auto some = may_shine(
        world, scene::camera_ray(view.camera, x + (i % n + 0.5) / n, y + (i / n + 0.5) / n, view.width, view.height));
    for (int c = 0; c < 3; ++c) may[c] = may[c] || some[c];
  }
  return may;
}

double honest_error(double sum, double square, double n, double greatest_of_picture, bool may_shine) {
  if (!(n > 0)) return 0;
  const double error = n < 2 ? 0 : std::sqrt(std::max(0.0, square - sum * sum / n) / (n * (n - 1)));
  // sum^2 / square is the number of samples that brought the light, if they are alike; none where squares underflow.
  const double contributing = square > 0 ? sum * sum / square : 0;
  const bool enough = n >= 2 && (contributing >= few || contributing >= n * (1 - 1e-9));
  if (enough || !may_shine) return error;
  return std::max(error, 3 / n * greatest_of_picture);
}

}  // namespace airlight::path_tracer
