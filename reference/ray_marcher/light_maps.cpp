#include "reference/ray_marcher/light_maps.h"

#include "reference/ray_marcher/samples.h"
#include "scene/base/stopwatch.h"
#include "scene/media/same_medium.h"

namespace airlight::ray_marcher {
namespace {

// The varying density of a layer, in float.
void kernel_densities(const Layer& layer, std::size_t n, const double* x, const double* y, const double* z,
                      float* density) {
  static thread_local std::vector<float> local[3];
  for (auto& v : local) resize_padded(v, n);
  float *lx = local[0].data(), *ly = local[1].data(), *lz = local[2].data();
  to_local(layer.grid ? layer.grid->frame : layer.gaussians->frame, n, x, y, z, lx, ly, lz);
  if (layer.grid)
    grid_density(*layer.grid, n, lx, ly, lz, density);
  else
    gaussian_density(*layer.gaussians, n, lx, ly, lz, density);
}

double count_maps(const scene::Scene& scene, const Options& options) {
  double lights = 0;
  for (const scene::Light& light : scene.lights) lights += is_delta(light) ? 1 : options.environment_directions;
  return lights;
}

}  // namespace

light_map::Densities densities_by_kernels(const std::vector<Layer>& layers, const std::vector<scene::Medium>& media) {
  std::vector<const Layer*> of_medium(media.size(), nullptr);
  for (const Layer& layer : layers)
    if (layer.grid || layer.gaussians) of_medium[std::size_t(layer.medium - media.data())] = &layer;
  return [of_medium, plain = light_map::densities_of(media)](std::size_t medium, std::size_t n, const double* x,
                                                             const double* y, const double* z, float* density) {
    if (of_medium[medium])
      kernel_densities(*of_medium[medium], n, x, y, z, density);
    else
      plain(medium, n, x, y, z, density);
  };
}

double map_work(const scene::Scene& scene, const Options& options) {
  return count_maps(scene, options) * options.map.size * options.map.size * options.map.steps *
         double(scene.media.size());
}

bool needs_maps(const Plan& plan) {
  return plan.options.shadow == Shadow::map && !plan.layers.empty() && !plan.lights.empty() &&
         (plan.scatters || plan.scene->geometry);
}

void make_light_maps(Plan& plan, const scene::Execution& execution, const Plan* before) {
  if (!needs_maps(plan)) return;
  scene::Stopwatch watch;
  const std::vector<scene::Medium>& media = plan.scene->media;
  const light_map::Densities densities =
      plan.options.simd ? densities_by_kernels(plan.layers, media) : light_map::densities_of(media);
  const bool keeps = before && !before->maps.empty() && before->options.simd == plan.options.simd &&
                     scene::same_media(before->scene->media, media);
  light_map::Maps maps = keeps ? make_maps(plan.lights, media, plan.options.map, densities, execution, "ray_marcher",
                                           before->lights, before->maps)
                               : make_maps(plan.lights, media, plan.options.map, densities, execution, "ray_marcher");
  plan.maps = std::move(maps.of_lights);
  plan.maps_made = maps.made;
  if (maps.made > 0) plan.map_seconds = watch.lap();
}

}  // namespace airlight::ray_marcher
