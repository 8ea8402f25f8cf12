#include "methods/fogshop/noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/math/random.h"

namespace airlight::fogshop {
namespace {

// Towards the middles of a cube's edges: no gradient lies along an axis, and all are equally long.
constexpr int gradient[12][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                 {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1}};

double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

Point3 nearest_point(const Line& line, double middle) {
  return line.origin + std::clamp(middle, 0.0, line.length) * line.direction;  // b_i^r, Eq. 10
}

}  // namespace

Noise::Noise(double scale, double frequency, std::uint32_t seed, double phase)
    : scale_(scale), frequency_(frequency), phase_(phase) {
  std::iota(permutation_.begin(), permutation_.end(), 0);
  for (std::uint32_t i = 255; i > 0; --i) {
    const std::uint32_t bits = philox4x32_10({i, 0, 0, 0}, {seed, 0})[0];
    std::swap(permutation_[i], permutation_[std::uint64_t(bits) * (i + 1) >> 32]);
  }
}

Vec3 Noise::at(const Point3& x) const {
  int cell[3];
  double f[3], blend[3];
  for (int k = 0; k < 3; ++k) {
    const double place = x[k] * frequency_ + phase_, whole = std::floor(place);
    f[k] = place - whole;
    cell[k] = int(whole - period * std::floor(whole / period));
    blend[k] = fade(f[k]);
  }
  Vec3 sum = Vec3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    int at[3];
    double offset[3], weight = 1;
    for (int k = 0; k < 3; ++k) {
      const int far = corner >> k & 1;
      at[k] = (cell[k] + far) % period;
      offset[k] = f[k] - far;
      weight *= far ? blend[k] : 1 - blend[k];
    }
    for (int channel = 0; channel < 3; ++channel) {
      // Channels begin in parts of the permutation that no other one begins in.
      const int a = permutation_[at[0] + 2 * period * channel];
      const int hash = permutation_[(permutation_[(a + at[1]) & 255] + at[2]) & 255];
      const int* g = gradient[hash % 12];
      sum[channel] += weight * (g[0] * offset[0] + g[1] * offset[1] + g[2] * offset[2]);
    }
  }
  return sum.cwiseMax(-1).cwiseMin(1);
}

Vec3 Noise::bent(const Point3& view, const Vec3& direction, const Point3& center, double radius,
                 const Point3& nearest) const {
  const double distance = (center - view).norm();
  const double share = distance > radius ? radius / distance : 1;
  return (direction + scale_ * share * at(nearest)).normalized();
}

void bend(const GaussianArrays& g, const Line& line, const Noise& noise, Crossings& c) {
  for (int k = 0; k < c.count; ++k) {
    const int i = c.place[k];
    const double radius = std::sqrt(g.radius_squared[i]) / noise_reach(noise.scale());
    const Vec3 r = noise.bent(line.origin, line.direction, g.center(i), radius, nearest_point(line, c.middle[k]));
    const Vec3 q = g.center(i) - line.origin, p = q - q.dot(r) * r;
    c.depth[k] = g.half_depth[i] * std::exp(-g.a[i] * g.a[i] * p.squaredNorm());
  }
}

void bent_depths(const GaussianArrays& g, const Line& line, const Noise& noise, Erf erf, Crossings& c) {
  for (int k = 0; k < c.count; ++k) {
    const int i = c.place[k];
    const double radius = std::sqrt(g.radius_squared[i]) / noise_reach(noise.scale());
    const Vec3 r = noise.bent(line.origin, line.direction, g.center(i), radius, nearest_point(line, c.middle[k]));
    const Vec3 q = g.center(i) - line.origin;
    const double m = q.dot(r), a = g.a[i];
    const Vec3 p = q - m * r;
    const double ends = error_function(erf, a * (line.length - m)) + error_function(erf, a * m);
    c.whole[k] = g.half_depth[i] * std::exp(-a * a * p.squaredNorm()) * std::max(ends, 0.0);
  }
}

}  // namespace airlight::fogshop
