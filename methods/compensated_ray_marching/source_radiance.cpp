#include "methods/compensated_ray_marching/source_radiance.h"

#include <cmath>
#include <map>
#include <mutex>

#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/base/error.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

const std::vector<int> family_counts{1, 2, 4, 16, 64};
constexpr int family_members = 32;

HarmonicExponential exponential_of(Transmittance kind, const LinearExponential* linear) {
  if (kind == Transmittance::paper_linear) return [linear](const Harmonics& f) { return (*linear)(f); };
  if (kind == Transmittance::paper_squared)
    return [linear](const Harmonics& f) { return squared_exponential(f, *linear, squaring_threshold); };
  return [](const Harmonics& f) { return series_exponential(f); };
}

// Null where it is not needed.
const LinearExponential* linear_of(int order, Transmittance kind) {
  const bool needed = kind == Transmittance::paper_linear || kind == Transmittance::paper_squared;
  return needed ? &linear_exponential(order) : nullptr;
}

scene::GaussianSum without_constant(scene::GaussianSum sum) {
  sum.constant = 0;
  return sum;
}

}  // namespace

const LinearExponential& linear_exponential(int order) {
  static std::mutex mutex;
  static std::map<int, LinearExponential> kept;
  const std::lock_guard lock(mutex);
  const auto found = kept.find(order);
  if (found != kept.end()) return found->second;
  return kept.emplace(order, LinearExponential(depth_family(order, family_counts, family_members))).first->second;
}

const ShadowTable& shadow_table(int order, Transmittance kind) {
  static std::mutex mutex;
  static std::map<std::pair<int, Transmittance>, ShadowTable> kept;
  const LinearExponential* linear = linear_of(order, kind);
  const std::lock_guard lock(mutex);
  const auto found = kept.find({order, kind});
  if (found != kept.end()) return found->second;
  return kept.emplace(std::pair(order, kind), ShadowTable(order, exponential_of(kind, linear))).first->second;
}

SourceRadiance::SourceRadiance(scene::GaussianSum smoke, const Rgb& extinction, const Rgb& albedo,
                               std::vector<double> phase, SourceLight light, Transmittance kind,
                               std::vector<Ordinate> directions, std::vector<scene::Sphere> objects)
    : smoke_(without_constant(std::move(smoke))),
      extinction_(extinction),
      albedo_(albedo),
      phase_(std::move(phase)),
      light_(std::move(light)),
      kind_(kind),
      // Not even in the angle, as the paper tabulates: what is far away adds up (gaussian_depth.h).
      depths_(int(phase_.size()), DepthTable::Spacing::even, depth_samples, smoke_.cutoff),
      objects_(std::move(objects)),
      linear_(linear_of(int(phase_.size()), kind)) {
  if (kind == Transmittance::directional) {
    directions_ = std::move(directions);
    for (const Ordinate& d : directions_) {
      harmonics_.push_back(scene::evaluate_sh(order(), d.direction));
      from_.push_back(d.weight * light_.radiance(d.direction));
    }
  } else if (light_.harmonics.size() != phase_.size() * phase_.size()) {
    throw Error("source radiance: light and phase function of different orders");
  } else if (!objects_.empty()) {
    shadows_ = &shadow_table(order(), kind);
  }
}

// - sum over Gaussians of w_h T_h(x), Eq. 10.
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
    const Rgb left = left_of(k, x, objects_);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += harmonics_[k][i] * left;
  }
  return sum;
}

// Light that arrives from direction k past smoke and objects, times the weight of the direction.
Rgb SourceRadiance::left_of(std::size_t k, const Point3& x, const std::vector<scene::Sphere>& objects) const {
  const Vec3& toward = directions_[k].direction;
  const double spacing = std::sqrt(4 * pi / double(directions_.size()));
  const double share = objects.empty() ? 1 : visible_share(objects, x, toward, spacing);
  if (share == 0) return Rgb::Zero();
  return share * from_[k] * (-extinction_ * density_integral(smoke_, Ray{x, toward}, {0, infinity})).exp();
}

// tau~, exp* of the depths: what gets through smoke and past objects, of each channel, of the first alone where all are alike. Nothing within an object.
std::vector<Harmonics> SourceRadiance::passed(const Point3& x, const std::vector<scene::Sphere>& objects) const {
  std::optional<Harmonics> hidden;
  if (!objects.empty() && !(hidden = log_visibility(objects, x, *shadows_))) return {};
  const Harmonics depth = minus_depth(x);
  const HarmonicExponential exponential = exponential_of(kind_, linear_);
  const bool grey = extinction_[0] == extinction_[1] && extinction_[1] == extinction_[2];
  std::vector<Harmonics> channels;
  for (int c = 0; c < (grey ? 1 : 3); ++c) {
    Harmonics sum = depth;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = sum[i] * extinction_[c] + (hidden ? (*hidden)[i] : 0);
    channels.push_back(exponential(sum));
  }
  return channels;
}

// L_in times tau~.
std::vector<Rgb> SourceRadiance::attenuated_light(const Point3& x) const {
  if (kind_ == Transmittance::directional) return by_directions(x);
  std::vector<Rgb> left(light_.harmonics.size(), Rgb::Zero());
  const std::vector<Harmonics> channels = passed(x, objects_);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    std::vector<Rgb> product = scene::triple_product(order())(light_.harmonics, channels[c]);
    if (channels.size() == 1) return product;
    for (std::size_t i = 0; i < left.size(); ++i) left[i][Eigen::Index(c)] = product[i][Eigen::Index(c)];
  }
  return left;
}

Rgb SourceRadiance::irradiance(const Point3& x, const Vec3& normal,
                               const std::function<bool(std::size_t)>& casts) const {
  std::vector<scene::Sphere> others;
  for (std::size_t i = 0; i < objects_.size(); ++i)
    if (casts(i)) others.push_back(objects_[i]);
  Rgb sum = Rgb::Zero();
  if (kind_ == Transmittance::directional) {
    for (std::size_t k = 0; k < directions_.size(); ++k)
      if (const double cosine = normal.dot(directions_[k].direction); cosine > 0) sum += cosine * left_of(k, x, others);
    return sum.max(0);
  }
  const std::vector<Harmonics> channels = passed(x, others);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    Rgb one = compensated_ray_marching::irradiance(normal, channels[c], light_.harmonics);
    if (channels.size() == 1) return one;
    sum[Eigen::Index(c)] = one[Eigen::Index(c)];
  }
  return sum;
}

// Eq. 11.
std::vector<Rgb> SourceRadiance::at(const Point3& x) const { return scattered(attenuated_light(x), albedo_, phase_); }

std::vector<Rgb> scattered(std::vector<Rgb> light, const Rgb& albedo, const std::vector<double>& phase) {
  for (int l = 0; l < int(phase.size()); ++l)
    for (int m = -l; m <= l; ++m)
      light[std::size_t(scene::sh_index(l, m))] *= (l % 2 ? -1 : 1) * phase[std::size_t(l)] * albedo;
  return light;
}

}  // namespace airlight::compensated_ray_marching
