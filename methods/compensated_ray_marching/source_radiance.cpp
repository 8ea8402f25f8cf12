#include "methods/compensated_ray_marching/source_radiance.h"

#include <cmath>
#include <map>
#include <mutex>

#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/error.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr double squaring_threshold = 0.5;
const std::vector<int> family_counts{1, 2, 4, 16, 64};
constexpr int family_members = 32;

// That of an order, made when first asked for and kept. Thread safe.
const LinearExponential& linear_exponential(int order) {
  static std::mutex mutex;
  static std::map<int, LinearExponential> kept;
  const std::lock_guard lock(mutex);
  const auto found = kept.find(order);
  if (found != kept.end()) return found->second;
  return kept.emplace(order, LinearExponential(depth_family(order, family_counts, family_members))).first->second;
}

scene::GaussianSum without_constant(scene::GaussianSum sum) {
  sum.constant = 0;
  return sum;
}

}  // namespace

SourceRadiance::SourceRadiance(scene::GaussianSum smoke, const Rgb& extinction, const Rgb& albedo,
                               std::vector<double> phase, SourceLight light, Transmittance kind,
                               std::vector<Ordinate> directions)
    : smoke_(without_constant(std::move(smoke))),
      extinction_(extinction),
      albedo_(albedo),
      phase_(std::move(phase)),
      light_(std::move(light)),
      kind_(kind),
      depths_(int(phase_.size()), DepthTable::Spacing::even, 256, smoke_.cutoff),
      linear_(kind == Transmittance::paper_linear || kind == Transmittance::paper_squared
                  ? &linear_exponential(int(phase_.size()))
                  : nullptr) {
  if (kind == Transmittance::directional) {
    directions_ = std::move(directions);
    for (const Ordinate& d : directions_) {
      harmonics_.push_back(scene::evaluate_sh(order(), d.direction));
      from_.push_back(d.weight * light_.radiance(d.direction));
    }
  } else if (light_.harmonics.size() != phase_.size() * phase_.size()) {
    throw Error("source radiance: light and phase function of different orders");
  }
}

Harmonics SourceRadiance::minus_depth(const Point3& x) const {
  Harmonics sum(phase_.size() * phase_.size(), 0.0);
  std::vector<double> zonal(phase_.size());
  for (const scene::Gaussian& g : smoke_.gaussians) {
    const Vec3 offset = g.center - x;
    const double distance = offset.norm();
    depths_.zonal(distance / g.width, zonal.data());
    const Harmonics one = about_axis(zonal, distance > 0 ? Vec3(offset / distance) : Vec3(0, 0, 1));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] -= g.amplitude * g.width * one[i];
  }
  return sum;
}

std::vector<Rgb> SourceRadiance::by_directions(const Point3& x) const {
  std::vector<Rgb> sum(phase_.size() * phase_.size(), Rgb::Zero());
  for (std::size_t k = 0; k < directions_.size(); ++k) {
    const double column = density_integral(smoke_, Ray{x, directions_[k].direction}, {0, infinity});
    const Rgb left = from_[k] * (-extinction_ * column).exp();
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += harmonics_[k][i] * left;
  }
  return sum;
}

std::vector<Rgb> SourceRadiance::attenuated_light(const Point3& x) const {
  if (kind_ == Transmittance::directional) return by_directions(x);
  const Harmonics depth = minus_depth(x);
  const bool grey = extinction_[0] == extinction_[1] && extinction_[1] == extinction_[2];
  std::vector<Rgb> left(depth.size(), Rgb::Zero());
  for (int c = 0; c < (grey ? 1 : 3); ++c) {
    Harmonics scaled = depth;
    for (double& value : scaled) value *= extinction_[c];
    const Harmonics passed = kind_ == Transmittance::paper_linear ? (*linear_)(scaled)
                             : kind_ == Transmittance::paper_squared
                                 ? squared_exponential(scaled, *linear_, squaring_threshold)
                                 : series_exponential(scaled);
    const std::vector<Rgb> product = scene::triple_product(order())(light_.harmonics, passed);
    if (grey) return product;
    for (std::size_t i = 0; i < left.size(); ++i) left[i][c] = product[i][c];
  }
  return left;
}

std::vector<Rgb> SourceRadiance::at(const Point3& x) const { return scattered(attenuated_light(x), albedo_, phase_); }

std::vector<Rgb> scattered(std::vector<Rgb> light, const Rgb& albedo, const std::vector<double>& phase) {
  for (int l = 0; l < int(phase.size()); ++l)
    for (int m = -l; m <= l; ++m)
      light[std::size_t(scene::sh_index(l, m))] *= (l % 2 ? -1 : 1) * phase[std::size_t(l)] * albedo;
  return light;
}

}  // namespace airlight::compensated_ray_marching
