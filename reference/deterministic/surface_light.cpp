#include "reference/deterministic/surface_light.h"

#include "scene/background.h"

namespace airlight::deterministic {

Rgb end_radiance(const scene::Scene& scene, const AirlightIntegrator& integrator, const Ray& ray,
                 const scene::RayEnd& end) {
  if (!end.hit) return background(scene, end, ray.direction);
  Rgb sum = Rgb::Zero();
  const scene::Hit& hit = *end.hit;
  const scene::Material& material = scene.geometry->surfaces()[hit.surface].material;
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    if (!scene::is_delta(scene.lights[l])) continue;
    const scene::Incident in = scene::incident(scene.lights[l], hit.position);
    const double cosine = hit.normal.dot(in.to_light);
    if (!(cosine > 0) || !(in.irradiance.maxCoeff() > 0)) continue;
    const Rgb reflected = scene::brdf(material, hit.normal, in.to_light, -ray.direction) * in.irradiance * cosine;
    if (!(reflected.maxCoeff() > 0)) continue;
    const Point3 start = scene.geometry->offset_origin(hit.position, hit.normal, in.to_light);
    if (scene.geometry->occluded({start, in.to_light}, in.distance)) continue;
    sum += reflected * (-integrator.light_depth(hit.position, int(l))).exp();
  }
  return sum;
}

}  // namespace airlight::deterministic
