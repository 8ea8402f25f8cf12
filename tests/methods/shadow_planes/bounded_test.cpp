// Media in convex regions against brute force.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/shadow_planes/bounded_media.h"
#include "scene/math/gauss_legendre.h"

namespace bounded_test {

using namespace airlight;
using namespace airlight::shadow_planes;

namespace {

const auto everywhere = [](const Vec3&) { return 1.0; };

// Midpoint rule between the faces of the regions, with the scene's own optical depths.
Rgb brute_force(const std::vector<scene::Medium>& media, const Ray& ray, const Point3& light, double length) {
  std::vector<double> faces = {0, length};
  for (const scene::Medium& m : media)
    if (const Interval inside = clip(m.region, ray, {0, length}); inside.lo < inside.hi)
      faces.insert(faces.end(), {inside.lo, inside.hi});
  std::sort(faces.begin(), faces.end());
  constexpr int steps = 100000;
  Rgb all = Rgb::Zero();
  for (std::size_t k = 0; k + 1 < faces.size(); ++k) {
    Rgb sum = Rgb::Zero();
    for (int i = 0; i < steps; ++i) {
      const double t = faces[k] + (faces[k + 1] - faces[k]) * (i + 0.5) / steps;
      const Vec3 offset = ray.at(t) - light;
      const double r = offset.norm();
      const Rgb seen = transmittance(media, ray, {0, t}) * transmittance(media, {light, offset / r}, {0, r}) / (r * r);
      for (const scene::Medium& m : media)
        sum += m.albedo * m.sigma_t * density(m, ray.at(t)) *
               scene::phase_value(m.phase, -offset.dot(ray.direction) / r) * seen;
    }
    all += sum * ((faces[k + 1] - faces[k]) / steps);
  }
  return all;
}

}  // namespace

// Three that tint one another, overlapping, with a thin one everywhere and phase functions of their own.
TEST_CASE("shadow planes: media that tint one another", "[shadow_planes]") {
  std::vector<scene::Medium> media(4);
  media[0].region = Box{{-1, -1, 2}, {1, 0.5, 4}};
  media[0].sigma_t = Rgb(0.8, 0.1, 0.1);
  media[1].region = scene::Sphere{{0.5, 0.3, 4}, 1};
  media[1].sigma_t = Rgb(0.1, 0.9, 0.1);
  media[1].phase = scene::HenyeyGreenstein{0.6};
  media[2].region = scene::Slab{Vec3(0.1, 0.2, 1).normalized(), 5, 6.5};
  media[2].sigma_t = Rgb(0, 0.1, 0.7);
  media[2].phase = scene::Rayleigh{};
  media[3].sigma_t = Rgb::Constant(0.02);
  const BoundedMedia bounded(media);
  const MappedRule<double> rule(64, 6, true);
  for (const Point3& light : {Point3(0.2, 3, 3), Point3(0.4, 0.6, 4.2), Point3(-2, -1.5, 9)})
    for (const Vec3& direction : {Vec3(0.02, 0.01, 1), Vec3(0.2, 0.05, 1), Vec3(-0.1, -0.15, 1)}) {
      const Ray ray{{0, 0, 0}, direction.normalized()};
      const Rgb got = bounded.airlight(rule, ray, light, {0, 12}, everywhere);
      const Rgb expected = brute_force(media, ray, light, 12);
      CAPTURE(light.transpose(), direction.transpose(), got, ((got - expected) / expected).eval());
      CHECK(((got - expected).abs() < 1e-7 * expected).all());
    }
}

}  // namespace bounded_test
