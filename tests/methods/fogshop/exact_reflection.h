// Light that a homogeneous medium scatters onto a surface, reflected, by plain quadrature.
#pragma once
#include <Eigen/Geometry>
#include <cmath>

#include "methods/fogshop/surface_psf.h"
#include "scene/geometry/surface.h"
#include "scene/math/gauss_legendre.h"

namespace fogshop_test {

using namespace airlight;

// Integral of brdf * cosine * NPSF_T over the hemisphere, in coordinates around the light; gamma = pi x^4 takes the
// NPSF's peak.
inline Rgb exact_reflection(const scene::Material& material, const Vec3& normal, const Vec3& to_view,
                            const Vec3& to_light, double T) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(160);
  const Vec3 a = to_light.unitOrthogonal(), b = to_light.cross(a);
  Rgb sum = Rgb::Zero();
  constexpr int around = 720;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double x = 0.5 * (1 + rule.node[i]), gamma = pi * x * x * x * x;
    const double ring =
        0.5 * rule.weight[i] * 4 * pi * x * x * x * fogshop::npsf(gamma, T) * std::sin(gamma) * 2 * pi / around;
    for (int k = 0; k < around; ++k) {
      const double phi = 2 * pi * (k + 0.5) / around;
      const Vec3 in = std::cos(gamma) * to_light + std::sin(gamma) * (std::cos(phi) * a + std::sin(phi) * b);
      const double cosine = normal.dot(in);
      if (cosine > 0) sum += scene::brdf(material, normal, in, to_view) * (cosine * ring);
    }
  }
  return sum;
}

}  // namespace fogshop_test
