#include "scene/geometry/surface.h"

#include <cmath>

#include "scene/geometry/brdf_table.h"

namespace airlight::scene {
namespace {

Rgb value(const Lambert& material, const Vec3&, const Vec3&, const Vec3&) { return material.albedo / pi; }

// Lafortune and Willems 1994: the lobe carries at most `specular`, all of it at normal incidence.
Rgb value(const Phong& material, const Vec3& normal, const Vec3& in, const Vec3& out) {
  const Vec3 mirrored = 2 * normal.dot(in) * normal - in;
  const double cosine = std::max(0.0, mirrored.dot(out));
  const double lobe = (material.exponent + 2) / (2 * pi) * std::pow(cosine, material.exponent);
  return material.diffuse / pi + material.specular * lobe;
}

Rgb value(const Tabulated& material, const Vec3& normal, const Vec3& in, const Vec3& out) {
  return (*material.table)(normal, in, out);
}

}  // namespace

Rgb brdf(const Material& material, const Vec3& normal, const Vec3& in, const Vec3& out) {
  if (!(normal.dot(in) > 0) || !(normal.dot(out) > 0)) return Rgb::Zero();
  return std::visit([&](const auto& kind) { return value(kind, normal, in, out); }, material);
}

}  // namespace airlight::scene
