#include <catch2/catch.hpp>

#include "scene/geometry/surface.h"
#include "scene/light/lat_long.h"
#include "scene/math/gauss_legendre.h"
#include "tests/scene/geometry_scenes.h"

namespace geometry_surface_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

// Share of the light from `in` that leaves: integral over the hemisphere about +y of f cos. Gauss points in the cosine,
// equal steps around; the lobe of exponent 200 is 0.1 rad wide and spanned by 30 points.
Rgb reflected_share(const Material& material, const Vec3& in) {
  const GaussLegendre rule = gauss_legendre(400);
  Rgb sum = Rgb::Zero();
  for (std::size_t j = 0; j < rule.node.size(); ++j) {
    const double cosine = 0.5 * (1 + rule.node[j]), sine = std::sqrt((1 - cosine) * (1 + cosine));
    for (int i = 0; i < 800; ++i)
      sum += 0.5 * rule.weight[j] * cosine * (2 * pi / 800) *
             brdf(material, Vec3::UnitY(), in, from_lat_long((i + 0.5) / 800, cosine, sine));
  }
  return sum;
}

const std::vector<Material> materials = {Lambert{Rgb(0.2, 0.5, 1)}, Phong{Rgb(0.4, 0, 0.7), Rgb(0.6, 1, 0.1), 0},
                                         Phong{Rgb(0.4, 0, 0.7), Rgb(0.6, 1, 0.1), 1},
                                         Phong{Rgb(0.4, 0, 0.7), Rgb(0.6, 1, 0.1), 200}};

}  // namespace

// At normal incidence the lobe (n+2)/(2 pi) cos^n carries exactly `specular`: the integral of cos^(n+1) over the
// hemisphere is 2 pi/(n+2). Oblique, part of it falls below the horizon.
TEST_CASE("materials reflect what they say at normal incidence and never more", "[geometry][surface]") {
  for (const Material& material : materials) {
    CAPTURE(material.index());
    Rgb full;
    if (const auto* phong = std::get_if<Phong>(&material))
      full = phong->diffuse + phong->specular;
    else
      full = std::get<Lambert>(material).albedo;
    CHECK(reflected_share(material, Vec3::UnitY()).isApprox(full, 1e-6));
    for (const double angle : {0.3, 0.9, 1.4, 1.57}) {
      const Rgb share = reflected_share(material, Vec3(std::sin(angle), std::cos(angle), 0));
      CHECK((share <= full + 1e-6).all());
      CHECK((share >= 0).all());
    }
  }
}

TEST_CASE("reflectance is reciprocal and zero below the horizon", "[geometry][surface]") {
  Random random;
  for (const Material& material : materials)
    for (int i = 0; i < 200; ++i) {
      const Vec3 n = random.direction();
      Vec3 in = random.direction(), out = random.direction();
      if (in.dot(n) < 0) in = -in;
      if (out.dot(n) < 0) out = -out;
      // Rounding of the mirrored direction, 4 ulp, times the exponent.
      CHECK(brdf(material, n, in, out).isApprox(brdf(material, n, out, in), 1e-12));
      CHECK((brdf(material, n, -in, out) == 0).all());
      CHECK((brdf(material, n, in, -out) == 0).all());
      CHECK((brdf(material, n, -in, -out) == 0).all());
    }
}

}  // namespace geometry_surface_test
