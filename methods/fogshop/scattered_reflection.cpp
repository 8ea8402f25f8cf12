#include "methods/fogshop/scattered_reflection.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "methods/fogshop/harmonic_reflection.h"
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

Rgb ScatteredReflection::reflect_one(const scene::Material& material, const SurfacePoint& point, const Vec3& to_view,
                                     const Vec3& to_light, double T) const {
  if (sun_) return sun_->reflect(material, point.normal, to_view, to_light, T);
  if (!reflectances_.empty() && reflectances_[point.surface])
    return reflectances_[point.surface]->reflect(point.normal, to_view, to_light, bands(T));
  return reflect(material, point.normal, to_view, to_light, bands(T));
}

Rgb ScatteredReflection::operator()(const scene::Scene& scene, const Model& model, const SurfacePoint& point,
                                    const Vec3& to_view, Crossings& crossings, double& evaluations,
                                    std::vector<LightDepth>* found) const {
  const scene::Material& material = scene.surfaces[point.surface].material;
  const std::vector<double> visibility = transfer_ ? transfer_->visibility(scene, point) : std::vector<double>{};
  std::vector<Rgb> incident(visibility.size(), Rgb::Zero());  // of all lights, where it is to be shadowed
  Rgb radiance = Rgb::Zero();
  for (const LightModel& light : model.lights) {
    const Vec3 offset = light.position - point.position;
    const double distance = offset.norm();
    if (!(distance > 0)) continue;
    const Vec3 to_light = offset / distance;
    const Rgb irradiance = light.intensity / (distance * distance);
    const double depth = light_depth(model, light.position, point.position, crossings, evaluations, found);
    Rgb reflected = Rgb::Zero();
    for (int c = 0; c < 3; ++c) {
      const double T = depth * model.fog.hue[c], share = T * std::exp(-T);
      if (!(T > 0)) continue;
      const bool grey = model.fog.grey();  // one depth for all
      if (!visibility.empty()) {
        const std::vector<double> spread = turned_zonal(bands(T), to_light);
        for (std::size_t i = 0; i < spread.size(); ++i)
          for (int to = c; to <= (grey ? 2 : c); ++to) incident[i][to] += irradiance[to] * share * spread[i];
      } else {
        const Rgb all = reflect_one(material, point, to_view, to_light, T) * share;
        if (grey)
          reflected = all;
        else
          reflected[c] = all[c];
      }
      if (grey) break;
    }
    radiance += irradiance * reflected;
  }
  if (!visibility.empty()) radiance = reflect_harmonics(material, point.normal, to_view, incident, &visibility);
  // Harmonics cut off at a band may swing below 0.
  return (radiance * model.fog.albedo).max(0.0);
}

std::unique_ptr<ScatteredReflection> make_reflection(const scene::Scene& scene, const Options& options, bool tabulate) {
  using Reflectance = Options::Reflectance;
  const bool sun = options.reflectance == Reflectance::sun;
  auto reflection = std::make_unique<ScatteredReflection>(sun ? 1 : options.sh_order,
                                                          options.reflectance == Reflectance::npsf_by_depth);
  if (sun) {
    reflection->use(SunReflection(scene.surfaces));
  } else if (tabulate) {
    std::vector<std::optional<ReflectanceTable>> tables(scene.surfaces.size());
    for (std::size_t i = 0; i < tables.size(); ++i)
      if (!std::holds_alternative<scene::Lambert>(scene.surfaces[i].material))
        tables[i].emplace(scene.surfaces[i].material, options.sh_order);
    reflection->use(std::move(tables));
  }
  return reflection;
}

std::vector<std::string> objections_to_surfaces(const scene::Scene& scene, const Options& options) {
  std::vector<std::string> reasons;
  const bool sun = options.reflectance == Options::Reflectance::sun;
  if (sun && options.prt)
    reasons.push_back(
        "reflectance = sun has no harmonics that a shadow could multiply: prt = true needs npsf or npsfT");
  for (std::size_t i = 0; sun && i < scene.surfaces.size(); ++i)
    if (std::holds_alternative<scene::Tabulated>(scene.surfaces[i].material))
      reasons.push_back(fmt::format("surface {} is tabulated: reflectance = sun knows lambert and phong alone", i));
  if (options.prt && mesh_vertices(scene) > most_transfer_vertices)
    reasons.push_back(fmt::format("prt = true for meshes of {:.0f} vertices, expected {:.0f} at most",
                                  mesh_vertices(scene), most_transfer_vertices));
  return reasons;
}

}  // namespace airlight::fogshop
