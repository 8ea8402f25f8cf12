#include "reference/deterministic/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::deterministic {
namespace {

constexpr double nodes = 15;             // of a panel
constexpr double cuts_of_gaussian = 12;  // along the view, and of its shadow
constexpr double reach = 6.4;            // widths at which a Gaussian is 1e-18 of its amplitude
constexpr double clamped_cost = 50;      // of a sum with negative amplitudes, whose zeros are sought

struct Cost {
  double panels = 1;  // along a view ray, for one light
  double terms = 1;   // of the density's integral to a light
};

// Cuts of a ray lie two widths apart where Gaussians are dense, and where they are sparse only those near the ray cut
// it.
Cost cost(const scene::GaussianSum& sum, const Box& box) {
  const double n = double(sum.gaussians.size());
  if (n == 0 || box.empty()) return {};
  double inverse = 0, area = 0;
  bool clamped = false;
  for (const scene::Gaussian& g : sum.gaussians) {
    inverse += 1 / g.width;
    area += pi * reach * reach * g.width * g.width;
    clamped = clamped || g.amplitude < 0;
  }
  const double length = box.size().stableNorm();
  const double met = n * std::min(1.0, area / n / (length * length / 3));
  const double panels = std::min(cuts_of_gaussian * met, length * inverse / n / 2);
  return {1 + (panels > 0 ? panels : 0), clamped ? clamped_cost * n : n};
}

Cost cost(const scene::VoxelGrid& grid) {
  const double voxels = grid.size.cast<double>().sum();  // met by a ray at most
  return {voxels / 2, voxels};                           // panels of a shorter rule
}

Cost cost(const scene::Medium& medium) {
  return scene::match(
      medium.field, [](const scene::Homogeneous&) { return Cost{}; },
      [&](const scene::GaussianSum& sum) {
        return cost(sum, intersect(scene::support(medium.field), scene::bounding_box(medium.region)));
      },
      [](const scene::GridPointer& grid) { return cost(*grid); },
      [](const scene::FogmapPointer& fog) {
        const double cells = double(fog->map.range().size[0]) + fog->map.range().size[1];
        return Cost{cells / 2, cells};
      },
      [](const scene::LegendrePointer& series) {
        const auto& n = series->shape();
        const double points = n[0] + n[1] + n[2] - 2;  // of the polynomial on a ray; each sums up all coefficients
        return Cost{1 + points / 4, points * double(series->coefficients().size()) / 8};
      },
      [](const scene::FittedPointer& fitted) { return cost(fitted->grid); });
}

}  // namespace

double terms_of_evaluation(const scene::Scene& scene) {
  double terms = 0;
  for (const scene::Medium& medium : scene.media)
    if (medium.sigma_t.maxCoeff() > 0) terms += cost(medium).terms;
  return terms;
}

double terms_of_ray(const scene::Scene& scene) {
  double panels = 0;
  for (const scene::Medium& medium : scene.media)
    if (medium.sigma_t.maxCoeff() > 0) panels += cost(medium).panels;
  const auto lights = std::count_if(scene.lights.begin(), scene.lights.end(), scene::is_delta);
  return terms_of_evaluation(scene) * (1 + nodes * panels * double(lights));
}

std::string unsupported(const scene::Scene& scene) {
  const double needed = double(scene.width) * scene.height * terms_of_ray(scene);
  if (!(needed > most_work)) return {};
  return fmt::format(
      "{} x {} pixels, {} lights and {} media need {:.1g} evaluations of terms of densities, expected at most {:.0e}: "
      "fewer pixels, lights or Gaussians",
      scene.width, scene.height, scene.lights.size(), scene.media.size(), needed, most_work);
}

}  // namespace airlight::deterministic
