#include "reference/half_resolution_march/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/place_error.h"

namespace airlight::half_resolution_march {

std::vector<std::string> unsupported(const scene::Scene& scene, const Options& options) {
  std::vector<std::string> reasons = lit_media::unsupported(scene, options.media);
  if (const std::string reason = scene::too_thick(scene, 0.01); !reason.empty()) reasons.push_back(reason);
  double lights = 0;
  for (const scene::Light& light : scene.lights) lights += is_delta(light) ? 1 : options.media.environment_directions;
  const double rays =
      std::ceil(double(scene.width) / options.divide) * std::ceil(double(scene.height) / options.divide);
  const double work = rays * options.frames * options.steps * (1 + lights);
  if (work > most_work)
    reasons.push_back(
        fmt::format("{:.3g} rays of {} steps in {} frames under {:.3g} lights are {:.2g} evaluations, expected at most "
                    "{:.0e}",
                    rays, options.steps, options.frames, lights, work, most_work));
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const scene::Medium& medium = scene.media[i];
    const double constant = constant_part(medium.field);
    if (!(constant > 0) || bounding_box(medium.region).size().allFinite()) continue;
    for (const double sigma_t : medium.sigma_t) {
      const double extinction = sigma_t * constant;
      if (!(sigma_t > 0) || extinction >= least_endless) continue;
      reasons.push_back(fmt::format("{} has no end and an extinction of {:.3g} 1/m, expected 0, or {:.0e} 1/m or more",
                                    label(scene.media, i), extinction, least_endless));
      break;
    }
  }
  return reasons;
}

}  // namespace airlight::half_resolution_march
