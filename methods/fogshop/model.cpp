#include "methods/fogshop/model.h"

#include <cmath>
#include <numeric>

namespace airlight::fogshop {

std::vector<scene::SettingSpec> setting_specs() {
  using Type = scene::SettingSpec::Type;
  return {
      {"variant",
       Type::choice,
       "S",
       "paper: Zhou et al. 2007; S: K slices with exact depths at their edges",
       0,
       0,
       {"paper", "S"}},
      {"K", Type::integer, "26", "slices of variant S", 1, 4096, {}},
      {"extrapolate",
       Type::flag,
       "true",
       "S: extrapolate from K/2 and K slices (error K^-4, else K^-2); K even",
       0,
       0,
       {}},
      {"edges",
       Type::choice,
       "plain",
       "where S cuts: plain, or S3 that also looks at the Gaussians",
       0,
       0,
       {"plain", "S3"}},
      {"light_depth",
       Type::choice,
       "map",
       "depths from the lights in S: octahedral map, or exact sums",
       0,
       0,
       {"map", "exact"}},
      {"map_directions", Type::integer, "64", "the light map has this number squared of directions", 2, 2048, {}},
      {"map_edges", Type::integer, "48", "distances per direction of the light map", 1, 4096, {}},
      {"homogeneous",
       Type::choice,
       "exact",
       "F in the paper variant: closed form, or the paper's table (256^2)",
       0,
       0,
       {"exact", "table"}},
      {"erf",
       Type::choice,
       "precise",
       "error function: 1e-12, 4e-6 (erf10) or 2e-4 (the paper's polynomial)",
       0,
       0,
       {"precise", "erf10", "paper"}},
      {"cull",
       Type::choice,
       "depth",
       "radius of a Gaussian: by lost optical depth, or the paper's Eq. 30",
       0,
       0,
       {"depth", "paper"}},
      {"eps_T",
       Type::real,
       "1e-4",
       "optical depth [-] that culling may cost per Gaussian, relative to the deepest one if that is below 1",
       1e-15,
       1,
       {}},
      {"source_radius", Type::real, "0", "r_s [m]: 1/d^2 becomes 1/(d^2 + r_s^2)", 0, 1e300, {}},
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
  return o;
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
