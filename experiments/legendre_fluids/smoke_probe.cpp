#include <algorithm>
#include <cmath>

#include "experiments/legendre_fluids/fluid_probes.h"
#include "scene/base/error.h"
#include "scene/convert/legendre_projection.h"
#include "scene/math/legendre.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"

namespace airlight::experiments {

std::string LegendreSmoke::about() const {
  return "error of a medium as a Legendre box of n coefficients along its longest axis";
}

std::vector<scene::SettingSpec> LegendreSmoke::settings() const {
  return {scene::integer_setting("n", "12", 1, scene::LegendreBox::most,
                                 "coefficients along the longest axis, the others in proportion"),
          scene::flag_setting("lanczos", true, "factors that damp waves"),
          scene::flag_setting("limiter", true, "that leaves nothing negative")};
}

std::vector<std::string> LegendreSmoke::figures() const {
  return {"error", "clamped_error", "mass_ratio", "negative_share", "minimum", "maximum", "theta"};
}

Findings LegendreSmoke::run(const ProbeInput& input, const scene::Settings& s, const scene::Execution&) const {
  if (input.file.empty()) throw Error("legendre_smoke needs a [[scene]]");
  const scene::Scene scene = scene::load_scene(input.file.string(), input.overrides);
  if (scene.media.empty()) throw Error(scene.name + ": legendre_smoke needs a medium");
  const Vec3 size = scene::support(scene.media[0].field).size();
  scene::ProjectionOptions options;
  for (int a = 0; a < 3; ++a)
    options.shape[std::size_t(a)] = std::max(1, int(std::lround(double(s.integer("n")) * size[a] / size.maxCoeff())));
  options.lanczos = s.flag("lanczos"), options.limiter = s.flag("limiter");
  const scene::LegendreProjection fit = scene::project_to_legendre(scene.media[0], options);
  Findings found;
  found.figures = {exactly("error", fit.error),
                   exactly("clamped_error", fit.clamped_error),
                   exactly("mass_ratio", fit.mass_ratio),
                   exactly("negative_share", fit.negative_share),
                   exactly("minimum", fit.values.lo),
                   exactly("maximum", fit.values.hi),
                   exactly("theta", fit.theta)};
  found.counters = {{"coefficients", double(scene::tensor_size(options.shape))}};
  return found;
}

}  // namespace airlight::experiments
