#include "methods/fogshop/stages.h"

#include <fmt/format.h>

#include <algorithm>

#include "methods/fogshop/domain.h"
#include "methods/fogshop/radiance_transfer.h"

namespace airlight::fogshop {
namespace {

bool has_ball(const scene::Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const scene::Light& light) {
    const auto ball = scene::ball(light);
    return ball && ball->radius > 0;
  });
}

const char* psf_name(Psf psf) {
  return psf == Psf::npsf            ? "the printed NPSF"
         : psf == Psf::npsf_by_depth ? "the NPSF of each depth"
                                     : "the PSF of a ball of each depth";
}

// An endless constant lets no light through from infinitely far away.
bool walled_in(const Model& model) {
  return model.fog.sum.constant > 0 && model.options.environment_distance == infinity;
}

}  // namespace

Needs needs_of(const scene::Scene& scene, const Model& model) {
  const bool lit = !model.lights.empty(), gaussians = model.gaussians.count > 0, constant = model.fog.sum.constant > 0;
  Needs needs;
  needs.distances = !scene.surfaces.empty() || has_ball(scene);
  needs.center_depths = model.paper() && lit && gaussians;
  needs.light_maps = !model.paper() && model.options.map && lit && gaussians;
  needs.f_table = model.paper() && model.options.table && lit && constant;
  needs.airlight = gaussians || constant;
  needs.environment = model.environment && !walled_in(model);
  needs.surfaces = !scene.surfaces.empty() && (lit || needs.environment);
  needs.low_resolution = needs.airlight && model.options.downsample > 1;
  needs.scattered = needs.surfaces && needs.airlight && model.options.reflectance != Options::Reflectance::direct;
  needs.point_harmonics = needs.scattered && lit;
  needs.environment_airlight = needs.environment && needs.airlight;
  needs.sky_volume = needs.environment_airlight && model.options.sky_volume && gaussians;
  needs.environment_psf = (needs.environment_airlight && !needs.sky_volume) || (needs.environment && needs.scattered);
  needs.environment_harmonics = needs.environment && (needs.environment_psf || needs.surfaces);
  needs.reflectances = (needs.point_harmonics && model.options.reflectance != Options::Reflectance::sun) ||
                       (needs.environment && needs.surfaces);
  needs.transfer =
      model.options.prt && needs.surfaces && (needs.point_harmonics || needs.environment) && mesh_vertices(scene) > 0;
  return needs;
}

