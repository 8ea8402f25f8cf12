#include "methods/fogshop/surface_lighting.h"

#include "methods/fogshop/harmonic_reflection.h"
#include "scene/math/sh_product.h"

namespace airlight::fogshop {

SurfaceLighting make_lighting(const scene::Scene& scene, const Model& model, const Needs& needs,
                              const SurfaceLighting& before, const Unchanged& same, const scene::Execution& execution,
                              const std::function<void(const std::string&)>& stage) {
  const Options& options = model.options;
  SurfaceLighting lighting;
  // One part: what the frame before has of it, if that still holds, or else what is made.
  const auto part = [&](auto& now, const auto& was, bool needed, bool holds, const char* name, const auto& make) {
    if (!needed) return;
    if (was && holds) {
      now = was;
      return;
    }
    now = make();
    stage(name);
  };
  part(lighting.points, before.points, needs.point_harmonics, same.surfaces,
       options.reflectance == Options::Reflectance::sun ? "tables of Sun et al." : "harmonics of the NPSF",
       [&] { return make_reflection(scene, options); });
  part(lighting.reflectances, before.reflectances, needs.reflectances, same.surfaces, "harmonics of reflectances",
       [&] { return std::make_shared<SurfaceReflectances>(scene.surfaces, options.sh_order); });
  part(lighting.transfer, before.transfer, needs.transfer, same.surfaces, "radiance transfer", [&] {
    return std::make_shared<RadianceTransfer>(scene, options.sh_order, options.prt_rays, options.prt_reach,
                                              options.prt_bounces, execution);
  });
  const bool spreads = needs.environment_psf;
  part(lighting.environment, before.environment, needs.environment_harmonics,
       same.environments && before.environment && before.environment->spreads() == spreads,
       "harmonics of the environment",
       [&] { return std::make_shared<EnvironmentLighting>(scene, options, spreads, before.environment.get()); });
  part(lighting.depths, before.depths, needs.depth_tree, same.gaussians && same.surfaces, "tree of average depths",
       [&] { return std::make_shared<DepthTree>(model.gaussians, scene.surfaces, model.threshold, execution); });
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
