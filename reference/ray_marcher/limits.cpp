#include "reference/ray_marcher/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/layer.h"
#include "reference/ray_marcher/light_maps.h"

namespace airlight::ray_marcher {
namespace {

// The longest way through a medium, as steps are laid: an endless one ends at the optical depth `horizon`, or half of
// that beyond the farthest lamp.
double longest(const scene::Medium& medium, const scene::Scene& scene, const Options& options) {
  const Box box = bounding_box(medium);
  if (box.empty()) return 0;
  if (box.size().allFinite()) return box.size().stableNorm();
  double least = infinity;
  const double density = density_bounds(medium, {Point3::Zero(), Point3::Zero()}).hi;
  for (const double sigma_t : medium.sigma_t)
    if (sigma_t > 0) least = std::min(least, sigma_t * density);
  if (!(least > 0 && least < infinity)) return 0;
  double farthest = 0;
  for (const scene::Light& light : scene.lights)
    if (const auto lamp = ball(light)) farthest = std::max(farthest, (lamp->center - scene.camera.position).norm());
  return std::max(1.0, 0.5 + farthest * least / options.horizon) * options.horizon / least;
}

// The longest of the ways through parts that vary.
double longest_varied(const scene::Scene& scene) {
  double longest = 0;
  for (const scene::Medium& medium : scene.media) {
    if (!extinguishes(medium)) continue;
    const Box box = intersect(varied_support(medium.field), bounding_box(medium.region));
    if (!box.empty() && box.size().allFinite()) longest = std::max(longest, box.size().stableNorm());
  }
  return longest;
}

int balls(const scene::Scene& scene) {
  return int(std::count_if(scene.lights.begin(), scene.lights.end(), [](const auto& l) { return bool(ball(l)); }));
}

}  // namespace

double steps_per_ray(const scene::Scene& scene, const Options& options) {
  if (!(options.step > 0)) return options.steps;
  double sum = 0;
  for (const scene::Medium& medium : scene.media)
    if (extinguishes(medium)) sum += 1 + longest(medium, scene, options) / options.step;
  return std::max(sum, 1.0);
}

std::vector<std::string> unsupported(const scene::Scene& scene, const Options& options, double unit) {
  std::vector<std::string> reasons;
  const auto out_of_range = [&](const char* name, double metres) {
    const double length = metres / unit;
    if (length != 0 && !(length >= least_length && length <= most_length))
      reasons.push_back(
          fmt::format("{} = {} is out of range, expected 0, or {} to {}", name, length, least_length, most_length));
  };
  out_of_range("step", options.step);
  out_of_range("shadow_step", options.shadow_step);
  if (!reasons.empty()) return reasons;
  const double camera = steps_per_ray(scene, options), varied = longest_varied(scene);
  const bool map = options.shadow == Shadow::map;
  const double shadow = varied == 0 || map        ? 0
                        : options.shadow_step > 0 ? 1 + varied / options.shadow_step
                                                  : options.shadow_steps;
  const auto too_many = [&](const char* name, double metres, double steps) {
    if (steps > most_steps)
      reasons.push_back(fmt::format("{} = {} asks for {:.3g} steps along a ray, expected at most {:.0f}", name,
                                    metres / unit, steps, most_steps));
  };
  too_many("step", options.step, camera);
  too_many("shadow_step", options.shadow_step, shadow);
  if (!reasons.empty()) return reasons;
  const int own = options.graded ? balls(scene) : 0;
  if (camera * (1 + own) > most_ray_steps)
    reasons.push_back(
        fmt::format("{:.3g} steps for each of 1 + {} marches along a ray (one for each point and spot "
                    "light), expected at most {:.0f} in all",
                    camera, own, most_ray_steps));
  double lights = 0;
  for (const scene::Light& light : scene.lights) lights += is_delta(light) ? 1 : options.environment_directions;
  const double pixels = double(scene.width) * scene.height;
  const double work = pixels * camera * (1 + lights * std::max(1.0, shadow * double(scene.media.size())));
  if (map) {
    if (const std::string reason = light_map::unsupported(options.map); !reason.empty()) reasons.push_back(reason);
    if (varied > 0 && map_work(scene, options) > most_work)
      reasons.push_back(fmt::format(
          "maps of {:.3g} lights with {}^2 texels of {} steps in {} media are {:.2g} "
          "evaluations, expected at most {:.0e}",
          lights, options.map.size, options.map.steps, scene.media.size(), map_work(scene, options), most_work));
  }
  if (work > most_work)
    reasons.push_back(
        fmt::format("{:.3g} pixels of {:.3g} steps with {:.3g} shadow rays of {:.3g} steps in {} media are "
                    "{:.2g} evaluations, expected at most {:.0e}",
                    pixels, camera, lights, shadow, scene.media.size(), work, most_work));
  return reasons;
}

}  // namespace airlight::ray_marcher
