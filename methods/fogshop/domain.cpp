#include "methods/fogshop/domain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/light/background.h"

namespace airlight::fogshop {
namespace {

double depth_across(const scene::Gaussian& g) { return std::sqrt(pi) * g.amplitude * g.width; }

// A Gaussian with less than this share of the density at the light may be as wrong as it likes.
constexpr double least_share = 0.1;

std::string too_wide(const scene::Scene& scene, const Fog& fog, const Options& options) {
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    const auto light = scene::ball(scene.lights[l]);
    if (!light) continue;
    const double apart = std::max((light->center - scene.camera.position).norm(), options.source_radius);
    const double there = density(fog.sum, light->center);
    for (const scene::Gaussian& g : fog.sum.gaussians) {
      const double widths = (light->center - g.center).norm() / g.width;
      if (g.width > apart && widths < 2 && g.amplitude * std::exp(-widths * widths) > least_share * there)
        return fmt::format(
            "light {} stands in a Gaussian {:.3g} m wide, {:.3g} m from the camera: variant paper expects it to be no "
            "wider than that, S knows no such limit",
            l, g.width, apart);
    }
  }
  return "";
}

// Greatest optical depth of the Gaussians along rays from the camera to those that are deepest, surfaces aside.
double greatest_depth(const scene::Scene& scene, const Fog& fog) {
  constexpr std::size_t looked_at = 16;
  const auto& all = fog.sum.gaussians;
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  const auto some = order.begin() + std::ptrdiff_t(std::min(order.size(), looked_at));
  std::partial_sort(order.begin(), some, order.end(),
                    [&](std::size_t a, std::size_t b) { return depth_across(all[a]) > depth_across(all[b]); });
  double most = 0;
  for (auto i = order.begin(); i != some; ++i) {
    const Vec3 way = all[*i].center - scene.camera.position;
    const Ray ray{scene.camera.position, way.norm() > 0 ? Vec3(way.normalized()) : Vec3(-Vec3::UnitZ())};
    double depth = 0;
    for (const scene::Gaussian& g : all) depth += scene::line_integral(g, ray, infinity);
    most = std::max(most, depth);
  }
  return most;
}

// The least distance of a point light from the centre of a Gaussian, in its widths; of those that matter.
double nearest_light(const scene::Scene& scene, const Fog& fog) {
  double least = infinity;
  for (const scene::Light& each : scene.lights)
    if (const auto light = scene::ball(each)) {
      const auto widths = [&](const scene::Gaussian& g) { return (light->center - g.center).norm() / g.width; };
      const auto log_density = [&](const scene::Gaussian& g) { return std::log(g.amplitude) - widths(g) * widths(g); };
      double most = -infinity;
      for (const scene::Gaussian& g : fog.sum.gaussians) most = std::max(most, log_density(g));
      for (const scene::Gaussian& g : fog.sum.gaussians)
        if (log_density(g) >= most + std::log(least_share)) least = std::min(least, widths(g));
    }
  return least;
}

}  // namespace

std::string objection_to_domain(const scene::Scene& scene, const Fog& fog, const Options& options) {
  return options.variant == Options::Variant::paper ? too_wide(scene, fog, options) : "";
}

std::string doubt_of(const scene::Scene& scene, const Fog& fog, const Options& options) {
  const bool by_paper = options.variant == Options::Variant::paper &&
                        std::any_of(scene.lights.begin(), scene.lights.end(),
                                    [](const scene::Light& light) { return scene::ball(light).has_value(); });
  const bool walled_in = fog.sum.constant > 0 && options.environment_distance == infinity;
  const bool by_one_depth = !options.sky_volume() && !walled_in && scene::has_environment(scene);
  if (fog.sum.gaussians.empty() || !(by_paper || by_one_depth)) return "";
  std::vector<std::string> doubts;
  const double depth = greatest_depth(scene, fog), widths = nearest_light(scene, fog);
  std::vector<std::string> limits;
  if (widths < least_widths)
    limits.push_back(
        fmt::format("a light {:.3g} widths from a Gaussian's centre (expected: {} or more)", widths, least_widths));
  if (depth > deepest)
    limits.push_back(fmt::format("Gaussians up to {:.3g} deep (expected: up to {})", depth, deepest));
  if (by_paper && !limits.empty())
    doubts.push_back(
        fmt::format("variant paper may be off by more than 25 %: {}; S has no such limits", fmt::join(limits, ", ")));
  if (by_one_depth && depth > deepest_sky)
    doubts.push_back(fmt::format(
        "Eq. 28 may be off by more than 25 %: the environment shines on Gaussians up to {:.3g} deep (expected: up to "
        "{}); environment_airlight = volume has no such limit",
        depth, deepest_sky));
  return fmt::format("{}", fmt::join(doubts, "; "));
}

}  // namespace airlight::fogshop
