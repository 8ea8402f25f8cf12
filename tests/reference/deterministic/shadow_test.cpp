#include "reference/deterministic/shadow.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "reference/deterministic/airlight.h"
#include "reference/deterministic/renderer.h"
#include "scene/geometry/shapes.h"

namespace shadow_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

Scene foggy(std::vector<Surface> surfaces, std::vector<Light> lights, double sigma = 0.5) {
  Scene s;
  Medium m;
  m.sigma_t = Rgb::Constant(sigma);
  m.region = Slab{Vec3::UnitZ(), 0, 10};
  s.media = {m};
  s.lights = std::move(lights);
  s.surfaces = std::move(surfaces);
  finish(s);
  return s;
}

// 1/(4 pi) int_a^b sigma exp(-sigma z) dz: airlight of a stretch of the z axis, isotropic, before the light path's
// loss.
double between(double sigma, double a, double b) { return (std::exp(-sigma * a) - std::exp(-sigma * b)) / (4 * pi); }

const Ray along_z{Point3::Zero(), Vec3::UnitZ()};

// A column of fog of half-width 1 around the z axis and a sun from +x: every light path is 1 long.
Scene column(std::vector<Surface> surfaces, double sigma) {
  Scene s = foggy(std::move(surfaces), {DirectionalLight{Vec3::UnitX(), Rgb::Ones()}}, sigma);
  s.media[0].region = Box{Point3(-1, -1, 0), Point3(1, 1, 10)};
  return s;
}

}  // namespace

// The shadow of a ball of radius 0.7 at distance 5: the ray is dark for |z - 4| < 0.7, exactly.
TEST_CASE("a ball's shadow is cut where it begins", "[deterministic]") {
  const double sigma = 0.3;
  const Scene s = column({{"ball", Sphere{Point3(5, 0, 4), 0.7}, Lambert{}}}, sigma);
  const double expected = std::exp(-sigma) * (between(sigma, 0, 3.3) + between(sigma, 4.7, 10));
  CHECK(deterministic::airlight(s, along_z, 10).radiance[0] == Approx(expected).epsilon(1e-10));
}

// A box's shadow, and a box made of ten thousand triangles' worth of height field: edges are found exactly too.
TEST_CASE("shadows of meshes are cut at their edges", "[deterministic]") {
  const double sigma = 0.3;
  const Scene s = column({{"box", make_box(Box{Point3(3, -0.5, 2.25), Point3(4, 0.5, 2.26)}), Lambert{}},
                          {"bar", make_box(Box{Point3(3, -0.5, 7.123), Point3(4, 0.5, 8.5)}), Lambert{}}},
                         sigma);
  const double expected =
      std::exp(-sigma) * (between(sigma, 0, 2.25) + between(sigma, 2.26, 7.123) + between(sigma, 8.5, 10));
  CHECK(deterministic::airlight(s, along_z, 10).radiance[0] == Approx(expected).epsilon(1e-10));
}

// A point light at (4, 0, 5) behind a gap between two boxes at x = 2: it sees z in 5 +- 2 * 0.25 of the axis. Without
// attenuation to speak of (sigma 1e-6): sigma/(4 pi) int dz / (16 + (z-5)^2) = sigma/(4 pi) 2 atan(0.5/4)/4.
TEST_CASE("a point light through a gap", "[deterministic]") {
  const double sigma = 1e-9;
  const Scene s = foggy({{"left", make_box(Box{Point3(2, -1, -9), Point3(2.001, 1, 4.75)}), Lambert{}},
                         {"right", make_box(Box{Point3(2, -1, 5.25), Point3(2.001, 1, 19)}), Lambert{}}},
                        {PointLight{Point3(4, 0, 5), Rgb::Ones(), 0}}, sigma);
  // The far edges of the boxes, at x = 2.001, are nearer to the light and cut the cone: half-height 0.25 at
  // distance 1.999 would show more, 0.25 at 2 shows 0.5 on the axis, so that the near edge decides.
  const double expected = sigma / (4 * pi) * 2 * std::atan(0.5 / 4) / 4;
  CHECK(deterministic::airlight(s, along_z, 10).radiance[0] == Approx(expected).epsilon(1e-7));
}

// A finely cut plate against the same plate of twelve triangles; above the limit of exact search the boundary is
// bisected.
TEST_CASE("a large mesh gives the shadow of a small one", "[deterministic]") {
  const double sigma = 0.3;
  HeightField field;
  field.nx = field.nz = 121;  // 28 800 triangles
  field.origin = Point3(3, 0.2, 3);
  field.spacing_x = field.spacing_z = 1.0 / 120;
  field.heights.assign(std::size_t(field.nx) * field.nz, 0.0);
  const auto scene_with = [&](const TriangleMesh& mesh) {
    Scene s =
        foggy({{"plate", mesh, Lambert{}}}, {DirectionalLight{Vec3(1, 0.0571, 0).normalized(), Rgb::Ones()}}, sigma);
    s.media[0].region = Box{Point3(-1, -1, 0), Point3(1, 1, 10)};
    return s;
  };
  const Scene fine = scene_with(make_height_field(field));
  const Scene coarse = scene_with(make_box(Box{Point3(3, 0.2, 3), Point3(4, 0.2 + 1e-9, 4)}));
  const double one = deterministic::airlight(coarse, along_z, 10).radiance[0];
  const double expected =
      std::exp(-sigma * std::sqrt(1 + 0.0571 * 0.0571)) * (between(sigma, 0, 3) + between(sigma, 4, 10));
  CHECK(one == Approx(expected).epsilon(1e-9));
  // Shadow boundaries by bisection of queries that are decided in double: the triangulation's own rounding, 1e-7, is
  // allowed.
  CHECK(deterministic::airlight(fine, along_z, 10).radiance[0] == Approx(one).epsilon(1e-6));
}

