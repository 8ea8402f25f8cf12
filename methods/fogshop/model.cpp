#include "methods/fogshop/model.h"

#include <cmath>
#include <numeric>

namespace airlight::fogshop {
namespace {

using Type = scene::SettingSpec::Type;

scene::SettingSpec choice(const char* name, const char* fallback, std::vector<std::string> choices, const char* doc) {
  return {name, Type::choice, fallback, doc, 0, 0, std::move(choices)};
}

scene::SettingSpec integer(const char* name, const char* fallback, double least, double greatest, const char* doc) {
  return {name, Type::integer, fallback, doc, least, greatest, {}};
}

scene::SettingSpec real(const char* name, const char* fallback, double least, double greatest, const char* doc) {
  return {name, Type::real, fallback, doc, least, greatest, {}};
}

}  // namespace

std::vector<scene::SettingSpec> setting_specs() {
  return {
      choice("variant", "S", {"paper", "S"}, "paper: Zhou et al. 2007; S: slices with exact depths at their edges"),
      integer("K", "24", 1, 4096, "slices of S; multiples of 8 fill whole vectors"),
      choice("edges", "S3", {"plain", "S3"}, "where S cuts: by length and lights, or by the Gaussians too"),
      {"extrapolate", Type::flag, "true", "S from K/2 and K slices (error K^-4 instead of K^-2); K even", 0, 0, {}},
      choice("light_depth", "map", {"map", "exact"}, "depths from the lights in S: by maps, or by exact sums"),
      integer("map_directions", "64", 2, 2048, "a light map has this number squared of directions"),
      integer("map_edges", "48", 1, 4096, "distances per direction of a light map"),
      choice("homogeneous", "exact", {"exact", "table"}, "F in the paper variant: closed form, or a table of 256^2"),
      choice("erf", "precise", {"precise", "erf10", "paper"}, "error function, to 1e-12, 4e-6, or 2e-4 as printed"),
      choice("cull", "depth", {"depth", "paper"}, "radius of a Gaussian: by lost depth, or by Eq. 30"),
      real("eps_T", "1e-4", 1e-15, 1, "depth that culling costs per Gaussian at most, relative to the deepest below 1"),
      choice("reflectance", "direct", {"direct", "npsf", "npsfT", "sun"},
             "of surfaces: unscattered light alone; scattered too, by the printed NPSF, by that of the depth, or by "
             "Sun et al.'s integrals"),
      integer("sh_order", "6", 1, 12, "bands of the NPSF"),
      {"prt", Type::flag, "false", "surfaces shadow the light scattered onto meshes: precomputed transfer", 0, 0, {}},
      integer("prt_rays", "256", 16, 65536, "directions per vertex of the precomputed transfer"),
      real("prt_reach", "1e300", 0, 1e300, "distance [m] up to which surfaces shadow in the precomputed transfer"),
      real("source_radius", "0", 0, 1e300, "r_s [m]: 1/d^2 becomes 1/(d^2 + r_s^2)"),
  };
}

Options read_options(const scene::Settings& settings) {
  Options o;
  o.variant = settings.text("variant") == "paper" ? Options::Variant::paper : Options::Variant::slices;
  o.slices = int(settings.integer("K"));
  o.extrapolate = settings.flag("extrapolate");
  o.boxes = settings.text("edges") == "S3";
  o.map = settings.text("light_depth") == "map";
  o.map_directions = int(settings.integer("map_directions"));
  o.map_edges = int(settings.integer("map_edges"));
  o.table = settings.text("homogeneous") == "table";
  const std::string& erf = settings.text("erf");
  o.erf = erf == "precise" ? Erf::precise : erf == "erf10" ? Erf::erf10 : Erf::paper;
  o.cull = settings.text("cull") == "paper" ? Cull::paper : Cull::depth;
  o.depth_threshold = settings.real("eps_T");
  o.source_radius = settings.real("source_radius");
  const std::string& reflectance = settings.text("reflectance");
  using Reflectance = Options::Reflectance;
  o.reflectance = reflectance == "direct" ? Reflectance::direct
                  : reflectance == "npsf" ? Reflectance::npsf
                  : reflectance == "sun"  ? Reflectance::sun
                                          : Reflectance::npsf_by_depth;
  o.sh_order = int(settings.integer("sh_order"));
  o.prt = settings.flag("prt");
  o.prt_rays = int(settings.integer("prt_rays"));
  o.prt_reach = settings.real("prt_reach");
  return o;
}

Model make_model(const scene::Scene& scene, const Options& options) {
  Model model;
  model.options = options;
  model.fog = make_fog(scene.media);
  CulledGaussians culled = make_arrays(model.fog.sum.gaussians, options.cull, options.depth_threshold);
  model.gaussians = std::move(culled.arrays);
  model.dropped = culled.dropped;
  for (const scene::Light& light : scene.lights) {
    const auto& point = std::get<scene::PointLight>(light);
    if ((point.intensity > 0).any()) model.lights.push_back({point.position, point.intensity, {}, nullptr});
  }
  return model;
}

std::vector<double> depths_to_centers(const Model& model, const Point3& from, const scene::Execution& execution,
                                      double& evaluations) {
  const GaussianArrays& g = model.gaussians;
  const Erf erf = model.options.erf;
  std::vector<double> depths(g.count), calls(g.count);
  constexpr int chunk = 64;
  scene::parallel_rows((g.count + chunk - 1) / chunk, execution, [&](int row) {
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
