// Environments in bands of spherical harmonics. A map's projection is expensive: it is cached for each
// map, for any rotation.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "scene/light/light.h"

namespace airlight::compensated_ray_marching {

class EnvironmentBands {
 public:
  // Projection of an unrotated map: order^2 coefficients in the map's own directions.
  using Project = std::function<std::vector<Rgb>(const std::shared_ptr<const scene::EnvironmentMap>&)>;
  explicit EnvironmentBands(int order);  // by project_environment
  EnvironmentBands(int order, Project);

  int order() const { return order_; }
  // Without turn and scale. Until the next call.
  const std::vector<Rgb>& upright(const std::shared_ptr<const scene::EnvironmentMap>&);
  // Lights, environments all, together: order^2 coefficients of lookup directions of the world. Bands turn by themselves, so that those of a
  // turned map are the upright map's, turned.
  std::vector<Rgb> of(const std::vector<scene::Light>&);

 private:
  struct Projected {
    std::shared_ptr<const scene::EnvironmentMap> map;
    std::vector<Rgb> harmonics;
  };

  int order_;
  Project project_;
  std::vector<Projected> known_;  // the latest
};

}  // namespace airlight::compensated_ray_marching
