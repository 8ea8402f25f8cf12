#include "methods/legendre_fluids/light_options.h"

#include <algorithm>
#include <optional>

#include "methods/legendre_fluids/paper_picture.h"
#include "scene/light/background.h"
#include "scene/light/scattered_lights.h"
#include "scene/light/sky_directions.h"

namespace airlight::legendre_fluids {
namespace {

constexpr int least_gmres = 5;  // coefficients along an axis from which on GMRES is faster than dense factors

bool scatters(const scene::Scene& scene) { return scene::why_nothing_scatters(scene).empty(); }

// Options as they are given: without a value the solver follows from the others.
struct GivenLight {
  LightOptions options;
  std::optional<bool> dense;
};

void bind_light(scene::SettingBinder& b, GivenLight& given) {
  using Variant = LightOptions::Variant;
  LightOptions& o = given.options;
  b.choice("variant", o.variant, {{"ray", Variant::ray}, {"paper", Variant::paper}},
           "ray: exact optical depths, Gauss points on panels of every camera ray; paper: equations 22 to 24, "
           "one medium seen by an orthographic camera");
  b.integer("points", o.ray.points, 2, 16, "of ray: Gauss points of a panel").where("variant", {"ray"});
  b.real("tolerance", o.ray.tolerance, 1e-13, 0.1, "of ray: of a light's share of a pixel, relative")
      .where("variant", {"ray"});
  b.integer("shadow_steps", o.ray.shadow_steps, 1, 65536,
            "of ray: shadow rays over the media on a camera ray, where surfaces may stand before a light; "
            "finds shadows wider than that")
      .where("variant", {"ray"});
  b.integer("environment_directions", o.ray.environment_directions, 1, 65536,
            "of ray: directions that stand for each environment")
      .where("variant", {"ray"});
  b.integer("n", o.paper.n, 1, scene::LegendreBox::most, "of paper: coefficients of an intensity along each axis")
      .where("variant", {"paper"});
  b.choice("closure", o.paper.solver.closure, {{"least_squares", Closure::least_squares}, {"upwind", Closure::upwind}},
           "of paper, where light comes in: rows of a system of least squares; weak upwind inflow")
      .where("variant", {"paper"});
  b.real("boundary_weight", o.paper.solver.weight, 1e-6, 1e6, "of least_squares: weight of the rows of inflow")
      .where("variant", {"paper"})
      .where("closure", {"least_squares"});
  b.choice("truncation", o.paper.truncation, {{"l2", LightTruncation::l2}, {"chebyshev", LightTruncation::chebyshev}},
           "of paper: T of its equations 22 and 23")
      .where("variant", {"paper"});
  b.choice("solver", given.dense, {{"auto", std::nullopt}, {"dense", true}, {"gmres", false}},
           "of paper: auto is gmres with upwind and n of 5 or more, else dense, of at most 12^3 unknowns")
      .where("variant", {"paper"});
}

}  // namespace

std::vector<scene::SettingSpec> light_settings() { return scene::list_settings(bind_light); }

LightOptions read_light_options(const scene::Settings& settings) {
  const GivenLight given = scene::read_settings(bind_light, settings);
  LightOptions o = given.options;
  LightSolver& solver = o.paper.solver;
  solver.dense = given.dense.value_or(solver.closure == Closure::least_squares || o.paper.n < least_gmres);
  return o;
}

std::shared_ptr<const scene::Scene> with_sky(std::shared_ptr<const scene::Scene> scene, const RayOptions& o) {
  if (!scene::has_environment(*scene) || !(scatters(*scene) || scene->geometry)) return scene;
  return std::make_shared<const scene::Scene>(scene::with_sky_as_lights(*scene, o.environment_directions));
}

std::vector<std::string> unsupported_light(const scene::Scene& scene, const LightOptions& o) {
  std::vector<std::string> reasons;
  if (o.variant == LightOptions::Variant::paper) {
    reasons = unsupported_paper(scene, o.paper);
    if (scene::has_environment(scene) && (scatters(scene) || scene.geometry))
      reasons.push_back(
          "variant = paper solves a system for each direction of light, and an environment has all of "
          "them: expected directional lights, or variant = ray");
  }
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    if (const std::string why = unsupported_field(scene.media, i); !why.empty()) reasons.push_back(why);
  for (std::size_t i = 0; i < scene.lights.size() && o.variant == LightOptions::Variant::ray; ++i)
    if (const std::string why = scene::unknown_light<scene::DirectionalLight, scene::EnvironmentLight>(scene.lights, i);
        !why.empty())
      reasons.push_back(why);
  return reasons;
}

}  // namespace airlight::legendre_fluids
