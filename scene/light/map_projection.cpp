#include "scene/light/map_projection.h"

#include <algorithm>
#include <cmath>

#include "scene/light/lat_long.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::scene {
namespace {

std::size_t pair_index(int l, int m) { return std::size_t(l) * (l + 1) / 2 + m; }

// For each frequency and row three sums with the cosine, three with the sine.
std::vector<double> fourier_sums(const EnvironmentMap& map, int order) {
  const auto width = std::size_t(map.width), height = std::size_t(map.height);
  std::vector<double> sums(6 * height * std::size_t(order), 0.0), cosine(width), sine(width);
  for (int m = 0; m < order; ++m) {
    for (std::size_t i = 0; i < width; ++i) {
      const double azimuth = 2 * pi * (double(i) + 0.5) / double(width);
      cosine[i] = std::cos(m * azimuth);
      sine[i] = std::sin(m * azimuth);
    }
    for (std::size_t row = 0; row < height; ++row) {
      double* sum = &sums[6 * (std::size_t(m) * height + row)];
      const float* texel = &map.rgb[3 * row * width];
      for (std::size_t i = 0; i < width; ++i, texel += 3)
        for (int c = 0; c < 3; ++c) {
          sum[c] += cosine[i] * double(texel[c]);
          sum[3 + c] += sine[i] * double(texel[c]);
        }
    }
  }
  return sums;
}

}  // namespace

std::vector<double> row_weights(int order, int width, int height) {
  const auto n = std::size_t(height);
  std::vector<double> weights(std::size_t(pair_count(order)) * n, 0.0);
  // Integrals over angles of a row's hat times Y_lm at azimuth 0.
  const GaussLegendre rule = gauss_legendre(std::min(6 + int(3 * order * pi / height), 64));
  for (int strip = 0; strip <= height; ++strip) {
    const double begin = strip_begin(strip, height), end = strip_begin(strip + 1, height);
    const std::size_t top = std::size_t(std::max(strip - 1, 0)), bottom = std::size_t(std::min(strip, height - 1));
    for (std::size_t j = 0; j < rule.node.size(); ++j) {
      const double y = 0.5 * (1 + rule.node[j]), theta = begin + (end - begin) * y;
      const Vec3 w(std::sin(theta), 0, std::cos(theta));
      const double weight = rule.weight[j] * 0.5 * (end - begin) * w[0];
      const std::vector<double> basis = evaluate_sh(order, w);
      for (int l = 0; l < order; ++l)
        for (int m = 0; m <= l; ++m) {
          double* row = &weights[pair_index(l, m) * n];
          const double value = weight * basis[std::size_t(sh_index(l, m))];
          row[top] += (1 - y) * value;
          row[bottom] += y * value;
        }
    }
  }
  // Factor on frequency m by linear interpolation along a row (a hat, one texel wide).
  for (int l = 0; l < order; ++l)
    for (int m = 0; m <= l; ++m) {
      const double half = m * pi / width, shrunk = m > 0 ? std::sin(half) / half : 1;
      double* row = &weights[pair_index(l, m) * n];
      for (std::size_t i = 0; i < n; ++i) row[i] *= 2 * pi / width * shrunk * shrunk;
    }
  return weights;
}

EnvironmentLight about_pole(int order, const std::vector<double>& sums) {
  EnvironmentLight light;
  // Azimuths from +z towards +x about the pole y: the axes (z, x, y) are those of the harmonics. Rows begin there and turn the other way.
  light.to_map << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  light.sh.resize(std::size_t(order) * std::size_t(order));
  for (int l = 0; l < order; ++l)
    for (int m = 0; m <= l; ++m) {
      const double* pair = &sums[6 * pair_index(l, m)];
      for (int c = 0; c < 3; ++c) {
        light.sh[std::size_t(sh_index(l, m))][c] = pair[c];
        if (m > 0) light.sh[std::size_t(sh_index(l, -m))][c] = -pair[3 + c];
      }
    }
  return light;
}

EnvironmentLight map_about_pole(const EnvironmentMap& map, int order) {
  const auto height = std::size_t(map.height);
  const std::vector<double> weights = row_weights(order, map.width, map.height), rows = fourier_sums(map, order);
  std::vector<double> sums(6 * std::size_t(pair_count(order)), 0.0);
  for (int l = 0; l < order; ++l)
    for (int m = 0; m <= l; ++m) {
      double* sum = &sums[6 * pair_index(l, m)];
      for (std::size_t row = 0; row < height; ++row) {
        const double weight = weights[pair_index(l, m) * height + row];
        const double* fourier = &rows[6 * (std::size_t(m) * height + row)];
        for (int k = 0; k < 6; ++k) sum[k] += weight * fourier[k];
      }
    }
  return about_pole(order, sums);
}

}  // namespace airlight::scene
