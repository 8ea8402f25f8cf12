#include "methods/fogshop/surface_pass.h"

#include <algorithm>

namespace airlight::fogshop {

Rgb direct_reflection(const scene::Scene& scene, const Model& model, const SurfacePoint& point, const Vec3& to_view,
                      Crossings& crossings, double& evaluations) {
  Rgb radiance = Rgb::Zero();
  for (const scene::Light& light : scene.lights) {
    const scene::Incident in = scene::incident(light, point.position);
    const double cosine = point.normal.dot(in.to_light);
    if (!(cosine > 0)) continue;
    const Rgb reflectance = scene::brdf(scene.surfaces[point.surface].material, point.normal, in.to_light, to_view);
    if ((reflectance == 0).all()) continue;
    const Point3 start = scene.geometry->offset_origin(point.position, point.normal, in.to_light);
    if (scene.geometry->occluded({start, in.to_light}, in.distance)) continue;
    const Point3 source = point.position + in.distance * in.to_light;
    const double depth =
        gaussian_depth(model, source, point.position, crossings, evaluations) + model.fog.sum.constant * in.distance;
    radiance += reflectance * cosine * in.irradiance * (-depth * model.fog.hue).exp();
  }
  return radiance;
}

}  // namespace airlight::fogshop
