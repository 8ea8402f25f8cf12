#include "methods/fogshop/paper_airlight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "methods/fogshop/homogeneous_airlight.h"

namespace airlight::fogshop {

double optical_depth(const scene::Gaussian& g, const Point3& a, const Point3& b) {
  const double d = (b - a).norm();
  return d > 0 ? scene::line_integral(g, {a, (b - a) / d}, d) : 0;
}

double optical_depth(const scene::GaussianSum& medium, const Point3& a, const Point3& b) {
  double depth = medium.constant * (b - a).norm();
  for (const scene::Gaussian& g : medium.gaussians) depth += optical_depth(g, a, b);
  return depth;
}

double relative_phase(double g, double cosine) {
  const double square = 1 + g * g - 2 * g * cosine;
  return g == 0 ? 1 : (1 - g * g) / (square * std::sqrt(square));
}

double paper_airlight(const scene::GaussianSum& medium, const Point3& s, double intensity, const Ray& ray, double d_r,
                      const PaperOptions& options) {
  const Point3& v = ray.origin;
  const double soft2 = options.source_radius * options.source_radius;
  double airlight = 0;

  // Gaussian terms, Eqs. 9 to 13.
  for (const scene::Gaussian& gaussian : medium.gaussians) {
    const Point3& b = gaussian.center;
    // Eq. 10; the projection is restricted to the segment, here and in all of f^0.
    const Point3 b_r = ray.at(std::clamp((b - v).dot(ray.direction), 0.0, d_r));
    // The exponents of f^0 (Eq. 12) and f^1 (Eq. 13) are added before the exponential: each alone may overflow.
    const double exponent = -optical_depth(gaussian, s, b_r) - optical_depth(gaussian, v, b_r) +
                            optical_depth(gaussian, s, b) + optical_depth(gaussian, v, b) -
                            optical_depth(medium, s, b) - optical_depth(medium, v, b);
    const double depth = scene::line_integral(gaussian, ray, d_r);  // Eq. 31
    // The phase function takes the cosine of the angle by which light turns; the text's alpha has the other sign.
    const double phase = relative_phase(options.g, -(b_r - s).normalized().dot(ray.direction));
    // A light at b_r makes the next factor infinite, and 0 times that is no number.
    if (depth > 0)
      airlight += intensity * phase / (4 * pi * ((b_r - s).squaredNorm() + soft2)) * std::exp(exponent) * depth;
  }

  // Homogeneous term, Eqs. 14 to 17.
  if (medium.constant > 0) {
    const Vec3 to_light = s - v;
    // d_sv cos gamma and d_sv sin gamma of the text.
    const LightFromRay seen{to_light.dot(ray.direction), ray.direction.cross(to_light).norm()};
    const double c_sv = std::exp(-optical_depth(medium, s, v) + medium.constant * to_light.norm());
    const double homogeneous = options.f_table
                                   ? options.f_table->homogeneous_airlight(seen, d_r, medium.constant)
                                   : softened_homogeneous_airlight(seen, d_r, medium.constant, options.source_radius);
    airlight += intensity * c_sv * homogeneous;
  }
  return airlight;
}

}  // namespace airlight::fogshop
