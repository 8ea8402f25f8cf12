#include "methods/fogshop/sky_volume.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace airlight::fogshop {
namespace {

// Light from one direction: radiance times solid angle over 4 pi.
struct Beam {
  Vec3 direction;
  Rgb weight;
};

// i / n and its digits mirrored: evenly spread pairs (Hammersley's).
double radical_inverse(unsigned i) {
  double result = 0, digit = 0.5;
  for (; i > 0; i >>= 1, digit *= 0.5) result += digit * (i & 1);
  return result;
}

std::vector<Beam> beams_of(const scene::Scene& scene, int directions) {
  std::vector<Beam> beams;
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

}  // namespace

SkyVolume::SkyVolume(const scene::Scene& scene, const Fog& fog, const GaussianArrays& gaussians, Erf erf, int cells,
                     int directions, const scene::Execution& execution) {
  Box box;
  for (int i = 0; i < gaussians.count; ++i) {
    const Vec3 reach = Vec3::Constant(std::sqrt(gaussians.radius_squared[i]));
    box = unite(box, Box{gaussians.center(i) - reach, gaussians.center(i) + reach});
  }
  corner_ = box.lo;
  cell_ = box.size().maxCoeff() / cells;
  for (int c = 0; c < 3; ++c) last_[c] = std::max(1, int(std::ceil(box.size()[c] / cell_ - 1e-9)));
  const int across = last_[0] + 1, layer = across * (last_[1] + 1), layers = last_[2] + 1;
  values_.assign(std::size_t(layer) * layers, Rgb::Zero());

  const std::vector<Beam> beams = beams_of(scene, directions);
  const int rows = (last_[1] + 1) * layers;
  std::vector<double> calls(rows, 0.0);
  scene::parallel_rows(rows, execution, [&](int row) {
    Crossings crossings;
    for (int x = 0; x < across; ++x) {
      const Point3 node = corner_ + cell_ * Vec3(x, row % (last_[1] + 1), row / (last_[1] + 1));
      Rgb sum = Rgb::Zero();
      for (const Beam& beam : beams) {
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
  int low[3];
  double s[3];
  for (int c = 0; c < 3; ++c) {
    const double place = std::clamp((x[c] - corner_[c]) / cell_, 0.0, double(last_[c]));
    low[c] = std::min(last_[c] - 1, int(place));
    s[c] = place - low[c];
  }
  const std::size_t across = last_[0] + 1, layer = across * (last_[1] + 1);
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
