// The table of reflectances in harmonics against quadrature over directions.
#include "methods/fogshop/reflectance_table.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/fogshop.h"
#include "methods/fogshop/harmonic_reflection.h"
#include "methods/fogshop/surface_psf.h"
#include "scene/geometry/brdf_table.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"
#include "scene/scene.h"
#include "tests/pictures.h"

namespace reflectance_table_test {

using namespace airlight;
using namespace airlight::fogshop;

namespace {

// Integral of brdf * cosine * (zonal function of these bands about to_light), 180 x 720 directions of the hemisphere.
Rgb by_quadrature(const scene::Material& material, const Vec3& normal, const Vec3& to_view, const Vec3& to_light,
                  const std::vector<double>& bands) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(180);
  const Vec3 a = normal.unitOrthogonal(), b = normal.cross(a);
  std::vector<Rgb> light;
  for (const double c : turned_zonal(bands, to_light)) light.push_back(Rgb::Constant(c));
  Rgb sum = Rgb::Zero();
  for (int i = 0; i < 180; ++i)
    for (int k = 0; k < 720; ++k) {
      const double theta = 0.25 * pi * (1 + rule.node[i]), phi = 2 * pi * (k + 0.5) / 720;
      const Vec3 in = std::cos(theta) * normal + std::sin(theta) * (std::cos(phi) * a + std::sin(phi) * b);
      sum += scene::brdf(material, normal, in, to_view) * scene::evaluate_sh(light, in) *
             (std::cos(theta) * std::sin(theta) * 0.25 * pi * rule.weight[i] * 2 * pi / 720);
    }
  return sum;
}

scene::Material satin() {
  const std::string path = std::string(AIRLIGHT_SOURCE_DIR) + "/experiments/data/synthetic_satin.brdf";
  return scene::Tabulated{std::make_shared<const scene::BrdfTable>(scene::read_brdf_table(path))};
}

}  // namespace

TEST_CASE("reflectances in harmonics come from a table", "[fogshop]") {
  const Vec3 normal = Vec3(0.3, 0.8, -0.4).normalized(), side = normal.unitOrthogonal();
  const scene::Material phong = scene::Phong{Rgb(0.3, 0.2, 0.1), Rgb(0.2, 0.4, 0.6), 30};
  for (const int order : {4, 6}) {
    std::vector<double> bands;
    for (int l = 0; l < order; ++l) bands.push_back(npsf_coefficient(l, 0.6));
    for (const scene::Material& material : {phong, satin()}) {
      const ReflectanceTable table(material, order);
      for (const double angle : {0.0, 0.37, 0.9, 1.3, 1.55})
        for (const Vec3& to_light : {Vec3(normal), Vec3(Vec3(0.9, 0.1, 0.3).normalized())}) {
          const Vec3 to_view = std::cos(angle) * normal + std::sin(angle) * side;
          const Rgb expected = by_quadrature(material, normal, to_view, to_light, bands);
          const Rgb got = reflect_zonal(table.turned(normal, to_view), bands, to_light);
          CAPTURE(order, material.index(), angle, got, expected);
          CHECK(((got - expected).abs() < 5e-4).all());  // of light about 0.1 to 0.5
        }
      CHECK((reflect_zonal(table.turned(normal, -normal), bands, normal) == 0).all());
    }
  }
}

// The sum of all bands of a furnace: the albedo of the table, which is exact.
TEST_CASE("a furnace in harmonics returns the albedo", "[fogshop]") {
  const scene::Material material = satin();
  const auto& table = *std::get<scene::Tabulated>(material).table;
  const ReflectanceTable harmonics(material, 5);
  for (const double theta : {0.0, 0.5, 1.2, 1.5}) {
    const Rgb share = harmonics.harmonics(theta)[0] * std::sqrt(4 * pi);
    CAPTURE(theta, share, table.albedo(theta));
    CHECK(((share - table.albedo(theta)).abs() < 1e-6).all());  // four points per cell, error of sin cos
  }
}

// A whole picture with a tabulated floor: the renderer's reflected light is that of the quadrature.
TEST_CASE("a tabulated floor reflects scattered light", "[fogshop]") {
  scene::Scene scene;
  scene.name = "floor";
  scene.width = scene.height = 2;
  scene.camera = scene::look_at({0, 2, 1}, {0, 0, 0}, {0, 1, 0});
  const Point3 light(1, 3, 0);
  scene.lights.emplace_back(scene::PointLight{light, Rgb(4, 5, 6), 0});
  scene::Medium fog;
  fog.field = scene::Homogeneous{0.3};
  scene.media.push_back(fog);
  scene.surfaces.push_back({"floor", scene::Plane{Point3::Zero(), Vec3(0, 1, 0)}, satin()});
  finish(scene);
  const Fogshop method;
  const scene::Film film = airlight::test::render(method, scene, {{"reflectance", "npsfT"}, {"sh_order", "6"}}).film;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      const Ray ray = camera_ray(scene.camera, x + 0.5, y + 0.5, 2, 2);
      const auto hit = scene.geometry->first_hit(ray);
      REQUIRE(hit);
      const Vec3 offset = light - hit->position;
      const double d = offset.norm(), T = 0.3 * d;
      std::vector<double> bands;
      for (int l = 0; l < 6; ++l) bands.push_back(npsf_coefficient(l, T));
      const Rgb expected = Rgb(4, 5, 6) / (d * d) * (T * std::exp(-T - 0.3 * hit->t)) *
                           by_quadrature(satin(), hit->normal, -ray.direction, offset / d, bands);
      CHECK(((film.get("reflected_airlight", x, y) - expected).abs() < 3e-3 * expected.maxCoeff()).all());
    }
  CHECK_FALSE(method.supports(scene, scene::Settings(method.settings(), {{"reflectance", "sun"}})).empty());
}

}  // namespace reflectance_table_test
