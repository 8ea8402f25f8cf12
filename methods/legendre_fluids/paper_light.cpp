#include "methods/legendre_fluids/paper_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/legendre_fluids/lit_media.h"

namespace airlight::legendre_fluids {
namespace {

struct Part {
  const scene::Medium* medium;
  scene::LegendrePointer field;
};
std::vector<Part> parts_of(const scene::Scene& scene) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    if (extinguishes(scene.media[i]) && unsupported_field(scene.media, i).empty())
      parts.push_back({&scene.media[i], field_within_region(scene.media[i])});
  return parts;
}

double mean_cosine_of(const scene::PhaseFunction& phase) {
  const auto* hg = std::get_if<scene::HenyeyGreenstein>(&phase);
  return hg ? hg->g : 0;
}

}  // namespace

bool PaperMedium::alike(std::size_t channel, std::size_t other) const {
  return medium->sigma_t[Eigen::Index(channel)] == medium->sigma_t[Eigen::Index(other)] &&
         (!scattering[0] || scattering[channel]->coefficients() == scattering[other]->coefficients());
}

PaperMedium paper_medium(const scene::Scene& scene) {
  const std::vector<Part> parts = parts_of(scene);
  if (parts.empty()) return {};
  PaperMedium all{parts.back().medium, parts.back().field, {}};
  if (parts.size() == 1) return all;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(all.density->coefficients().size());
  std::array<Eigen::VectorXd, 3> scatters{sum, sum, sum};
  bool one = true;
  for (const Part& part : parts) {
    sum += part.field->coefficients();
    for (std::size_t c = 0; c < 3; ++c)
      scatters[c] += part.medium->albedo[Eigen::Index(c)] * part.field->coefficients();
    one = one && (part.medium->albedo == all.medium->albedo).all();
  }
  const auto field = [&](const Eigen::VectorXd& coefficients) {
    return std::make_shared<const scene::LegendreBox>(all.density->box(), all.density->shape(), coefficients);
  };
  for (std::size_t c = 0; c < 3 && !one; ++c) all.scattering[c] = field(scatters[c]);
  all.density = field(sum);
  return all;
}

std::optional<PaperMedium> kept_medium(const PaperMedium& medium, const scene::Scene& before, const scene::Scene& now) {
  const auto same = [](const scene::Medium& a, const scene::Medium& b) {
    return extinguishes(a) == extinguishes(b) && (a.albedo == b.albedo).all() && same_density(a, b);
  };
  if (!std::equal(before.media.begin(), before.media.end(), now.media.begin(), now.media.end(), same))
    return std::nullopt;
  PaperMedium kept = medium;
  if (medium.medium) kept.medium = &now.media[std::size_t(medium.medium - before.media.data())];
  return kept;
}

std::string several_against(const scene::Scene& scene) {
  const std::vector<Part> parts = parts_of(scene);
  for (const Part& part : parts) {
    const Part& first = parts.front();
    const bool same = part.field && first.field && part.field->box().lo == first.field->box().lo &&
                      part.field->box().hi == first.field->box().hi && part.field->shape() == first.field->shape();
    if (parts.size() > 1 && (!same || (part.medium->sigma_t != first.medium->sigma_t).any() ||
                             part.medium->phase.index() != first.medium->phase.index() ||
                             mean_cosine_of(part.medium->phase) != mean_cosine_of(first.medium->phase)))
      return fmt::format(
          "variant = paper with {} media: found different boxes, sigma_t or phase functions, expected one medium, or "
          "densities that differ in albedo alone",
          parts.size());
  }
  return "";
}

scene::TensorShape intensity_shape(const scene::TensorShape& density, int n, const std::array<bool, 3>& moving) {
  scene::TensorShape shape;
  for (std::size_t a = 0; a < 3; ++a) shape[a] = density[a] == 1 && !moving[a] ? 1 : n;
  return shape;
}

PaperLight::PaperLight(const scene::LegendreBox& box, const PaperOptions& options, const std::array<bool, 3>& moving)
    : box_(&box),
      options_(options),
      product_(box.coefficients(), box.shape(), intensity_shape(box.shape(), options.n, moving), options.truncation) {}

Eigen::VectorXd PaperLight::direct(const Vec3& direction, double sigma, int* iterations) const {
  const LightSystem system(product_, rate(direction), sigma, options_.solver);
  return system.solve(Eigen::VectorXd::Zero(scene::tensor_size(shape())), 1, iterations);
}

Eigen::VectorXd PaperLight::scattered(const Eigen::VectorXd& direct, const Vec3& direction, double sigma,
                                      double scattering, const DensityProduct* what_scatters, int* iterations) const {
  const LightSystem system(product_, rate(direction), sigma, options_.solver);
  return system.solve(scattering * (what_scatters ? *what_scatters : product_)(direct), 0, iterations);
}

Eigen::VectorXd PaperLight::on_face(const Eigen::VectorXd& coefficients, int axis, int side) const {
  const int n = shape()[std::size_t(axis)];
  const Eigen::MatrixXd end = scene::legendre_values(n, Eigen::VectorXd::Constant(1, side)) * std::sqrt(2.0);
  return scene::along_axis(axis, end, coefficients, shape());
}

}  // namespace airlight::legendre_fluids
