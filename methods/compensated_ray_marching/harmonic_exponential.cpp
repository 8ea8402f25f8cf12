#include "methods/compensated_ray_marching/harmonic_exponential.h"

#include <algorithm>

#include "methods/compensated_ray_marching/gaussian_depth.h"
#include "methods/compensated_ray_marching/ordinate_directions.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/base/error.h"
#include "scene/math/random.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr double largest_blunt = 10;  // size up to which 24 levels of directions are exact to 1e-8

int order_of(const Harmonics& f) { return int(std::lround(std::sqrt(double(f.size())))); }

// Its size without the mean.
double size_of(const Harmonics& f) {
  double sum = 0;
  for (std::size_t i = 1; i < f.size(); ++i) sum += f[i] * f[i];
  return std::sqrt(sum);
}

// Values at directions that integrate products of exponentials well, and their harmonics.
struct Sphere {
  std::vector<Ordinate> directions;
  std::vector<Harmonics> harmonics;
  Sphere(int order, int levels, int azimuths) : directions(ordinate_directions(levels, azimuths, false)) {
    for (const Ordinate& d : directions) harmonics.push_back(scene::evaluate_sh(order, d.direction));
  }
  double value(const Harmonics& f, std::size_t i) const {
    double sum = 0;
    for (std::size_t k = 0; k < f.size(); ++k) sum += f[k] * harmonics[i][k];
    return sum;
  }
};

// Squares f `times` times. f is an exponential whose mean exponent was removed; `log_scale` is that mean exponent.
// f is kept near 1 in size to avoid overflow; the scale is applied at the end.
Harmonics squared(Harmonics f, int times, double log_scale) {
  const scene::TripleProduct& product = scene::triple_product(order_of(f));
  for (int i = 0; i < times; ++i) {
    f = product(f, f);
    log_scale *= 2;
    double largest = 0;
    for (const double value : f) largest = std::max(largest, std::abs(value));
    if (!(largest > 0)) return f;
    for (double& value : f) value /= largest;
    log_scale += std::log(largest);
  }
  for (double& value : f) value *= std::exp(log_scale);
  return f;
}

int halvings(double size, double threshold) {
  return size > threshold ? int(std::ceil(std::log2(size / threshold))) : 0;
}

Harmonics scaled(Harmonics f, double factor) {
  for (double& value : f) value *= factor;
  return f;
}

}  // namespace

Harmonics exact_exponential(const Harmonics& f) {
  const Sphere sphere(order_of(f), 24, 48);
  Harmonics result(f.size(), 0.0);
  for (std::size_t i = 0; i < sphere.directions.size(); ++i) {
    const double value = sphere.directions[i].weight * std::exp(sphere.value(f, i));
    for (std::size_t k = 0; k < f.size(); ++k) result[k] += value * sphere.harmonics[i][k];
  }
  return result;
}

// With e = exp*(-s h) the least squares of a + b (-s h) are a = mean of e_0 / sqrt(4 pi), b = mean of e.(-s h) / s^2: 1 is orthogonal to h.
LinearExponential::LinearExponential(const std::vector<Harmonics>& family, double longest, int steps)
    : longest_(longest), log_a_(std::size_t(steps) + 1, 0.0), log_b_(std::size_t(steps) + 1, 0.0) {
  if (family.empty()) throw Error("a linear exponential of an empty family");
  Eigen::VectorXd a = Eigen::VectorXd::Zero(steps + 1), b = a;
  const auto add = [&](const Sphere& sphere, int first, int last) {
    for (const Harmonics& h : family)
      for (std::size_t i = 0; i < sphere.directions.size(); ++i) {
        const double value = sphere.value(h, i), weight = sphere.directions[i].weight;
        const double factor = std::exp(-longest / steps * value);
        double power = 0;  // of one factor, begun anew every 16 steps against rounding
        for (int k = first; k <= last; ++k) {
          power = k != first && k % 16 ? power * factor : std::exp(-longest * k / steps * value);
          a[k] += weight * power;
          b[k] -= weight * power * value;
        }
      }
  };
  // The larger the size, the sharper the peak that the rule has to see.
  const int resolved = std::min(steps, int(steps * largest_blunt / longest));
  if (resolved > 0) add(Sphere(order_of(family[0]), 24, 48), 1, resolved);
  if (resolved < steps) add(Sphere(order_of(family[0]), 40, 80), resolved + 1, steps);
  for (int k = 1; k <= steps; ++k) {
    const double s = longest * k / steps, members = double(family.size());
    log_a_[std::size_t(k)] = std::log(a[k] / (4 * pi * members));
    // One band alone has no slope.
    if (b[k] > 0) log_b_[std::size_t(k)] = std::log(b[k] / (s * members));
  }
}

double LinearExponential::at(const std::vector<double>& table, double size) const {
  const double place = std::min(size / longest_, 1.0) * double(table.size() - 1);
  const std::size_t i = std::min(std::size_t(place), table.size() - 2);
  return table[i] + (place - double(i)) * (table[i + 1] - table[i]);
}

Harmonics LinearExponential::operator()(const Harmonics& f) const {
  const double size = size_of(f), mean = f[0] / std::sqrt(4 * pi);
  Harmonics result = scaled(f, std::exp(mean + at(log_b_, size)));
  result[0] = std::exp(mean + at(log_a_, size)) * std::sqrt(4 * pi);
  return result;
}

std::vector<Harmonics> depth_family(int order, const std::vector<int>& counts, int members) {
  std::vector<Harmonics> family;
  std::uint32_t number = 0;
  for (const int count : counts)
    for (int m = 0; m < members; ++m) {
      Harmonics sum(std::size_t(order * order), 0.0);
      for (int i = 0; i < count; ++i) {
        const RandomBlock random{philox4x32_10({number++, 0, 0, 0}, {2008, 0})};
        const double z = 2 * random.coarse(0) - 1, phi = 2 * pi * random.coarse(1), sine = std::sqrt((1 - z) * (1 + z));
        const double distance = 0.3 * std::pow(10 / 0.3, random.coarse(2));
        const Harmonics one = about_axis(zonal_depth(order, distance), {sine * std::cos(phi), sine * std::sin(phi), z});
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += one[k];
      }
      sum[0] = 0;
      if (const double size = size_of(sum); size > 0) sum = scaled(sum, 1 / size);
      family.push_back(std::move(sum));
    }
  return family;
}

Harmonics squared_exponential(const Harmonics& f, const LinearExponential& linear, double threshold) {
  const int times = halvings(size_of(f), threshold);
  Harmonics small = scaled(f, std::ldexp(1.0, -times));
  small[0] = 0;
  return squared(linear(small), times, f[0] / std::sqrt(4 * pi) * std::ldexp(1.0, -times));
}

Harmonics series_exponential(const Harmonics& f, double threshold) {
  const int times = halvings(size_of(f), threshold);
  Harmonics small = scaled(f, std::ldexp(1.0, -times));
  small[0] = 0;
  const scene::TripleProduct& product = scene::triple_product(order_of(f));
  Harmonics sum(f.size(), 0.0);
  sum[0] = std::sqrt(4 * pi);
  for (const double degree : {3.0, 2.0, 1.0}) {
    sum = scaled(product(sum, small), 1 / degree);
    sum[0] += std::sqrt(4 * pi);
  }
  return squared(sum, times, f[0] / std::sqrt(4 * pi) * std::ldexp(1.0, -times));
}

}  // namespace airlight::compensated_ray_marching
