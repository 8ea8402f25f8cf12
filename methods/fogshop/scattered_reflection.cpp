#include "methods/fogshop/scattered_reflection.h"

#include <Eigen/Geometry>
#include <cmath>

#include "scene/math/gauss_legendre.h"

namespace airlight::fogshop {
namespace {

// sum_l w_l P_l(x).
double legendre_sum(const std::vector<double>& weights, double x) {
  double before = 1, value = x, sum = weights[0];
  for (std::size_t l = 1; l < weights.size(); ++l) {
    sum += weights[l] * value;
    const double next = ((2 * l + 1) * x * value - l * before) / (l + 1);
    before = value;
    value = next;
  }
  return sum;
}

// Coefficients of the zonal harmonics of the clamped cosine, 2 pi integral over x in [0, 1] of x Y_l0(x).
std::vector<double> clamped_cosine(int order) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(16);
  std::vector<double> result;
  for (int l = 0; l < order; ++l) {
    std::vector<double> one(l + 1, 0.0);
    one[l] = std::sqrt((2 * l + 1) / (4 * pi));
    double sum = 0;
    for (int i = 0; i < 16; ++i) {
      const double x = 0.5 * (1 + rule.node[i]);
      sum += 0.5 * rule.weight[i] * x * legendre_sum(one, x);
    }
    result.push_back(2 * pi * sum);
  }
  return result;
}

}  // namespace

ScatteredReflection::ScatteredReflection(int order, bool follows_depth)
    : bands_(follows_depth ? Psf::npsf_by_depth : Psf::npsf, order) {}

std::vector<double> ScatteredReflection::depths() const {
  if (bands_.depths() == 1) return {1};
  std::vector<double> result;
  for (int k = 0; k < PsfBands::entries; ++k)
    result.push_back(PsfBands::least_depth *
                     std::pow(PsfBands::greatest_depth / PsfBands::least_depth, double(k) / (PsfBands::entries - 1)));
  return result;
}

Rgb ScatteredReflection::reflect(const scene::Material& material, const Vec3& normal, const Vec3& to_view,
                                 const Vec3& to_light, const std::vector<double>& bands) {
  const int order = int(bands.size());
  if (const auto* lambert = std::get_if<scene::Lambert>(&material)) {
    if (!(normal.dot(to_view) > 0)) return Rgb::Zero();
    // Two zonal functions, each about its own axis: by the addition theorem sum_l g_l a_l P_l(cos of the axes' angle).
    static const std::vector<double> cosine = clamped_cosine(12);
    std::vector<double> weights(order);
    for (int l = 0; l < order; ++l) weights[l] = bands[l] * cosine[l];
    return lambert->albedo * (legendre_sum(weights, normal.dot(to_light)) / pi);
  }
  std::vector<double> weights(order);
  for (int l = 0; l < order; ++l) weights[l] = bands[l] * std::sqrt((2 * l + 1) / (4 * pi));
  static const scene::GaussLegendre rule = scene::gauss_legendre(16);
  constexpr int around = 32;
  const Vec3 a = normal.unitOrthogonal(), b = normal.cross(a);
  Rgb sum = Rgb::Zero();
  for (int i = 0; i < 16; ++i) {
    const double c = 0.5 * (1 + rule.node[i]), s = std::sqrt((1 - c) * (1 + c));
    for (int k = 0; k < around; ++k) {
      const double phi = 2 * pi * (k + 0.5) / around;
      const Vec3 in = c * normal + s * (std::cos(phi) * a + std::sin(phi) * b);
      const double weight = 0.5 * rule.weight[i] * (2 * pi / around) * c * legendre_sum(weights, in.dot(to_light));
      sum += scene::brdf(material, normal, in, to_view) * weight;
    }
  }
  return sum;
}

Rgb ScatteredReflection::operator()(const scene::Scene& scene, const Model& model, const SurfacePoint& point,
                                    const Vec3& to_view, Crossings& crossings, double& evaluations) const {
  const scene::Material& material = scene.surfaces[point.surface].material;
  Rgb radiance = Rgb::Zero();
  for (const LightModel& light : model.lights) {
    const Vec3 offset = light.position - point.position;
    const double distance = offset.norm();
    if (!(distance > 0)) continue;
    const double depth = gaussian_depth(model, light.position, point.position, crossings, evaluations) +
                         model.fog.sum.constant * distance;
    Rgb reflected = Rgb::Zero();
    for (int c = 0; c < 3; ++c) {
      const double T = depth * model.fog.hue[c];
      if (!(T > 0)) continue;
      const Rgb all = reflect(material, point.normal, to_view, offset / distance, bands(T)) * (T * std::exp(-T));
      if (model.fog.grey()) {  // one depth for all
        reflected = all;
        break;
      }
      reflected[c] = all[c];
    }
    radiance += light.intensity / (distance * distance) * reflected;
  }
  // Harmonics cut off at a band may swing below 0.
  return (radiance * model.fog.albedo).max(0.0);
}

}  // namespace airlight::fogshop
