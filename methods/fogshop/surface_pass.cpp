#include "methods/fogshop/surface_pass.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "methods/fogshop/surface_lighting.h"
#include "scene/picture.h"

namespace airlight::fogshop {

double light_depth(const Model& model, const Point3& source, const Point3& point, Crossings& crossings,
                   double& evaluations, std::vector<LightDepth>* found) {
  if (found)
    for (const LightDepth& known : *found)
      if (known.source == source) return known.depth;
  const double depth =
      gaussian_depth(model, source, point, crossings, evaluations) + model.fog.sum.constant * (source - point).norm();
  if (found) found->push_back({source, depth});
  return depth;
}

Rgb direct_reflection(const scene::Scene& scene, const Model& model, const SurfacePoint& point, const Vec3& to_view,
                      Crossings& crossings, double& evaluations, std::vector<LightDepth>* found) {
  const scene::Hit hit{0, point.position, point.normal, point.surface, point.triangle};
  return scene::direct_light(scene, hit, to_view, scene.lights, [&](const scene::Incident&, std::size_t l) -> Rgb {
    const Point3& source = std::get<scene::PointLight>(scene.lights[l]).position;
    const double depth = light_depth(model, source, point.position, crossings, evaluations, found);
    return (-depth * model.fog.extinction_ratio).exp();
  });
}

FirstHits first_hits(const scene::Scene& scene, const scene::View& view, const scene::Execution& execution) {
  const std::size_t pixels = std::size_t(view.width) * view.height;
  FirstHits hits{std::vector<double>(pixels, infinity),
                 std::vector<SurfacePoint>(pixels, SurfacePoint{Point3::Zero(), Vec3::Zero(), -1}),
                 std::vector<float>(scene.backdrops.empty() ? 0 : 3 * pixels, std::nanf(""))};
  scene::parallel_for(view.height, execution, [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      const std::size_t i = std::size_t(y) * view.width + x;
      const scene::RayEnd end =
          scene::camera_end(scene, camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height));
      hits.distance[i] = end.t;
      if (end.hit) hits.points[i] = {end.hit->position, end.hit->normal, end.hit->surface, end.hit->triangle};
      for (int c = 0; end.seen && c < 3; ++c) hits.seen[3 * i + c] = float((*end.seen)[c]);
    }
  });
  return hits;
}

double surface_pass(const scene::Scene& scene, const Model& model, const SurfaceLighting& lighting,
                    const scene::View& view, const std::vector<SurfacePoint>& hits,
                    const std::vector<float>& transmittance, const scene::Execution& execution,
                    std::vector<float>& surface, std::vector<float>* scattered) {
  std::vector<double> calls(view.height, 0.0);
  scene::parallel_for(view.height, execution, [&](int y) {
    Crossings crossings;
    std::vector<LightDepth> found;
    for (int x = 0; x < view.width; ++x) {
      const std::size_t i = std::size_t(y) * view.width + x;
      if (hits[i].surface < 0) continue;
      found.clear();
      const Vec3 to_view = -camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height).direction;
      Rgb radiance = direct_reflection(scene, model, hits[i], to_view, crossings, calls[y], &found), part = Rgb::Zero();
      const std::vector<Rgb> reflectance =
          lighting.reflectances ? shadowed_reflectance(scene, lighting, hits[i], to_view) : std::vector<Rgb>{};
      if (lighting.points)
        part = (*lighting.points)(scene, model, hits[i], to_view, reflectance, crossings, calls[y], &found);
      if (lighting.environment)
        reflect_environment(model, lighting, hits[i], reflectance, radiance, scattered ? &part : nullptr);
      for (int c = 0; scattered && c < 3; ++c) (*scattered)[3 * i + c] = float(transmittance[3 * i + c] * part[c]);
      radiance += part;
      for (int c = 0; c < 3; ++c) surface[3 * i + c] = float(transmittance[3 * i + c] * radiance[c]);
    }
  });
  return std::accumulate(calls.begin(), calls.end(), 0.0);
}

}  // namespace airlight::fogshop