// A Lambert plane at z = 5 seen and lit along z through fog: albedo/pi E exp(-2 tau); its ambient and transmittance
// layers.
TEST_CASE("surfaces are lit and seen through the medium", "[deterministic]") {
  Scene s = foggy({{"wall", Plane{Point3(0, 0, 5), Vec3::UnitZ()}, Lambert{Rgb(0.2, 0.4, 0.8)}}},
                  {DirectionalLight{-Vec3::UnitZ(), Rgb::Constant(3)}}, 0.5);
  s.media[0].sigma_t = Rgb(0.25, 0.5, 1.0);
  s.ambient_in_scatter = Rgb(0.1, 0.2, 0.3);
  s.camera = {};
  s.camera.forward = Vec3::UnitZ();
  s.camera.right = -Vec3::UnitX();
  s.width = s.height = 1;
  finish(s);
  const auto renderer = deterministic::make_renderer();
  const Settings settings(renderer->settings(), {});
  const auto rendering = renderer->prepare(std::make_shared<Scene>(s), settings, {})->render(view_of(s), {});
  const Film& film = rendering.film;
  for (int c = 0; c < 3; ++c) {
    const double tau = 5 * s.media[0].sigma_t[c];
    const double albedo = std::get<Lambert>(s.surfaces[0].material).albedo[c];
    CHECK(film.get("transmittance", 0, 0)[c] == Approx(std::exp(-tau)).epsilon(1e-6));
    CHECK(film.get("surface", 0, 0)[c] == Approx(albedo / pi * 3 * std::exp(-2 * tau)).epsilon(1e-6));
    CHECK(film.get("ambient", 0, 0)[c] == Approx(s.ambient_in_scatter[c] * (1 - std::exp(-tau))).epsilon(1e-6));
    CHECK(film.get("airlight", 0, 0)[c] == Approx(3 / (4 * pi) * (1 - std::exp(-2 * tau)) / 2).epsilon(1e-6));
    CHECK(film.get("mean", 0, 0)[c] ==
          Approx(film.get("surface", 0, 0)[c] + film.get("ambient", 0, 0)[c] + film.get("airlight", 0, 0)[c])
              .epsilon(1e-6));
  }
  CHECK(rendering.counters.at("pixels over tolerance") == 0);
}

TEST_CASE("a light on the camera in fog is refused, in clear air it is not", "[deterministic]") {
  Scene s = foggy({}, {PointLight{Point3(0, 0, 5), Rgb::Ones(), 0}});
  s.camera.position = Point3(0, 0, 5);
  finish(s);
  const auto renderer = deterministic::make_renderer();
  const Settings settings(renderer->settings(), {});
  CHECK(renderer->supports(s, settings).size() == 1);
  s.camera.position = Point3(0, 0, -5);
  CHECK(renderer->supports(s, settings).empty());
  s.lights = {PointLight{Point3(0, 0, -5), Rgb::Ones(), 0}};
  CHECK(renderer->supports(s, settings).empty());
}

TEST_CASE("a tolerance that is not met is counted", "[deterministic]") {
  Scene s = foggy({}, {PointLight{Point3(0, 0.5, 5), Rgb::Ones(), 0}}, 3);
  s.camera.forward = Vec3::UnitZ();
  s.camera.right = -Vec3::UnitX();
  s.width = s.height = 2;
  const auto renderer = deterministic::make_renderer();
  const Settings settings(renderer->settings(), {{"max_evaluations", "60"}});
  const auto r = renderer->prepare(std::make_shared<Scene>(s), settings, {})->render(view_of(s), {});
  CHECK(r.counters.at("pixels over tolerance") == 4);
  CHECK(r.film.get("error", 0, 0).maxCoeff() > 1e-10 * r.film.get("airlight", 0, 0).maxCoeff());
}

// A spot's flux: through fog of no extinction to speak of, a ray across the cone sees only what lies within
// outer_angle.
TEST_CASE("a spot of a ten-thousandth of a radian is not missed", "[deterministic]") {
  for (const double angle : {1e-4, 0.1, 1.0}) {
    SpotLight spot{Point3(3, 0, 5), -Vec3::UnitX(), angle, angle, Rgb::Constant(2), 0};
    const Scene s = foggy({}, {spot}, 1e-9);
    // int over |z - 5| < 3 tan(angle) of 2 sigma/(4 pi) / (9 + (z-5)^2) = 2 sigma/(4 pi) 2 angle/3.
    CHECK(deterministic::airlight(s, along_z, 10).radiance[0] == Approx(2e-9 / (4 * pi) * 2 * angle / 3).epsilon(1e-7));
  }
}

}  // namespace shadow_test
