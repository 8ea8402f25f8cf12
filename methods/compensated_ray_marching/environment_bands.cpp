#include "methods/compensated_ray_marching/environment_bands.h"

#include <utility>

namespace airlight::compensated_ray_marching {
namespace {

constexpr std::size_t most_known = 8;  // maps, of a sequence of them

bool same(const scene::EnvironmentMap& a, const scene::EnvironmentMap& b) {
  return a.width == b.width && a.height == b.height && a.rgb == b.rgb;
}

}  // namespace

EnvironmentBands::EnvironmentBands(int order)
    : EnvironmentBands(order, [order](const std::shared_ptr<const scene::EnvironmentMap>& map) {
        scene::EnvironmentLight upright;  // nobody samples it
        upright.map = map;
        return project_environment(upright, order);
      }) {}

EnvironmentBands::EnvironmentBands(int order, Project project) : order_(order), project_(std::move(project)) {}

const std::vector<Rgb>& EnvironmentBands::upright(const std::shared_ptr<const scene::EnvironmentMap>& map) {
  for (const Projected& p : known_)
    if (p.map == map || same(*p.map, *map)) return p.harmonics;
  if (known_.size() == most_known) known_.erase(known_.begin());
  known_.push_back({map, project_(map)});
  return known_.back().harmonics;
}

std::vector<Rgb> EnvironmentBands::of(const std::vector<scene::Light>& lights) {
  std::vector<Rgb> sum(std::size_t(order_) * std::size_t(order_), Rgb::Zero());
  for (const scene::Light& light : lights) {
    scene::EnvironmentLight environment = std::get<scene::EnvironmentLight>(light);
    if (environment.map) {
      environment.sh = upright(environment.map);
      environment.map = nullptr;
    }
    const std::vector<Rgb> one = project_environment(environment, order_);
    for (std::size_t i = 0; i < one.size(); ++i) sum[i] += one[i];
  }
  return sum;
}

}  // namespace airlight::compensated_ray_marching
