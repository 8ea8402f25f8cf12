// Light scattered onto surfaces against quadrature of the exact airlight that they receive.
#include "methods/fogshop/scattered_reflection.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/fogshop.h"
#include "methods/fogshop/harmonic_reflection.h"
#include "methods/fogshop/surface_psf.h"
#include "scene/math/gauss_legendre.h"
#include "scene/scene.h"
#include "tests/methods/fogshop/exact_reflection.h"
#include "tests/pictures.h"

namespace scattered_reflection_test {

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::exact_reflection;

namespace {

const Vec3 normal(0, 1, 0);
const Vec3 to_view = Vec3(0.3, 1, -0.2).normalized();

// Light 1 in these bands around a direction, reflected.
Rgb reflect(const scene::Material& material, const Vec3& to_light, const std::vector<double>& bands) {
  return reflect_zonal(reflectance_harmonics(material, normal, to_view, int(bands.size())), bands, to_light);
}

}  // namespace

// The clamped cosine has no odd bands but the first. The first band that four leave out is l = 4, where its coefficient
// is -0.1108: g_4 0.1108 over sum g_l a_l is 4.8 % for T = 5 and less for thinner media; the next ones alternate in
// sign. From twelve on: l = 12, 0.0136, below 0.6 %. Errors relative to the light from straight above.
TEST_CASE("scattered light on a Lambert surface, by bands", "[fogshop]") {
  const scene::Material lambert = scene::Lambert{Rgb(0.8, 0.5, 0.2)};
  for (const double T : {0.01, 1.0, 5.0}) {
    const double above = exact_reflection(lambert, normal, to_view, normal, T)[0];
    double worst[2] = {0, 0};
    for (const double angle : {0.0, 0.5, 1.0, 1.4, 1.7, 2.2, 3.0}) {
      const Vec3 to_light(std::sin(angle), std::cos(angle), 0);
      const Rgb exact = exact_reflection(lambert, normal, to_view, to_light, T);
      for (int k = 0; k < 2; ++k) {
        std::vector<double> bands;
        for (int l = 0; l < (k == 0 ? 4 : 12); ++l) bands.push_back(npsf_coefficient(l, T));
        const Rgb got = reflect(lambert, to_light, bands);
        CHECK(got[1] == Approx(got[0] * 0.5 / 0.8).epsilon(1e-12));
        worst[k] = std::max(worst[k], std::abs(got[0] - exact[0]) / above);
      }
    }
    CAPTURE(T, worst[0], worst[1]);
    CHECK(worst[0] < 0.048);
    CHECK(worst[1] < 0.006);
  }
}

TEST_CASE("the quadrature over directions is the closed form of Lambert", "[fogshop]") {
  // A Phong material without a lobe is a Lambert one.
  const scene::Material lambert = scene::Lambert{Rgb::Constant(0.6)};
  const scene::Material phong = scene::Phong{Rgb::Constant(0.6), Rgb::Zero(), 5};
  for (int order = 1; order <= 12; ++order) {
    std::vector<double> bands;
    for (int l = 0; l < order; ++l) bands.push_back(npsf_coefficient(l, 1));
    for (const Vec3& to_light : {Vec3(0, 1, 0), Vec3(0.6, 0.8, 0), Vec3(1, 0, 0), Vec3(0, -1, 0)})
      CHECK(reflect(phong, to_light, bands)[0] == Approx(reflect(lambert, to_light, bands)[0]).margin(1e-12));
  }
}

TEST_CASE("scattered light on a Phong surface, by bands", "[fogshop]") {
  const scene::Material phong = scene::Phong{Rgb::Constant(0.3), Rgb::Constant(0.5), 5};
  const double above = exact_reflection(phong, normal, to_view, normal, 1)[0];
  std::vector<double> bands;
  for (int l = 0; l < 12; ++l) bands.push_back(npsf_coefficient(l, 1));
  for (const double angle : {0.0, 0.5, 1.0, 1.4}) {
    const Vec3 to_light(std::sin(angle), std::cos(angle), 0);
    const double exact = exact_reflection(phong, normal, to_view, to_light, 1)[0];
    CHECK(std::abs(reflect(phong, to_light, bands)[0] - exact) < 0.02 * above);
  }
}

TEST_CASE("bands of the depth at hand come from a table", "[fogshop]") {
  const ScatteredReflection fixed(6, false), following(6, true);
  for (const double T : {0.002, 0.03, 0.7, 1.0, 3.3, 25.0})
    for (int l = 0; l < 6; ++l) {
      CHECK(fixed.bands()(T)[l] == Approx(npsf_coefficient(l, 1)).epsilon(1e-12));
      CHECK(following.bands()(T)[l] == Approx(npsf_coefficient(l, T)).epsilon(2e-3));
    }
}

// A floor in constant fog, where the paper's approximation is exact: every pixel against the quadrature, through the
// fog.
TEST_CASE("a floor reflects what constant fog scatters onto it", "[fogshop]") {
  scene::Scene scene;
  scene.name = "floor";
  scene.width = scene.height = 3;
  scene.camera = scene::look_at({0, 2, 4}, {0, 0, 0}, {0, 1, 0});
  const Point3 light(1, 3, 0);
  scene.lights.emplace_back(scene::PointLight{light, Rgb(4, 5, 6), 0});
  scene::Medium fog;
  fog.field = scene::Homogeneous{1};
  fog.sigma_t = Rgb(0.4, 0.2, 0.1);
  fog.albedo = Rgb::Constant(0.9);
  scene.media.push_back(fog);
  const scene::Material material = scene::Lambert{Rgb::Constant(0.7)};
  scene.surfaces.push_back({"floor", scene::Plane{Point3::Zero(), Vec3(0, 1, 0)}, material});
  finish(scene);
  const auto film = [&](const char* reflectance) {
    return airlight::test::render(Fogshop(), scene, {{"reflectance", reflectance}, {"sh_order", "12"}}).film;
  };
  const scene::Film direct = film("direct"), printed = film("npsf"), improved = film("npsfT");
  CHECK_FALSE(direct.has("reflected_airlight"));
  double printed_error = 0;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      const Ray ray = camera_ray(scene.camera, x + 0.5, y + 0.5, 3, 3);
      const scene::RayEnd end = ray_end(scene, ray);
      if (!end.hit) continue;
      const Vec3 offset = light - end.hit->position;
      const double d = offset.norm();
      Rgb expected;
      for (int c = 0; c < 3; ++c) {
        const double T = fog.sigma_t[c] * d;
        expected[c] = 0.9 * (4 + c) / (d * d) * T * std::exp(-T - fog.sigma_t[c] * end.t) *
                      exact_reflection(material, end.hit->normal, -ray.direction, offset / d, T)[0];
      }
      CAPTURE(x, y, expected);
      const Rgb got = improved.get("reflected_airlight", x, y);
      CHECK(((got - expected).abs() < 0.01 * expected.maxCoeff()).all());
      CHECK(((improved.get("surface", x, y) - direct.get("surface", x, y) - got).abs() < 1e-6).all());
      printed_error =
          std::max(printed_error, (printed.get("reflected_airlight", x, y) / expected - 1).abs().maxCoeff());
    }
  CHECK(printed_error > 0.1);  // the fixed PSF is for T = 1; here T goes from 0.3 to 1.5
}

}  // namespace scattered_reflection_test
