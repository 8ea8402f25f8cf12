#include "methods/fogshop/stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "methods/fogshop/domain.h"
#include "methods/fogshop/map_error.h"
#include "methods/fogshop/radiance_transfer.h"
#include "scene/light/scattered_lights.h"

namespace airlight::fogshop {
namespace {

// `few`: below this number of Gaussians a tree does not pay. `finest`: the smallest tolerance that
// rounding of the sums allows.
constexpr int few = 24;
constexpr double finest = 1e-6;

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

// Stages in the order in which they are read; a condition stands here once, beside what is said where it holds.
class List {
 public:
  struct WhyNot {
    bool holds;
    std::string reason;
  };
  // Whether the stage is kept: none of the reasons against it holds. The first that does is given, else `why`.
  bool operator()(const char* name, std::initializer_list<WhyNot> against, const std::string& why) {
    const auto first = std::find_if(against.begin(), against.end(), [](const WhyNot& reason) { return reason.holds; });
    const bool kept = first == against.end();
    stages.push_back({name, kept, kept ? why : first->reason});
    return kept;
  }
  std::vector<scene::Stage> stages;
};

std::string low_resolution_by(const Options& o, bool distances) {
  using Upsample = Options::Upsample;
  const std::string rays = fmt::format("one ray per {0} x {0} pixels, ", o.downsample);
  return rays + (!distances                         ? "bilinear: no surface, no edges"
                 : o.upsample == Upsample::bilinear ? "bilinear"
                 : o.upsample == Upsample::paper    ? "the most alike neighbour at edges"
                                                    : "edges at full resolution");
}

std::string reflected_by(const Options& o) {
  using Reflectance = Options::Reflectance;
  return o.reflectance == Reflectance::sun
             ? "Sun et al.'s integrals for Lambert and Phong, with the depth along the path"
             : fmt::format("Eq. 25, {} bands of the {}", o.sh_order,
                           o.reflectance == Reflectance::npsf ? "printed NPSF" : "NPSF of each depth");
}

// Goes through the stages, and notes what they need.
struct Planner {
  Planner(const scene::Scene& of_scene, const Model& of_model)
      : scene(of_scene),
        model(of_model),
        o(model.options),
        paper(model.paper()),
        surfaces(!scene.surfaces.empty()),
        lit(model.scattered_lights() > 0),
        shone(!model.lights.empty()),
        gaussians(model.gaussians.count > 0),
        constant(model.fog.sum.constant > 0),
        doubt(doubt_of(scene, model.fog, o)) {
    // An endless constant lets no light through from infinitely far away.
    const bool walled_in = constant && o.environment_distance == infinity;
    no_lights = {!lit, shone ? "the albedo is 0 where point lights shine" : "no point light shines"};
    no_gaussians = {!gaussians, "no Gaussian reaches the threshold"};
    no_surfaces = {!surfaces, "there are no surfaces"};
    no_medium = {!gaussians && !constant, "there is no medium"};
    dark = {!model.environment || walled_in, model.environment
                                                 ? "the constant medium has no end: none of its light arrives"
                                                 : "no environment light shines"};
    black = {(model.fog.albedo == 0).all(), "the albedo is 0"};
    direct = {o.reflectance == Options::Reflectance::direct, "reflectance = direct"};
    needs.airlight = !no_medium.holds;
  }
  void add_distances_and_medium();
  void add_depths_of_lights();
  void add_airlight();
  void add_surfaces();
  void add_environment();
  void add_environment_on_surfaces();

