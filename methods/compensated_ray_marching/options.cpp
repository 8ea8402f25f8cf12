#include "methods/compensated_ray_marching/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/base/error.h"
#include "scene/light/background.h"
#include "scene/media/fitted.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr int most_paper_gaussians = 4096;               // the diffusion system is dense
constexpr double most_left_out = 0.6 * 0.6 * 0.6 * 0.6;  // of a phase function: its first moment without a band

std::vector<std::string> unsupported_medium(const scene::Scene& scene, std::size_t i, const Options& o) {
  const bool paper = o.variant == Options::Variant::paper;
  std::vector<std::string> reasons;
  const scene::Medium& medium = scene.media[i];
  const std::string name = label(scene.media, i);
  if (bounding_box(medium).size().maxCoeff() == infinity) reasons.push_back(name + " has no end");
  if (!paper) return reasons;
  if (const std::string why = scene::unknown_field<scene::GaussianSum, scene::FittedPointer>(scene.media, i);
      !why.empty()) {
    reasons.push_back(why + "; variant = paper");
    return reasons;
  }
  const auto* fitted = std::get_if<scene::FittedPointer>(&medium.field);
  const scene::GaussianSum& sum = fitted ? (*fitted)->gaussians : std::get<scene::GaussianSum>(medium.field);
  if (std::any_of(sum.gaussians.begin(), sum.gaussians.end(), [](const scene::Gaussian& g) { return g.amplitude < 0; }))
    reasons.push_back(name +
                      " has a Gaussian of negative amplitude; variant = paper interpolates with them as weights");
  if (sum.constant > 0) reasons.push_back(name + " has a constant density; variant = paper has none");
  if (o.paper.multiple != Options::Paper::Multiple::none && (medium.albedo == 1 && medium.sigma_t > 0).any())
    reasons.push_back(
        name +
        " has albedo 1, for which the closed system of variant = paper is singular: variant = grid, or multiple = none");
  if (sum.gaussians.size() > most_paper_gaussians)
    reasons.push_back(name + " has more Gaussians than variant = paper solves for");
  if (!std::holds_alternative<scene::Unbounded>(medium.region) && !fitted)
    reasons.push_back(name + " is cut off by a region; variant = paper knows none");
  return reasons;
}

}  // namespace

namespace {

// Options as they are given, where `auto` or 0 leaves a choice to the others.
struct Given {
  enum class Multiple { automatic, none, ordinates, p1, as_printed, corrected };
  Multiple multiple = Multiple::automatic;
  std::optional<SliceWeight> weight;
  int ordinate_levels = 0, azimuths = 0;
  Options options;
};

void bind_grid(scene::SettingBinder& b, Given& given) {
  Options::Grid& grid = given.options.grid;
  b.integer("levels", grid.levels, 2, 32,
            "of grid: L x 2L directions that light is gathered from, bands of the environment")
      .where("variant", {"grid"});
  b.integer("cells", grid.cells, 1, 96, "of grid: cells along the longest side of the smoke")
      .where("variant", {"grid"});
  b.real("deepest_cell", grid.deepest_cell, 0.01, 1e9,
         "of grid: optical depth; where cells are deeper they are made smaller")
      .where("variant", {"grid"});
  b.integer("ordinate_levels", given.ordinate_levels, 0, 16,
            "of ordinates: levels on either side of the horizontal; 0: as many as the order needs, half of it")
      .where("variant", {"grid"})
      .where("multiple", {"auto", "ordinates"});
  b.integer("azimuths", given.azimuths, 0, 64,
            "of ordinates: directions on a level; 0: as many as the order needs, twice of it")
      .where("variant", {"grid"})
      .where("multiple", {"auto", "ordinates"});
}

void bind_paper(scene::SettingBinder& b, Options::Paper& paper) {
  using Solver = LeastSquaresSolver;
  b.choice("transmittance", paper.transmittance,
           {{"ol", Transmittance::paper_linear},
            {"hyb", Transmittance::paper_squared},
            {"series", Transmittance::series},
            {"directional", Transmittance::directional}},
           "of paper: exponential of depths in harmonics; directional: exact depths in fixed directions")
      .where("variant", {"paper"});
  b.choice("solver", paper.solver,
           {{"cg", Solver::cg},
            {"cg_scaled", Solver::cg_scaled},
            {"lsqr", Solver::lsqr},
            {"lsqr_scaled", Solver::lsqr_scaled}},
           "of paper's diffusion system: conjugate gradients on the normal equations, or LSQR; scaled: of "
           "rows of length 1")
      .where("variant", {"paper"});
  b.integer("mesh_spheres", paper.mesh_spheres, 0, 1000,
            "of paper: spheres that stand for a mesh which casts shadows; 0: meshes cast none")
      .where("variant", {"paper"});
}

void bind(scene::SettingBinder& b, Given& given) {
  using Variant = Options::Variant;
  using Multiple = Given::Multiple;
  Options& o = given.options;
  b.choice("variant", o.variant, {{"grid", Variant::grid}, {"paper", Variant::paper}},
           "where source radiance is known: at the nodes of a grid, of any medium with an end; at the "
           "centres of Gaussians, as published");
  b.integer("order", o.order, 1, 6, "bands of spherical harmonics of source radiance");
  b.choice("multiple", given.multiple,
           {{"auto", Multiple::automatic},
            {"none", Multiple::none},
            {"ordinates", Multiple::ordinates},
            {"p1", Multiple::p1},
            {"as_printed", Multiple::as_printed},
            {"corrected", Multiple::corrected}},
           "multiple scattering: by discrete ordinates or diffusion (grid); by the diffusion system as printed or "
           "corrected (paper); auto is ordinates, as_printed");
  b.integer("slices", o.slices, 1, 65536, "slices along the longest side of the smoke");
  b.choice("slice_weight", given.weight,
           {{"auto", std::nullopt},
            {"printed", SliceWeight::printed},
            {"paper", SliceWeight::paper},
            {"exact", SliceWeight::exact}},
           "how much of a slice's light is seen: depth without the slope of the ray, depth, 1 - exp(-depth); "
           "auto is exact, paper");
  b.flag("residual", o.residual, "with what the Gaussians leave of fitted smoke; false: the Gaussians alone");
  b.choice("residual_store", o.paper.store,
           {{"auto", ResidualStore::automatic},
            {"grid", ResidualStore::grid},
            {"bricks", ResidualStore::bricks},
            {"hash", ResidualStore::hash}},
           "of paper, where it is looked up: a grid of all samples, bricks of 8 bits, a perfect hash of 8 bits; "
           "auto is grid, on a device bricks")
      .where("variant", {"paper"});
  b.real("tolerance", o.tolerance, 1e-12, 1, "of multiple scattering, relative");
  b.integer("iterations", o.iterations, 1, 100000, "of multiple scattering, at most");
  bind_grid(b, given);
  bind_paper(b, o.paper);
}

}  // namespace

