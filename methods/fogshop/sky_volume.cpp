#include "methods/fogshop/sky_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

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

Point3 SkyGrid::node(std::size_t i) const {
  const std::size_t across = std::size_t(last[0]) + 1, lines = std::size_t(last[1]) + 1;
  return corner + cell * Vec3(double(i % across), double(i / across % lines), double(i / across / lines));
}

OpenBeams::OpenBeams(const scene::Geometry& geometry, const SkyGrid& grid, const std::vector<SkyBeam>& beams,
                     const scene::Execution& execution)
    : words((beams.size() + 31) / 32),
      bits(grid.nodes() * words, 0),
      rays(double(grid.nodes()) * double(beams.size())) {
  const std::size_t row = std::size_t(grid.last[0]) + 1;
  std::vector<char> reached(grid.nodes(), false);
  scene::parallel_for(int(grid.nodes() / row), execution, [&](int line) {
    for (std::size_t i = std::size_t(line) * row; i < std::size_t(line + 1) * row; ++i)
      for (std::size_t b = 0; b < beams.size(); ++b) {
        if (geometry.occluded({grid.node(i), beams[b].direction})) continue;
        bits[i * words + b / 32] |= std::uint32_t(1) << b % 32;
        reached[i] = true;
      }
  });
  // Outwards from the nodes that are reached, a ring at a time.
  std::vector<std::size_t> ring, next;
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (reached[i]) ring.push_back(i);
  const std::array<std::size_t, 3> steps{1, row, row * std::size_t(grid.last[1] + 1)};
  for (; !ring.empty(); ring.swap(next), next.clear())
    for (const std::size_t i : ring)
      for (int axis = 0; axis < 3; ++axis) {
        const int place = int(i / steps[std::size_t(axis)]) % (grid.last[axis] + 1);
        for (const int side : {-1, 1}) {
          if (place + side < 0 || place + side > grid.last[axis]) continue;
          const std::size_t other = side > 0 ? i + steps[std::size_t(axis)] : i - steps[std::size_t(axis)];
          if (reached[other]) continue;
          reached[other] = true;
          std::copy_n(bits.begin() + long(i * words), words, bits.begin() + long(other * words));
          next.push_back(other);
        }
      }
}

SkyVolume::SkyVolume(const scene::Scene& scene, const Fog& fog, const GaussianArrays& gaussians, Erf erf, int cells,
                     int directions, const scene::Execution& execution)
    : grid_(gaussians, cells) {
  const int across = grid_.last[0] + 1, lines = grid_.last[1] + 1, layers = grid_.last[2] + 1;
  values_.assign(std::size_t(across) * lines * layers, Rgb::Zero());

  const std::vector<SkyBeam> beams = sky_beams(scene, directions);
  std::optional<OpenBeams> open;
  if (scene.geometry) {
    open.emplace(*scene.geometry, grid_, beams, execution);
    shadow_rays_ = open->rays;
  }
  const int rows = lines * layers;
  std::vector<double> calls(rows, 0.0);
  scene::parallel_for(rows, execution, [&](int row) {
    Crossings crossings;
    for (int x = 0; x < across; ++x) {
      const std::size_t place = std::size_t(row) * std::size_t(across) + std::size_t(x);
      const Point3 node = grid_.node(place);
      Rgb sum = Rgb::Zero();
      for (std::size_t b = 0; b < beams.size(); ++b) {
        const SkyBeam& beam = beams[b];
        if (open && !open->open(place, b)) continue;
        cross(gaussians, {node, beam.direction, infinity}, erf, crossings);
        calls[row] += 2.0 * crossings.count;
        sum += beam.weight * (-total_depth(crossings, infinity, erf) * fog.extinction_ratio).exp();
      }
      values_[place] = sum;
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