std::vector<scene::Stage> describe_stages(const scene::Scene& scene, const Model& model) {
  const Needs needs = needs_of(scene, model);
  const Options& o = model.options;
  const std::string lights = fmt::format("{} point light{}", model.lights.size(), model.lights.size() == 1 ? "" : "s");
  const std::string no_lights = "no point light shines";
  const std::string no_gaussians = "no Gaussian reaches the threshold";
  const bool lit = !model.lights.empty(), constant = model.fog.sum.constant > 0, gaussians = model.gaussians.count > 0;
  const auto unlit_or = [&](const std::string& otherwise) { return lit ? otherwise : no_lights; };
  std::vector<scene::Stage> stages;
  const auto stage = [&](const char* name, bool kept, const std::string& reason) {
    stages.push_back({name, kept, reason});
  };
  stage("distances", needs.distances,
        needs.distances ? fmt::format("{} surfaces and the balls of the lights end rays", scene.surfaces.size())
                        : "no surface and no light with a radius: rays are infinite");
  stage("gaussians", gaussians,
        model.fog.sum.gaussians.empty() ? "the medium has none"
                                        : fmt::format("{} of {}, the rest is below the threshold everywhere",
                                                      model.gaussians.count, model.gaussians.count + model.dropped));
  stage("homogeneous term", needs.airlight && constant && lit,
        !constant ? "the constant is 0"
                  : unlit_or(model.paper()
                                 ? (o.table ? "Eq. 17 with the table of F" : "Eq. 17 in closed form")
                                 : (gaussians ? "inside the slices, in closed form beyond them" : "in closed form")));
  if (model.paper())
    stage("depths to centres", needs.center_depths,
          !gaussians ? no_gaussians : unlit_or(fmt::format("T(s,b_i), T(v,b_i) for {}", lights)));
  else
    stage("light maps", needs.light_maps,
          !gaussians ? no_gaussians
                     : unlit_or(o.map ? fmt::format("{0}^2 directions x {1} distances for {2}", o.map_directions,
                                                    o.map_edges, lights)
                                      : "light_depth = exact: sums per edge instead"));
  if (o.table) stage("table of F", needs.f_table, needs.f_table ? "asked for" : "nothing reads it");
  stage("airlight of Gaussians", gaussians && lit,
        !gaussians ? no_gaussians
                   : unlit_or(model.paper() ? "Eqs. 8 to 17"
                                            : fmt::format("{} slices{}", o.slices,
                                                          o.extrapolate ? ", extrapolated from half" : "")));
  stage("colour", !model.fog.grey(),
        model.fog.grey() ? "the extinction is grey: one channel for all" : "depths once, exponentials per channel");
  if (const std::string doubt = doubt_of(scene, model.fog, o); !doubt.empty()) stage("doubt", true, doubt);
  using Upsample = Options::Upsample;
  stage("low resolution", needs.low_resolution,
        !needs.airlight     ? "there is no medium"
        : o.downsample == 1 ? "downsample = 1"
        : !needs.distances  ? fmt::format("one ray per {0} x {0} pixels, bilinear: no surface, no edges", o.downsample)
        : o.upsample == Upsample::bilinear ? fmt::format("one ray per {0} x {0} pixels, bilinear", o.downsample)
        : o.upsample == Upsample::paper
            ? fmt::format("one ray per {0} x {0} pixels, the most alike neighbour at edges", o.downsample)
            : fmt::format("one ray per {0} x {0} pixels, edges at full resolution", o.downsample));
  stage("colours of scattering", lit && !model.fog.one_albedo(),
        model.fog.one_albedo() ? "one albedo for all"
                               : unlit_or("one per Gaussian: it scales what scatters, not what extinguishes"));
  stage("noise", model.noise != nullptr,
        model.noise         ? fmt::format("rays bent by up to {:g} radii", o.noise_scale)
        : o.noise_scale > 0 ? no_gaussians
                            : "noise_scale = 0");
  stage("surfaces", needs.surfaces,
        scene.surfaces.empty() ? "there are none"
        : needs.surfaces       ? "direct light through the medium, Eq. 29"
                               : "no light reaches them");
  stage("ambient in-scatter", false,
        (scene.ambient_in_scatter > 0).any() ? "the method has none: its airlight is that of the lights"
                                             : "the scene has none");
  stage("shadows of surfaces in the medium", false,
        scene.surfaces.empty() ? "there are no surfaces"
                               : "the method does not know them: airlight behind an occluder is not darkened");
  stage("airlight reflected by surfaces", needs.point_harmonics,
        scene.surfaces.empty()                          ? "there are no surfaces"
        : !lit                                          ? no_lights
        : !needs.airlight                               ? "there is no medium"
        : o.reflectance == Options::Reflectance::direct ? "reflectance = direct"
        : o.reflectance == Options::Reflectance::npsf ? fmt::format("Eq. 25, {} bands of the printed NPSF", o.sh_order)
        : o.reflectance == Options::Reflectance::sun
            ? "Sun et al.'s integrals for Lambert and Phong, with the depth along the path"
            : fmt::format("Eq. 25, {} bands of the NPSF of each depth", o.sh_order));
  stage("radiance transfer", needs.transfer,
        !o.prt                                         ? "prt = false: occluders shadow direct light of points alone"
        : !needs.point_harmonics && !needs.environment ? "no light that it would shadow"
        : !needs.transfer                              ? "there are no meshes, and other shapes have no vertices"
                          : fmt::format("{} rays from each of {:.0f} vertices, {} bands", o.prt_rays,
                                        mesh_vertices(scene), o.sh_order));
  const std::string no_environment = !model.environment ? "no environment light shines"
                                     : walled_in(model) ? "the constant medium has no end: none of its light arrives"
                                                        : "";
  const auto unless_dark = [&](const std::string& otherwise) {
    return no_environment.empty() ? otherwise : no_environment;
  };
  stage("background", needs.environment,
        unless_dark("the environment through the medium, Eq. 29, where no surface is"));
  stage("harmonics of the environment", needs.environment_harmonics,
        unless_dark(needs.environment_harmonics ? fmt::format("{} bands", o.sh_order) : "nothing reads them"));
  stage("airlight of the environment", needs.environment_airlight,
        unless_dark(!needs.airlight ? "there is no medium"
                    : needs.sky_volume
                        ? fmt::format("{} slices, a grid of {} cells along its longest side, {} directions", o.slices,
                                      o.sky_cells, o.sky_directions)
                        : fmt::format("Eq. 28, {}, {}", psf_name(o.environment_psf),
                                      o.environment_everywhere ? "before surfaces too" : "where no surface is")));
  stage("environment on surfaces", needs.environment && needs.surfaces,
        scene.surfaces.empty()
            ? "there are no surfaces"
            : unless_dark(!needs.airlight    ? "no medium is in the way"
                          : !needs.scattered ? "Eq. 27 without what is scattered: reflectance = direct"
                                             : fmt::format("Eqs. 26 and 27, {}", psf_name(o.environment_psf))));
  return stages;
}

std::string objection_to_view(const scene::Scene& scene, const Fog& fog, const Options& options,
                              const scene::Camera& camera) {
  if (camera.kind != scene::Camera::Kind::perspective)
    return options.variant == Options::Variant::paper
               ? "variant paper needs a perspective camera: its depths T(v, b_i) start from one view point"
               : "";
  if (options.source_radius > 0) return "";
  // A light without extent at the camera, inside the medium, is infinitely bright.
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto ball = scene::ball(scene.lights[i]);
    if (ball && ball->center == camera.position && density(fog.sum, camera.position) > 0)
      return fmt::format("light {} is at the camera inside the medium: its airlight is infinite (source_radius = 0)",
                         i);
  }
  return "";
}

}  // namespace airlight::fogshop
