#include "methods/fogshop/model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "methods/fogshop/map_error.h"
#include "scene/light/scattered_lights.h"

namespace airlight::fogshop {

std::vector<scene::SettingSpec> setting_specs() {
  return {
      scene::choice_setting("variant", "S", {"paper", "S"},
                            "paper: Zhou et al. 2007; S: slices with exact depths at their edges"),
      scene::integer_setting("K", "24", 1, 4096, "slices of S; multiples of 8 fill whole vectors"),
      scene::choice_setting("edges", "S3", {"plain", "S3"},
                            "where S cuts: by length and lights, or by the Gaussians too"),
      scene::flag_setting("extrapolate", true, "S from K/2 and K slices (error K^-4 instead of K^-2); K even"),
      scene::choice_setting("light_depth", "map", {"map", "exact"},
                            "depths from the lights in S: by maps, or by exact sums"),
      scene::integer_setting("map_directions", "64", 2, 2048, "a light map has this number squared of directions"),
      scene::integer_setting("map_edges", "48", 1, 4096, "distances per direction of a light map"),
      scene::choice_setting("homogeneous", "exact", {"exact", "table"},
                            "F in the paper variant: closed form, or a table of 256^2"),
      scene::choice_setting("erf", "precise", {"precise", "erf10", "paper"},
                            "error function, to 1e-12, 4e-6, or 2e-4 as printed"),
      scene::choice_setting("cull", "depth", {"depth", "paper"}, "radius of a Gaussian: by lost depth, or by Eq. 30"),
      scene::real_setting("eps_T", "1e-4", 1e-15, 1,
                          "depth that culling costs per Gaussian at most, relative to the deepest below 1"),
      scene::choice_setting(
          "reflectance", "direct", {"direct", "npsf", "npsfT", "sun"},
          "of surfaces: unscattered light alone; scattered too, by the printed NPSF, by that of the depth, or by "
          "Sun et al.'s integrals"),
      scene::flag_setting("prt", false,
                          "surfaces shadow scattered light, and that of environments, on meshes: precomputed transfer"),
      scene::integer_setting("prt_rays", "256", 16, 65536, "directions per vertex of the precomputed transfer"),
      scene::real_setting("prt_reach", "1e300", 0, 1e300,
                          "distance [m] up to which surfaces shadow in the precomputed transfer"),
      scene::integer_setting("prt_bounces", "0", 0, 16,
                             "times that surfaces reflect light onto one another in the precomputed transfer"),
      scene::integer_setting("sh_order", "6", 1, 12, "bands of the NPSF and of the environment"),
      scene::choice_setting(
          "environment_psf", "ball", {"npsf", "npsfT", "ball"},
          "spreads environment light: printed NPSF, that of the depth, or that of a ball of the depth"),
      scene::choice_setting(
          "environment_airlight", "psf", {"psf", "everywhere", "volume"},
          "light of the environment in the air: by Eq. 28 where no surface is, before surfaces too, or by slices and a "
          "grid of what arrives unscattered"),
      scene::integer_setting("sky_cells", "24", 1, 256, "cells of that grid along its longest side"),
      scene::integer_setting("sky_directions", "64", 1, 65536, "directions from which light arrives at its nodes"),
      scene::real_setting("environment_distance", "inf", 0, infinity,
                          "D [m]: how far the constant medium reaches to the environment"),
      scene::choice_setting("average_depth", "tree", {"tree", "exact"},
                            "Eq. 26 on surfaces: by polynomials in cells, to eps_T, or by sums over all Gaussians"),
      scene::choice_setting("downsample", "1", {"1", "2", "4"},
                            "airlight for one ray per so many pixels to each side, section 5.4"),
      scene::choice_setting(
          "upsample", "recompute", {"bilinear", "paper", "recompute"},
          "then at edges of the distance: nothing special, the most alike neighbour, or full resolution"),
      scene::real_setting("noise_scale", "0", 0, 4,
                          "how far noise bends rays, in radii of the Gaussian, section 5.5; 0: no noise"),
      scene::real_setting("noise_frequency", "1", 1e-12, 1e12, "cells of the noise per metre; it repeats after 32"),
      scene::integer_setting("noise_seed", "0", 0, 4294967295.0, "of the noise's gradients"),
      scene::real_setting("noise_phase", "0", -1e6, 1e6, "shift of the noise along all axes, in cells"),
      scene::real_setting("source_radius", "0", 0, 1e300, "r_s [m]: 1/d^2 becomes 1/(d^2 + r_s^2)"),
  };
}

Options read_options(const scene::Settings& settings) {
  Options o;
  o.variant = settings.choice<Options::Variant>("variant");
  o.slices = int(settings.integer("K"));
  o.extrapolate = settings.flag("extrapolate");
  o.boxes = settings.text("edges") == "S3";
  o.map = settings.text("light_depth") == "map";
  o.map_directions = int(settings.integer("map_directions"));
  o.map_edges = int(settings.integer("map_edges"));
  o.table = settings.text("homogeneous") == "table";
  o.erf = settings.choice<Erf>("erf");
  o.cull = settings.choice<Cull>("cull");
  o.depth_threshold = settings.real("eps_T");
  o.source_radius = settings.real("source_radius");
  o.reflectance = settings.choice<Options::Reflectance>("reflectance");
  o.sh_order = int(settings.integer("sh_order"));
  o.environment_psf = settings.choice<Psf>("environment_psf");
  o.environment_everywhere = settings.text("environment_airlight") == "everywhere";
  o.sky_volume = settings.text("environment_airlight") == "volume";
  o.sky_cells = int(settings.integer("sky_cells"));
  o.sky_directions = int(settings.integer("sky_directions"));
  o.depth_tree = settings.text("average_depth") == "tree";
  o.environment_distance = settings.real("environment_distance");
  o.noise_scale = settings.real("noise_scale");
  o.noise_frequency = settings.real("noise_frequency");
  o.noise_seed = std::uint32_t(settings.integer("noise_seed"));
  o.noise_phase = settings.real("noise_phase");
  o.downsample = std::stoi(settings.text("downsample"));
  o.upsample = settings.choice<Options::Upsample>("upsample");
  o.prt = settings.flag("prt");
  o.prt_rays = int(settings.integer("prt_rays"));
  o.prt_reach = settings.real("prt_reach");
  o.prt_bounces = int(settings.integer("prt_bounces"));
  return o;
}

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
