#include "methods/fogshop/scattered_reflection.h"

#include <fmt/format.h>

#include <cmath>

#include "methods/fogshop/harmonic_reflection.h"
#include "methods/fogshop/radiance_transfer.h"

namespace airlight::fogshop {

ScatteredReflection::ScatteredReflection(int order, bool follows_depth)
    : bands_(follows_depth ? Psf::npsf_by_depth : Psf::npsf, order) {}

Rgb ScatteredReflection::operator()(const scene::Scene& scene, const Model& model, const SurfacePoint& point,
                                    const Vec3& to_view, const std::vector<Rgb>& reflectance, Crossings& crossings,
                                    double& evaluations, std::vector<LightDepth>* found) const {
  const scene::Material& material = scene.surfaces[point.surface].material;
  Rgb radiance = Rgb::Zero();
  for (const LightModel& light : model.lights) {
    const Vec3 offset = light.position - point.position;
    const double distance = offset.norm();
    if (!(distance > 0)) continue;
    const Vec3 to_light = offset / distance;
    const double depth = light_depth(model, light.position, point.position, crossings, evaluations, found);
    Rgb reflected = Rgb::Zero();
    for (int c = 0; c < 3; ++c) {
      const double T = depth * model.fog.extinction_ratio[c];
      if (!(T > 0)) continue;
      const Rgb all = (sun_ ? sun_->reflect(material, point.normal, to_view, to_light, T)
                            : reflect_zonal(reflectance, bands_(T), to_light)) *
                      (T * std::exp(-T));
      if (model.fog.grey()) {  // one depth for all
        reflected = all;
        break;
      }
      reflected[c] = all[c];
    }
    radiance += light.intensity / (distance * distance) * reflected;
  }
  // Harmonics cut off at a band may swing below 0.
  return (radiance * model.fog.albedo).max(0.0);
}

std::unique_ptr<ScatteredReflection> make_reflection(const scene::Scene& scene, const Options& options) {
  using Reflectance = Options::Reflectance;
  const bool sun = options.reflectance == Reflectance::sun;
  auto reflection = std::make_unique<ScatteredReflection>(sun ? 1 : options.sh_order,
                                                          options.reflectance == Reflectance::npsf_by_depth);
  if (sun) reflection->use(SunReflection(scene.surfaces));
  return reflection;
}

std::vector<std::string> objections_to_surfaces(const scene::Scene& scene, const Options& options) {
  std::vector<std::string> reasons;
  const bool sun = options.reflectance == Options::Reflectance::sun;
  if (sun && options.prt)
    reasons.push_back(
        "reflectance = sun has no harmonics that a shadow could multiply: prt = true needs npsf or npsfT");
  for (std::size_t i = 0; sun && i < scene.surfaces.size(); ++i)
    if (std::holds_alternative<scene::Tabulated>(scene.surfaces[i].material))
      reasons.push_back(fmt::format("surface {} is tabulated: reflectance = sun knows lambert and phong alone", i));
  if (options.prt && mesh_vertices(scene) > most_transfer_vertices)
    reasons.push_back(fmt::format("prt = true for meshes of {:.0f} vertices, expected {:.0f} at most",
                                  mesh_vertices(scene), most_transfer_vertices));
  return reasons;
}

}  // namespace airlight::fogshop