  const scene::Scene& scene;
  const Model& model;
  const Options& o;
  const bool paper, surfaces, lit, shone, gaussians, constant;
  const std::string doubt;
  List::WhyNot no_lights, no_gaussians, no_surfaces, no_medium, dark, black, direct;
  List stage;
  Needs needs{};
};

void Planner::add_distances_and_medium() {
  needs.distances = stage("distances",
                          {{!surfaces && !has_ball(scene) && scene.backdrops.empty(),
                            "no surface, no light with a radius, no backdrop: rays are infinite"}},
                          fmt::format("{} surfaces, balls of lights and {} backdrops end rays", scene.surfaces.size(),
                                      scene.backdrops.size()));
  const std::string of_all = fmt::format("{} of {}, the rest is below the threshold everywhere", model.gaussians.count,
                                         model.gaussians.count + model.dropped);
  stage("gaussians", {{model.fog.sum.gaussians.empty(), "the medium has none"}, {!gaussians, of_all}}, of_all);
  stage("homogeneous term", {{!constant, "the constant is 0"}, no_lights},
        paper       ? (o.table ? "Eq. 17 with the table of F" : "Eq. 17 in closed form")
        : gaussians ? "inside the slices, in closed form beyond them"
                    : "in closed form");
}

void Planner::add_depths_of_lights() {
  const std::string lights = fmt::format("{} point light{}", model.lights.size(), model.lights.size() == 1 ? "" : "s");
  if (paper)
    needs.center_depths =
        stage("depths to centres", {no_gaussians, no_lights}, fmt::format("T(s,b_i), T(v,b_i) for {}", lights));
  else
    needs.light_maps =
        stage("light maps",
              {no_gaussians,
               no_lights,
               {model.clear_ways,
                fmt::format("Gaussians take at most {:.1g} of a light, and depths from it count as 0", model.taken)},
               {model.map_error > greatest_map_error,
                fmt::format("maps would be off by {:.2g} % (estimated), more than {:g} %: sums per edge instead",
                            100 * model.map_error, 100 * greatest_map_error)},
               {!o.map, "light_depth = exact: sums per edge instead"}},
              fmt::format("{0}^2 directions x {1} distances for {2}, error {3:.2g} % (estimated)", o.map_directions,
                          o.map_edges, lights, 100 * model.map_error));
  if (o.table) needs.f_table = stage("table of F", {{!(paper && lit && constant), "nothing reads it"}}, "asked for");
}

void Planner::add_airlight() {
  stage("airlight of Gaussians", {no_gaussians, no_lights},
        paper ? "Eqs. 8 to 17" : fmt::format("{} slices{}", o.slices, o.extrapolate ? ", extrapolated from half" : ""));
  stage("colour", {{model.fog.grey(), "the extinction is grey: one channel for all"}},
        "depths once, exponentials per channel");
  if (!doubt.empty()) stage("doubt", {}, doubt);
  needs.low_resolution = stage("low resolution", {no_medium, {o.downsample == 1, "downsample = 1"}},
                               low_resolution_by(o, needs.distances));
  stage("colours of scattering", {{model.fog.one_albedo(), "one albedo for all"}, no_lights},
        "one per Gaussian: it scales what scatters, not what extinguishes");
  stage("noise", {{!(o.noise_scale > 0), "noise_scale = 0"}, no_gaussians},
        fmt::format("rays bent by up to {:g} radii", o.noise_scale));
}

void Planner::add_surfaces() {
  needs.surfaces = stage("surfaces", {{!surfaces, "there are none"}, {!shone && dark.holds, "no light reaches them"}},
                         "direct light through the medium, Eq. 29");
  stage("ambient in-scatter",
        {{(scene.ambient_in_scatter > 0).any(), "the method has none: its airlight is that of the lights"},
         {true, "the scene has none"}},
        "");
  needs.scattered = needs.surfaces && !no_medium.holds && !direct.holds && !black.holds;
  needs.point_harmonics =
      stage("airlight reflected by surfaces", {no_surfaces, no_lights, no_medium, direct}, reflected_by(o));
  const double vertices = mesh_vertices(scene);
  needs.transfer =
      stage("radiance transfer",
            {{!o.prt, "prt = false: occluders shadow direct light of points alone"},
             {!needs.point_harmonics && dark.holds, "no light that it would shadow"},
             {vertices == 0, "there are no meshes, and other shapes have no vertices"}},
            fmt::format("{} rays from each of {:.0f} vertices, {} bands, light reflected {} times between surfaces",
                        o.prt_rays, vertices, o.sh_order, o.prt_bounces));
}

void Planner::add_environment() {
  needs.environment = stage("background", {dark}, "the environment through the medium, Eq. 29, where no surface is");
  needs.sky_volume = needs.environment && gaussians && o.sky_volume() && !black.holds;
  const bool by_psf = needs.environment && needs.airlight && !needs.sky_volume && !black.holds;
  stage(
      "shadows of surfaces in the medium",
      {no_surfaces, {!needs.sky_volume, "the method does not know them: airlight behind an occluder is not darkened"}},
      "of the sky, at the nodes of the grid; light of points is not darkened");
  needs.environment_psf = by_psf || (needs.environment && needs.scattered);
  needs.environment_harmonics =
      stage("harmonics of the environment", {dark, {!by_psf && !surfaces, "nothing reads them"}},
            fmt::format("{} bands", o.sh_order));
  needs.environment_airlight =
      stage("airlight of the environment", {dark, no_medium, black},
            needs.sky_volume ? fmt::format("{} slices, a grid of {} cells along its longest side, {} directions",
                                           o.slices, o.sky_cells, o.sky_directions)
                             : fmt::format("Eq. 28, {}, {}", psf_name(o.environment_psf),
                                           o.everywhere() ? "before surfaces too" : "where no surface is"));
}

void Planner::add_environment_on_surfaces() {
  const bool sky_on_surfaces =
      stage("environment on surfaces", {no_surfaces, dark},
            no_medium.holds    ? "no medium is in the way"
            : !needs.scattered ? "Eq. 27 without what is scattered"
                               : fmt::format("Eqs. 26 and 27, {}", psf_name(o.environment_psf)));
  needs.depth_tree =
      stage("tree of average depths",
            {{!sky_on_surfaces || !gaussians, "nothing reads it"},
             {!o.depth_tree, "average_depth = exact: sums over all Gaussians"},
             {model.gaussians.count < few, fmt::format("fewer than {} Gaussians: their sum is as fast", few)},
             {o.depth_threshold < finest, fmt::format("eps_T is below {}: sums over all Gaussians", finest)}},
            fmt::format("Eq. 26 by polynomials in cells around the surfaces, to {:.2g}", model.threshold));
  needs.reflectances = sky_on_surfaces || (needs.point_harmonics && o.reflectance != Options::Reflectance::sun);
}

}  // namespace

Plan make_plan(const scene::Scene& scene, const Model& model) {
  Planner plan(scene, model);
  plan.add_distances_and_medium();
  plan.add_depths_of_lights();
  plan.add_airlight();
  plan.add_surfaces();
  plan.add_environment();
  plan.add_environment_on_surfaces();
  return {plan.needs, std::move(plan.stage.stages), plan.doubt};
}

std::string unsupported_view(const scene::Scene& scene, const Fog& fog, const Options& options,
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
