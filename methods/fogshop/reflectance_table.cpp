#include "methods/fogshop/reflectance_table.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "methods/fogshop/harmonic_reflection.h"
#include "scene/geometry/brdf_table.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/sh_rotation.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::fogshop {
namespace {

// Over the cells of the table, in each of which the reflectance is a polynomial of the angles.
std::vector<Rgb> tabulated_harmonics(const scene::BrdfTable& table, double theta_out, int order) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(4);
  const double step = 0.5 * pi / (table.thetas() - 1), turn = pi / (table.phis() - 1);
  std::vector<Rgb> result(order * order, Rgb::Zero());
  std::vector<double> basis(order * order);
  for (int i = 0; i < 4 * (table.thetas() - 1); ++i) {
    const double theta = step * (i / 4 + 0.5 * (1 + rule.node[i % 4])), s = std::sin(theta), c = std::cos(theta);
    for (int k = 0; k < 4 * (table.phis() - 1); ++k) {
      const double phi = turn * (k / 4 + 0.5 * (1 + rule.node[k % 4]));
      const double weight = 0.25 * step * turn * rule.weight[i % 4] * rule.weight[k % 4] * s * c;
      const Rgb value = table.at(theta, theta_out, phi) * (2 * weight);  // both sides of the plane y = 0
      scene::evaluate_sh(order, Vec3(s * std::cos(phi), s * std::sin(phi), c), basis.data());
      for (int l = 0; l < order; ++l)
        for (int m = 0; m <= l; ++m) result[scene::sh_index(l, m)] += value * basis[scene::sh_index(l, m)];
    }
  }
  return result;
}

}  // namespace

ReflectanceTable::ReflectanceTable(const scene::Material& material, int order) : order_(order), entries_(193) {
  const auto* tabulated = std::get_if<scene::Tabulated>(&material);
  if (tabulated) entries_ = tabulated->table->thetas();
  for (int i = 0; i < entries_; ++i) {
    // The last view grazes: the harmonics there are a limit.
    const double theta = std::min(0.5 * pi * i / (entries_ - 1), 0.5 * pi - 1e-9);
    const std::vector<Rgb> entry =
        tabulated ? tabulated_harmonics(*tabulated->table, 0.5 * pi * i / (entries_ - 1), order)
                  : reflectance_harmonics(material, Vec3::UnitZ(), Vec3(std::sin(theta), 0, std::cos(theta)), order);
    values_.insert(values_.end(), entry.begin(), entry.end());
  }
}

std::vector<Rgb> ReflectanceTable::harmonics(double theta_out) const {
  const double x = std::clamp(theta_out / (0.5 * pi), 0.0, 1.0) * (entries_ - 1);
  const int i = std::min(entries_ - 2, int(x)), size = order_ * order_;
  std::vector<Rgb> result(size);
  for (int k = 0; k < size; ++k)
    result[k] = (1 - (x - i)) * values_[std::size_t(i) * size + k] + (x - i) * values_[std::size_t(i + 1) * size + k];
  return result;
}

std::vector<Rgb> ReflectanceTable::turned(const Vec3& normal, const Vec3& to_view) const {
  const double cosine = normal.dot(to_view);
  if (!(cosine > 0)) return std::vector<Rgb>(std::size_t(order_) * order_, Rgb::Zero());
  const Vec3 aside = to_view - cosine * normal;
  const double sine = aside.norm();
  Mat3 frame;
  frame.col(0) = sine > 1e-12 ? Vec3(aside / sine) : Vec3(normal.unitOrthogonal());
  frame.col(1) = normal.cross(frame.col(0));
  frame.col(2) = normal;
  return scene::turned_sh(harmonics(std::atan2(sine, cosine)), frame);
}

SurfaceReflectances::SurfaceReflectances(const std::vector<scene::Surface>& surfaces, int order)
    : order_(order), tables_(surfaces.size()) {
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (!std::holds_alternative<scene::Lambert>(surfaces[i].material)) tables_[i].emplace(surfaces[i].material, order);
}

std::vector<Rgb> SurfaceReflectances::operator()(const scene::Scene& scene, int surface, const Vec3& normal,
                                                 const Vec3& to_view) const {
  return tables_[surface] ? tables_[surface]->turned(normal, to_view)
                          : reflectance_harmonics(scene.surfaces[surface].material, normal, to_view, order_);
}

}  // namespace airlight::fogshop