std::vector<scene::SettingSpec> option_settings() { return scene::list_settings(bind); }

Options read_options(const scene::Settings& settings) {
  using Multiple = Given::Multiple;
  const Given given = scene::read_settings(bind, settings);
  Options o = given.options;
  const bool paper = o.variant == Options::Variant::paper;
  o.grid.multiple = given.multiple == Multiple::none ? Options::Grid::Multiple::none
                    : given.multiple == Multiple::p1 ? Options::Grid::Multiple::p1
                                                     : Options::Grid::Multiple::ordinates;
  o.paper.multiple = given.multiple == Multiple::none        ? Options::Paper::Multiple::none
                     : given.multiple == Multiple::corrected ? Options::Paper::Multiple::corrected
                                                             : Options::Paper::Multiple::as_printed;
  o.weight = given.weight.value_or(paper ? SliceWeight::paper : SliceWeight::exact);
  o.grid.ordinate_levels = given.ordinate_levels > 0 ? given.ordinate_levels : std::max(2, (o.order + 1) / 2);
  o.grid.azimuths = given.azimuths > 0 ? given.azimuths : std::max(8, 2 * o.order);
  const bool of_grid = given.multiple == Multiple::ordinates || given.multiple == Multiple::p1,
             of_paper = given.multiple == Multiple::as_printed || given.multiple == Multiple::corrected;
  if (paper ? of_grid : of_paper)
    throw Error("multiple = " + settings.text("multiple") + " is not for variant = " + settings.text("variant"));
  return o;
}

std::vector<std::string> unsupported(const scene::Scene& scene, const Options& o) {
  const bool paper = o.variant == Options::Variant::paper;
  std::vector<std::string> reasons;
  int media = 0;
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    if (!extinguishes(scene.media[i])) continue;
    ++media;
    const std::vector<std::string> some = unsupported_medium(scene, i, o);
    reasons.insert(reasons.end(), some.begin(), some.end());
  }
  if (media > 1) reasons.push_back("more than one medium");
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string why =
        paper ? scene::unknown_light<scene::EnvironmentLight>(scene.lights, i)
              : scene::unknown_light<scene::EnvironmentLight, scene::DirectionalLight>(scene.lights, i);
    if (!why.empty()) reasons.push_back(why + (paper ? "; variant = paper" : ""));
  }
  if (o.variant == Options::Variant::grid && o.grid.multiple == Options::Grid::Multiple::p1 && scene.geometry)
    reasons.push_back("surfaces; multiple = p1 diffuses light through them");
  for (std::size_t i = 0; paper && i < scene.surfaces.size(); ++i) {
    const scene::Surface& surface = scene.surfaces[i];
    const std::string name = surface.name.empty() ? fmt::format("{}", i) : "'" + surface.name + "'";
    if (!std::holds_alternative<scene::Lambert>(surface.material))
      reasons.push_back("surface " + name + " does not reflect as Lambert's; variant = paper");
  }
  return reasons;
}

std::string doubt_of(const scene::Scene& scene, const Options& o, bool again) {
  const bool paper = o.variant == Options::Variant::paper;
  std::vector<std::string> doubts;
  for (const scene::Medium& medium : scene.media) {
    if (!extinguishes(medium) || !(medium.albedo > 0).any()) continue;
    const auto look_at = [&](const char* what, const char* setting, int bands) {
      const double left_out = std::abs(phase_moments(medium.phase, bands + 1).back());
      if (left_out > most_left_out * (1 + 1e-12))
        doubts.push_back(fmt::format("{} leaves out moments of the phase function from {:.2g} down with {} = {}", what,
                                     left_out, setting, bands));
    };
    if (paper)
      look_at("source radiance", "order", o.order);
    else if (scene::has_environment(scene))
      look_at("single scattering of environments", "levels", o.grid.levels);
    if (!paper && again) look_at("multiple scattering", "order", o.order);
  }
  if (doubts.empty()) return "";
  return fmt::format("{} (expected: {:.2g}, |g| = 0.6 at order 4)", fmt::join(doubts, "; "), most_left_out);
}

}  // namespace airlight::compensated_ray_marching
