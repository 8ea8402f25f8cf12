#include "methods/fogshop/surface_lighting.h"

#include "methods/fogshop/harmonic_reflection.h"
#include "scene/math/sh_product.h"

namespace airlight::fogshop {

SurfaceLighting make_lighting(const scene::Scene& scene, const Model& model, const Needs& needs,
                              const scene::Execution& execution, const std::function<void(const std::string&)>& stage) {
  const Options& options = model.options;
  SurfaceLighting lighting;
  if (needs.point_harmonics) {
    lighting.points = make_reflection(scene, options);
    stage(options.reflectance == Options::Reflectance::sun ? "tables of Sun et al." : "harmonics of the NPSF");
  }
  if (needs.reflectances) {
    lighting.reflectances = std::make_unique<SurfaceReflectances>(scene.surfaces, options.sh_order);
    stage("harmonics of reflectances");
  }
  if (needs.transfer) {
    lighting.transfer = std::make_unique<RadianceTransfer>(scene, options.sh_order, options.prt_rays, options.prt_reach,
                                                           options.prt_bounces, execution);
    stage("radiance transfer");
  }
  if (needs.environment_harmonics) {
    lighting.environment = std::make_unique<EnvironmentLighting>(scene, options, needs.environment_psf);
    stage("harmonics of the environment");
  }
  if (needs.depth_tree) {
    lighting.depths = std::make_unique<DepthTree>(model.gaussians, scene.surfaces, model.threshold, execution);
    stage("tree of average depths");
  }
  return lighting;
}

std::vector<Rgb> shadowed_reflectance(const scene::Scene& scene, const SurfaceLighting& lighting,
                                      const SurfacePoint& point, const Vec3& to_view) {
  std::vector<Rgb> reflectance = (*lighting.reflectances)(scene, point.surface, point.normal, to_view);
  if (!lighting.transfer) return reflectance;
  const std::vector<double> visibility = lighting.transfer->visibility(scene, point);
  if (visibility.empty()) return reflectance;
  reflectance = scene::triple_product(lighting.reflectances->order())(reflectance, visibility);
  const std::vector<Rgb> reflected = lighting.transfer->reflected(scene, point);
  const Rgb factor = diffuse_albedo(scene.surfaces[std::size_t(point.surface)].material) / pi;
  for (std::size_t k = 0; k < reflected.size(); ++k) reflectance[k] += factor * reflected[k];
  return reflectance;
}

void reflect_environment(const Model& model, const SurfaceLighting& lighting, const SurfacePoint& point,
                         const std::vector<Rgb>& reflectance, Rgb& direct, Rgb* scattered) {
  const double depth = average_depth(model, point.position, lighting.depths.get());
  const IncidentHarmonics in = lighting.environment->incident(model.fog, depth, scattered != nullptr);
  direct += reflect_harmonics(reflectance, in.attenuated).max(0.0);
  if (scattered) *scattered += reflect_harmonics(reflectance, in.scattered).max(0.0);
}

}  // namespace airlight::fogshop
