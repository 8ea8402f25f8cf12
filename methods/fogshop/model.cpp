#include "methods/fogshop/model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "methods/fogshop/map_error.h"
#include "scene/light/scattered_lights.h"

namespace airlight::fogshop {

namespace {

void bind_surfaces(scene::SettingBinder& b, Options& o) {
  using Reflectance = Options::Reflectance;
  b.choice("reflectance", o.reflectance,
           {{"direct", Reflectance::direct},
            {"npsf", Reflectance::npsf},
            {"npsfT", Reflectance::npsf_by_depth},
            {"sun", Reflectance::sun}},
           "of surfaces: unscattered light alone; scattered too, by the printed NPSF, by that of the depth, or by "
           "Sun et al.'s integrals");
  b.flag("prt", o.prt, "surfaces shadow scattered light, and that of environments, on meshes: precomputed transfer");
  b.integer("prt_rays", o.prt_rays, 16, 65536, "directions per vertex of the precomputed transfer")
      .where("prt", {"true"});
  b.real("prt_reach", o.prt_reach, 0, 1e300, "distance [m] up to which surfaces shadow in the precomputed transfer")
      .where("prt", {"true"});
  b.integer("prt_bounces", o.prt_bounces, 0, 16,
            "times that surfaces reflect light onto one another in the precomputed transfer")
      .where("prt", {"true"});
}

void bind_environment(scene::SettingBinder& b, Options& o) {
  using Airlight = Options::EnvironmentAirlight;
  b.choice("environment_psf", o.environment_psf,
           {{"npsf", Psf::npsf}, {"npsfT", Psf::npsf_by_depth}, {"ball", Psf::ball}},
           "spreads environment light: printed NPSF, that of the depth, or that of a ball of the depth")
      .where("environment_airlight", {"psf", "everywhere"})
      .or_where("reflectance", {"npsf", "npsfT", "sun"});
  b.choice(
      "environment_airlight", o.environment_airlight,
      {{"psf", Airlight::psf}, {"everywhere", Airlight::everywhere}, {"volume", Airlight::volume}},
      "light of the environment in the air: by Eq. 28 where no surface is, before surfaces too, or by slices and a "
      "grid of what arrives unscattered");
  b.integer("sky_cells", o.sky_cells, 1, 256, "cells of that grid along its longest side")
      .where("environment_airlight", {"volume"});
  b.integer("sky_directions", o.sky_directions, 1, 65536, "directions from which light arrives at its nodes")
      .where("environment_airlight", {"volume"});
  b.real("environment_distance", o.environment_distance, 0, infinity,
         "D [m]: how far the constant medium reaches to the environment");
  b.choice("average_depth", o.depth_tree, {{"tree", true}, {"exact", false}},
           "Eq. 26 on surfaces: by polynomials in cells, to eps_T, or by sums over all Gaussians");
}

void bind(scene::SettingBinder& b, Options& o) {
  using Variant = Options::Variant;
  using Upsample = Options::Upsample;
  b.choice("variant", o.variant, {{"paper", Variant::paper}, {"S", Variant::slices}},
           "paper: Zhou et al. 2007; S: slices with exact depths at their edges");
  b.integer("K", o.slices, 1, 4096, "slices of S; multiples of 8 fill whole vectors")
      .where("variant", {"S"})
      .or_where("environment_airlight", {"volume"});
  b.choice("edges", o.boxes, {{"plain", false}, {"S3", true}},
           "where S cuts: by length and lights, or by the Gaussians too")
      .where("variant", {"S"});
  b.flag("extrapolate", o.extrapolate, "S from K/2 and K slices (error K^-4 instead of K^-2); K even")
      .where("variant", {"S"});
  b.choice("light_depth", o.map, {{"map", true}, {"exact", false}},
           "depths from the lights in S: by maps, or by exact sums")
      .where("variant", {"S"});
  b.integer("map_directions", o.map_directions, 2, 2048, "a light map has this number squared of directions")
      .where("variant", {"S"})
      .where("light_depth", {"map"});
  b.integer("map_edges", o.map_edges, 1, 4096, "distances per direction of a light map")
      .where("variant", {"S"})
      .where("light_depth", {"map"});
  b.choice("homogeneous", o.table, {{"exact", false}, {"table", true}},
           "F in the paper variant: closed form, or a table of 256^2")
      .where("variant", {"paper"});
  b.choice("erf", o.erf, {{"precise", Erf::precise}, {"erf10", Erf::erf10}, {"paper", Erf::paper}},
           "error function, to 1e-12, 4e-6, or 2e-4 as printed");
  b.choice("cull", o.cull, {{"depth", Cull::depth}, {"paper", Cull::paper}},
           "radius of a Gaussian: by lost depth, or by Eq. 30");
  b.real("eps_T", o.depth_threshold, 1e-15, 1,
         "depth that culling costs per Gaussian at most, relative to the deepest below 1");
  bind_surfaces(b, o);
  b.integer("sh_order", o.sh_order, 1, 12, "bands of the NPSF and of the environment");
  bind_environment(b, o);
  b.choice("downsample", o.downsample, {{"1", 1}, {"2", 2}, {"4", 4}},
           "airlight for one ray per so many pixels to each side, section 5.4");
  b.choice("upsample", o.upsample,
           {{"bilinear", Upsample::bilinear}, {"paper", Upsample::paper}, {"recompute", Upsample::recompute}},
           "then at edges of the distance: nothing special, the most alike neighbour, or full resolution")
      .where("downsample", {"2", "4"});
  b.real("noise_scale", o.noise_scale, 0, 4,
         "how far noise bends rays, in radii of the Gaussian, section 5.5; 0: no noise");
  b.real("noise_frequency", o.noise_frequency, 1e-12, 1e12, "cells of the noise per metre; it repeats after 32")
      .where("noise_scale", {"> 0"});
  b.integer("noise_seed", o.noise_seed, 0, 4294967295.0, "of the noise's gradients").where("noise_scale", {"> 0"});
  b.real("noise_phase", o.noise_phase, -1e6, 1e6, "shift of the noise along all axes, in cells")
      .where("noise_scale", {"> 0"});
  b.real("source_radius", o.source_radius, 0, 1e300, "r_s [m]: 1/d^2 becomes 1/(d^2 + r_s^2)");
}

}  // namespace

std::vector<scene::SettingSpec> setting_specs() { return scene::list_settings(bind); }

Options read_options(const scene::Settings& settings) { return scene::read_settings(bind, settings); }

namespace {

// Light on its way through all Gaussians, one after another along their axes, loses more than on any other way.
void judge_ways(Model& model) {
  if (model.paper()) return;
  double column = 0;
  for (const scene::Gaussian& g : model.fog.sum.gaussians) column += std::sqrt(pi) * g.width * g.amplitude;
  model.taken = -std::expm1(-column);
  model.clear_ways = model.taken < 0.1 * model.options.depth_threshold;
}

// Where the maps' even grids miss what matters, sums replace them: small Gaussians in great ones, above all.
void judge_maps(Model& model, const Point3& eye) {
  Options& o = model.options;
  if (model.paper() || !o.map || model.scattered_lights() == 0 || model.clear_ways || model.gaussians.count == 0)
    return;
  for (const LightModel& light : model.lights)
    model.map_error = std::max(model.map_error, map_error(model.gaussians, light.position, eye, o.map_directions,
                                                          o.map_edges, o.erf, model.evaluations));
  o.map = !(model.map_error > greatest_map_error);
}

}  // namespace

Model make_model(const scene::Scene& scene, const Options& options) {
  Model model;
  model.options = options;
  model.fog = make_fog(scene.media);
  CulledGaussians culled =
      make_arrays(model.fog.sum.gaussians, options.cull, options.depth_threshold, model.fog.colours);
  model.gaussians = std::move(culled.arrays);
  model.dropped = culled.dropped;
  model.threshold = culled.threshold;
  if (options.noise_scale > 0 && model.gaussians.count > 0) {
    model.noise =
        std::make_unique<Noise>(options.noise_scale, options.noise_frequency, options.noise_seed, options.noise_phase);
    const double reach = noise_reach(options.noise_scale);
    for (int i = 0; i < model.gaussians.count; ++i) model.gaussians.radius_squared[i] *= reach * reach;
  }
  bool scattered = false;
  for (const scene::Light& light : scene.lights) {
    if (const auto* environment = std::get_if<scene::EnvironmentLight>(&light))
      model.environment |= !environment->sh.empty() || environment_power(*environment) > 0;
    const auto* point = std::get_if<scene::PointLight>(&light);
    if (!point || !scene::shines(light)) continue;
    model.lights.push_back({point->position, point->intensity, {}, nullptr});
    scattered = scattered || scatter(scene.media, light);
  }
  model.scatters = scattered;
  judge_ways(model);
  judge_maps(model, scene.camera.position);
  return model;
}

std::vector<double> depths_to_centers(const Model& model, const Point3& from, const scene::Execution& execution,
                                      double& evaluations) {
  const GaussianArrays& g = model.gaussians;
  const Erf erf = model.options.erf;
  std::vector<double> depths(g.count), calls(g.count);
  constexpr int chunk = 64;
  scene::parallel_for((g.count + chunk - 1) / chunk, execution, [&](int row) {
    Crossings crossings;
    for (int i = row * chunk; i < std::min(g.count, (row + 1) * chunk); ++i) {
      const Line line = line_between(from, g.center(i));
      cross(g, line, erf, crossings);
      // Gaussian i itself: the line ends at its centre. The sum is over the others, never a difference of two sums.
      for (int k = 0; k < crossings.count; ++k)
        if (crossings.place[k] == i) crossings.depth[k] = 0;
      depths[i] = total_depth(crossings, line.length, erf) + model.fog.sum.constant * line.length;
      calls[i] = 2.0 * crossings.count;
    }
  });
  evaluations += std::accumulate(calls.begin(), calls.end(), 0.0);
  return depths;
}

double gaussian_depth(const Model& model, const Point3& a, const Point3& b, Crossings& crossings, double& evaluations) {
  const Line line = line_between(a, b);
  cross(model.gaussians, line, model.options.erf, crossings);
  evaluations += 2.0 * crossings.count;
  return total_depth(crossings, line.length, model.options.erf);
}

}  // namespace airlight::fogshop
