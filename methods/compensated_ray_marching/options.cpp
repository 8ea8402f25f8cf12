#include "methods/compensated_ray_marching/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

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

std::vector<scene::SettingSpec> option_settings() {
  using namespace scene;
  return {
      choice_setting("variant", "grid", {"grid", "paper"},
                     "where source radiance is known: at the nodes of a grid, of any medium with an end; at the "
                     "centres of Gaussians, as published"),
      integer_setting("order", "4", 1, 6, "bands of spherical harmonics of source radiance"),
      choice_setting(
          "multiple", "auto", {"auto", "none", "ordinates", "p1", "as_printed", "corrected"},
          "multiple scattering: by discrete ordinates or diffusion (grid); by the diffusion system as printed or "
          "corrected (paper); auto is ordinates, as_printed"),
      integer_setting("slices", "256", 1, 65536, "slices along the longest side of the smoke"),
      choice_setting("slice_weight", "auto", {"auto", "printed", "paper", "exact"},
                     "how much of a slice's light is seen: depth without the slope of the ray, depth, 1 - exp(-depth); "
                     "auto is exact, paper"),
      flag_setting("residual", true, "with what the Gaussians leave of fitted smoke; false: the Gaussians alone"),
      choice_setting("residual_store", "auto", {"auto", "grid", "bricks", "hash"},
                     "of paper, where it is looked up: a float a sample, bricks of 8 bits, a perfect hash of 8 bits; "
                     "auto is grid, on a device, which has no grid, bricks")
          .where("variant", {"paper"}),
      real_setting("tolerance", "2e-4", 1e-12, 1, "of multiple scattering, relative"),
      integer_setting("iterations", "200", 1, 100000, "of multiple scattering, at most"),
      integer_setting("levels", "8", 2, 32,
                      "of grid: L x 2L directions that light is gathered from, bands of the environment")
          .where("variant", {"grid"}),
      integer_setting("cells", "32", 1, 96, "of grid: cells along the longest side of the smoke")
          .where("variant", {"grid"}),
      real_setting("deepest_cell", "1.5", 0.01, 1e9,
                   "of grid: optical depth; where cells are deeper they are made smaller")
          .where("variant", {"grid"}),
      integer_setting(
          "ordinate_levels", "0", 0, 16,
          "of ordinates: levels on either side of the horizontal; 0: as many as the order needs, half of it")
          .where("variant", {"grid"})
          .where("multiple", {"auto", "ordinates"}),
      integer_setting("azimuths", "0", 0, 64,
                      "of ordinates: directions on a level; 0: as many as the order needs, twice of it")
          .where("variant", {"grid"})
          .where("multiple", {"auto", "ordinates"}),
      choice_setting("transmittance", "hyb", {"ol", "hyb", "series", "directional"},
                     "of paper: exponential of depths in harmonics; directional: exact depths in fixed directions")
          .where("variant", {"paper"}),
      choice_setting("solver", "cg", {"cg", "cg_scaled", "lsqr", "lsqr_scaled"},
                     "of paper's diffusion system: conjugate gradients on the normal equations, or LSQR; scaled: of "
                     "rows of length 1")
          .where("variant", {"paper"}),
      integer_setting("mesh_spheres", "32", 0, 1000,
                      "of paper: spheres that stand for a mesh which casts shadows; 0: meshes cast none")
          .where("variant", {"paper"}),
  };
}

Options read_options(const scene::Settings& settings) {
  Options o;
  o.variant = settings.choice<Options::Variant>("variant");
  const bool paper = o.variant == Options::Variant::paper;
  o.order = int(settings.integer("order"));
  const std::string &multiple = settings.text("multiple"), &weight = settings.text("slice_weight");
  o.grid.multiple = multiple == "none" ? Options::Grid::Multiple::none
                    : multiple == "p1" ? Options::Grid::Multiple::p1
                                       : Options::Grid::Multiple::ordinates;
  o.paper.multiple = multiple == "none"        ? Options::Paper::Multiple::none
                     : multiple == "corrected" ? Options::Paper::Multiple::corrected
                                               : Options::Paper::Multiple::as_printed;
  o.weight = weight == "printed"                                ? SliceWeight::printed
             : weight == "paper" || (weight == "auto" && paper) ? SliceWeight::paper
                                                                : SliceWeight::exact;
  o.slices = int(settings.integer("slices"));
  o.residual = settings.flag("residual");
  o.tolerance = settings.real("tolerance");
  o.iterations = int(settings.integer("iterations"));
  o.grid.levels = int(settings.integer("levels"));
  o.grid.cells = int(settings.integer("cells"));
  o.grid.deepest_cell = settings.real("deepest_cell");
  const long long levels = settings.integer("ordinate_levels"), azimuths = settings.integer("azimuths");
  o.grid.ordinate_levels = levels > 0 ? int(levels) : std::max(2, (o.order + 1) / 2);
  o.grid.azimuths = azimuths > 0 ? int(azimuths) : std::max(8, 2 * o.order);
  o.paper.transmittance = settings.choice<Transmittance>("transmittance");
  o.paper.store = settings.choice<ResidualStore>("residual_store");
  o.paper.solver = settings.choice<LeastSquaresSolver>("solver");
  o.paper.mesh_spheres = int(settings.integer("mesh_spheres"));
  const bool of_grid = multiple == "ordinates" || multiple == "p1",
             of_paper = multiple == "as_printed" || multiple == "corrected";
  if (paper ? of_grid : of_paper)
    throw Error("multiple = " + multiple + " is not for variant = " + settings.text("variant"));
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
