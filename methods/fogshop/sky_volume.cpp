#include "methods/fogshop/sky_volume.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace airlight::fogshop {
namespace {

// i / n and its digits mirrored: evenly spread pairs (Hammersley's).
double radical_inverse(unsigned i) {
  double result = 0, digit = 0.5;
  for (; i > 0; i >>= 1, digit *= 0.5) result += digit * (i & 1);
  return result;
}

}  // namespace

std::vector<SkyBeam> sky_beams(const scene::Scene& scene, int directions) {
  std::vector<SkyBeam> beams;
  for (const scene::Light& light : scene.lights) {
    const auto* environment = std::get_if<scene::EnvironmentLight>(&light);
    if (!environment) continue;
    for (int i = 0; i < directions; ++i) {
      const Vec3 w = sample_environment(*environment, (i + 0.5) / directions, radical_inverse(i) + 0.5 / directions);
      const scene::EnvironmentValue value = evaluate_environment(*environment, w);
      beams.push_back({w, value.radiance / (4 * pi * value.pdf * directions)});
    }
  }
  return beams;
}

SkyGrid::SkyGrid(const GaussianArrays& gaussians, int cells) {
  Box box;
  for (int i = 0; i < gaussians.count; ++i) {
    const Vec3 reach = Vec3::Constant(std::sqrt(gaussians.radius_squared[i]));
    box = unite(box, Box{gaussians.center(i) - reach, gaussians.center(i) + reach});
  }
  corner = box.lo;
  cell = box.size().maxCoeff() / cells;
  for (int c = 0; c < 3; ++c) last[c] = std::max(1, int(std::ceil(box.size()[c] / cell - 1e-9)));
}

SkyVolume::SkyVolume(const scene::Scene& scene, const Fog& fog, const GaussianArrays& gaussians, Erf erf, int cells,
                     int directions, const scene::Execution& execution)
    : grid_(gaussians, cells) {
  const int across = grid_.last[0] + 1, lines = grid_.last[1] + 1, layers = grid_.last[2] + 1;
  values_.assign(std::size_t(across) * lines * layers, Rgb::Zero());

  const std::vector<SkyBeam> beams = sky_beams(scene, directions);
  const int rows = lines * layers;
  std::vector<double> calls(rows, 0.0);
  scene::parallel_rows(rows, execution, [&](int row) {
    Crossings crossings;
    for (int x = 0; x < across; ++x) {
      const Point3 node = grid_.corner + grid_.cell * Vec3(x, row % lines, row / lines);
      Rgb sum = Rgb::Zero();
      for (const SkyBeam& beam : beams) {
        cross(gaussians, {node, beam.direction, infinity}, erf, crossings);
        calls[row] += 2.0 * crossings.count;
        sum += beam.weight * (-total_depth(crossings, infinity, erf) * fog.hue).exp();
      }
      values_[std::size_t(row) * across + x] = sum;
    }
  });
  evaluations_ = std::accumulate(calls.begin(), calls.end(), 0.0);
}

Rgb SkyVolume::at(const Point3& x) const {
  const auto& [corner, cell, last] = grid_;
  int low[3];
  double s[3];
  for (int c = 0; c < 3; ++c) {
    const double place = std::clamp((x[c] - corner[c]) / cell, 0.0, double(last[c]));
    low[c] = std::min(last[c] - 1, int(place));
    s[c] = place - low[c];
  }
  const std::size_t across = last[0] + 1, layer = across * (last[1] + 1);
  const Rgb* v = &values_[low[2] * layer + low[1] * across + low[0]];
  const auto along_x = [&](const Rgb* at) { return Rgb(at[0] + s[0] * (at[1] - at[0])); };
  const auto along_y = [&](const Rgb* at) {
    const Rgb a = along_x(at);
    return Rgb(a + s[1] * (along_x(at + across) - a));
  };
  const Rgb a = along_y(v);
  return a + s[2] * (along_y(v + layer) - a);
}

}  // namespace airlight::fogshop
