// Precomputed visibility of meshes against closed forms.
#include "methods/fogshop/radiance_transfer.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/fogshop.h"
#include "reference/path_tracer/renderer.h"
#include "scene/geometry/shapes.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"
#include "tests/pictures.h"

namespace radiance_transfer_test {

using namespace airlight;
using namespace airlight::fogshop;

namespace {

scene::Scene floor_scene() {
  scene::Scene scene;
  scene.name = "floor";
  scene.width = 6;
  scene.height = 4;
  scene.camera = scene::look_at({0, 2, 4}, {0, 0, 0}, {0, 1, 0});
  scene.lights.emplace_back(scene::PointLight{{1, 3, 0}, Rgb(4, 5, 6), 0});
  scene::Medium fog;
  fog.field = scene::Homogeneous{1};
  fog.sigma_t = Rgb(0.4, 0.2, 0.1);
  scene.media.push_back(fog);
  scene::TriangleMesh mesh;
  mesh.vertices = {{-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.surfaces.push_back({"floor", mesh, scene::Lambert{Rgb::Constant(0.7)}});
  return scene;
}

const SurfacePoint on_floor{{0.3, 0, 0.2}, {0, 1, 0}, 0, 0};

scene::Film render(const scene::Scene& scene, std::map<std::string, std::string> values, int threads = 1) {
  return airlight::test::render(Fogshop(), scene, values, threads).film;
}

}  // namespace

// Under an endless ceiling that slopes so that it hides directions d with d . m > 0 (m its normal, on the far side), a
// floor of normal +y sees what is above the horizon and not hidden; below the horizon counts as open. Hidden is the
// lune between the two half-spaces: of y_lm its integral, by quadrature in coordinates about the lune's edge (the z
// axis), where it is a range of azimuth and of all polar angles.
TEST_CASE("a floor under a half-space hides a lune", "[fogshop]") {
  constexpr int order = 6;
  // m = (cos a, sin a, 0): the lune from azimuth max(0, a - pi/2) to min(pi, a + pi/2).
  for (const double a : {0.5 * pi, 0.9, 0.2}) {
    scene::Scene scene = floor_scene();
    const Vec3 m(std::cos(a), std::sin(a), 0);
    scene.surfaces.push_back({"ceiling", scene::Plane{Point3(0, 0, 0) + 20 * m, m}, scene::Lambert{}});
    finish(scene);
    const RadianceTransfer transfer(scene, order, 16384, infinity, 0, {1, {}});
    const std::vector<double> got = transfer.visibility(scene, on_floor);
    REQUIRE(got.size() == order * order);
    const double from = std::max(0.0, a - 0.5 * pi), to = std::min(pi, a + 0.5 * pi);
    std::vector<double> hidden(order * order, 0.0);
    const scene::GaussLegendre rule = scene::gauss_legendre(200);
    for (int i = 0; i < 200; ++i)
      for (int k = 0; k < 200; ++k) {
        const double z = rule.node[i], r = std::sqrt((1 - z) * (1 + z));
        const double phi = from + (to - from) * 0.5 * (1 + rule.node[k]);
        const std::vector<double> y = scene::evaluate_sh(order, Vec3(r * std::cos(phi), r * std::sin(phi), z));
        for (std::size_t n = 0; n < y.size(); ++n)
          hidden[n] += rule.weight[i] * rule.weight[k] * 0.5 * (to - from) * y[n];
      }
    CHECK(hidden[0] == Approx(2 * (to - from) / std::sqrt(4 * pi)).epsilon(1e-12));  // a lune of 2 (to - from)
    for (int n = 0; n < order * order; ++n) {
      CAPTURE(a, n);
      // The spiral's error at a boundary of length 2 pi: about N^(-3/4) = 7e-4 of the sphere, times |y| below 2.
      CHECK(got[n] == Approx((n == 0 ? std::sqrt(4 * pi) : 0.0) - hidden[n]).margin(5e-3));
    }
  }
}

// A sheet of n x n quads between three corners.
scene::TriangleMesh sheet(const Point3& corner, const Vec3& u, const Vec3& v, int n) {
  scene::TriangleMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) mesh.vertices.push_back(corner + u * i / n + v * k / n);
  const auto at = [&](int i, int k) { return i * (n + 1) + k; };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return mesh;
}

// Section 4.3. Under an even sky of 1 an endless wall on an endless floor sees half of it, E = pi/2, and fills half of what
// a patch of the floor sees: that gets rho E / pi over half its hemisphere, rho pi / 4.
TEST_CASE("a wall reflects the sky onto what lies before it", "[fogshop]") {
  const Rgb rho(0.9, 0.6, 0.2);
  scene::Scene scene = floor_scene();
  scene.surfaces = {{"floor", scene::Plane{}, scene::Lambert{}},
                    {"wall", sheet({0, 0.01, -900}, {0, 900, 0}, {0, 0, 1800}, 1), scene::Lambert{rho}},
                    {"patch", sheet({0.4, 0.05, -0.1}, {0, 0, 0.2}, {0.2, 0, 0}, 1), scene::Phong{Rgb::Constant(0.5)}}};
  finish(scene);
  SurfacePoint point{{0.5, 0.05, 0.01}, {0, 1, 0}, 2, 0};
  const auto reflected = [&](int bounces) {
    return RadianceTransfer(scene, 6, 4096, infinity, bounces, {1, {}}).reflected(scene, point);
  };
  CHECK(reflected(0).empty());
  const std::vector<Rgb> once = reflected(1), twice = reflected(2);
  REQUIRE(once.size() == 36);
  for (int c = 0; c < 3; ++c) {
    // Half a sky in 6 bands of harmonics, and the spiral's error.
    CHECK(std::sqrt(4 * pi) * once[0][c] == Approx(rho[c] * pi / 4).epsilon(0.01));
    // Light that comes back from the patch is next to nothing.
    CHECK(twice[0][c] == Approx(once[0][c]).epsilon(1e-3));
  }
  point.normal = -point.normal;  // its inner side
  CHECK(RadianceTransfer(scene, 6, 256, infinity, 1, {1, {}}).reflected(scene, point).empty());
}

TEST_CASE("light between surfaces comes closer to the path tracer with every bounce", "[fogshop]") {
  scene::Scene scene = floor_scene();
  scene.lights = {scene::make_constant_environment(Rgb::Ones())};
  scene.media.clear();
  scene.camera = scene::look_at({2.6, 1.4, 2.6}, {0.3, 0.4, 0.3}, {0, 1, 0});
  scene.width = 12;
  scene.height = 9;
  const scene::Lambert bright{Rgb::Constant(0.8)};
  scene.surfaces = {{"floor", sheet({0, 0, 0}, {0, 0, 3}, {3, 0, 0}, 12), bright},
                    {"left", sheet({0.001, 0.001, 0}, {0, 3, 0}, {0, 0, 3}, 12), bright},
                    {"back", sheet({0, 0.001, 0.001}, {3, 0, 0}, {0, 3, 0}, 12), bright}};
  finish(scene);
  const auto shared = std::make_shared<const scene::Scene>(scene);
  const path_tracer::PathTracer tracer;
  const scene::Film truth = airlight::test::picture(tracer, shared, {{"samples", "256"}});
  double before = infinity;
  for (const auto& [bounces, most] : {std::pair("0", 0.6), {"1", 0.3}, {"2", 0.16}, {"6", 0.05}}) {
    const scene::Film film =
        airlight::test::picture(Fogshop(), shared, {{"prt", "true"}, {"prt_rays", "512"}, {"prt_bounces", bounces}});
    const double error = airlight::test::relative_l2(film, truth, "mean");
    CAPTURE(bounces, error);
    CHECK(error < most);
    CHECK(error < before);
    before = error;
  }
}

TEST_CASE("a convex mesh does not shadow itself", "[fogshop]") {
  scene::Scene scene = floor_scene();
  scene.surfaces[0].shape = scene::make_box({{-1, -1, -1}, {1, 1, 1}});
  finish(scene);
  const RadianceTransfer transfer(scene, 5, 512, infinity, 0, {1, {}});
  CHECK(transfer.rays_cast() > 8 * 256);
  for (int t = 0; t < 12; ++t) {
    const auto& mesh = std::get<scene::TriangleMesh>(scene.surfaces[0].shape);
    const auto& corner = mesh.triangles[t];
    const Point3 middle = (mesh.vertices[corner[0]] + mesh.vertices[corner[1]] + mesh.vertices[corner[2]]) / 3;
    Vec3 normal = (mesh.vertices[corner[1]] - mesh.vertices[corner[0]])
                      .cross(mesh.vertices[corner[2]] - mesh.vertices[corner[0]])
                      .normalized();
    const std::vector<double> v = transfer.visibility(scene, {middle, normal, 0, t});
    REQUIRE(v.size() == 25);
    CHECK(v[0] == Approx(std::sqrt(4 * pi)).epsilon(1e-6));
    for (int n = 1; n < 25; ++n) CHECK(v[n] == 0);
    CHECK(transfer.visibility(scene, {middle, -normal, 0, t}).empty());  // seen from inside
  }
  // So the pictures with and without radiance transfer are equal.
  const scene::Film plain = render(scene, {{"reflectance", "npsfT"}});
  const scene::Film shadowed = render(scene, {{"reflectance", "npsfT"}, {"prt", "true"}});
  double brightest = 0;
  for (std::size_t i = 0; i < plain.layer("reflected_airlight").size(); ++i) {
    const double a = plain.layer("reflected_airlight")[i];
    brightest = std::max(brightest, a);
    CHECK(shadowed.layer("reflected_airlight")[i] == Approx(a).epsilon(1e-5).margin(1e-9));
  }
  CHECK(brightest > 1e-4);
}

// A wall beside the floor takes light away, from beyond its reach none; threads do not matter; direct light stays.
TEST_CASE("shadows of scattered light", "[fogshop]") {
  scene::Scene scene = floor_scene();
  scene::TriangleMesh wall;
  wall.vertices = {{-5, -1, -6}, {5, -1, -6}, {5, 30, -6}, {-5, 30, -6}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.surfaces.push_back({"wall", wall, scene::Lambert{Rgb::Constant(0.5)}});
  finish(scene);
  const scene::Film plain = render(scene, {{"reflectance", "npsfT"}});
  const scene::Film shadowed = render(scene, {{"reflectance", "npsfT"}, {"prt", "true"}});
  const scene::Film again = render(scene, {{"reflectance", "npsfT"}, {"prt", "true"}}, 2);
  const scene::Film near = render(scene, {{"reflectance", "npsfT"}, {"prt", "true"}, {"prt_reach", "0.5"}});
  CHECK(shadowed.layer("reflected_airlight") == again.layer("reflected_airlight"));
  double before = 0, after = 0, direct = 0;
  for (std::size_t i = 0; i < plain.layer("surface").size(); ++i) {
    before += plain.layer("reflected_airlight")[i];
    after += shadowed.layer("reflected_airlight")[i];
    CHECK(near.layer("reflected_airlight")[i] ==
          Approx(plain.layer("reflected_airlight")[i]).epsilon(1e-5).margin(1e-9));
    direct = std::max(direct, std::abs(double(plain.layer("surface")[i] - plain.layer("reflected_airlight")[i]) -
                                       (shadowed.layer("surface")[i] - shadowed.layer("reflected_airlight")[i])));
  }
  CHECK(after < 0.98 * before);
  CHECK(after > 0.3 * before);
  CHECK(direct < 1e-6);
}

// A uniform sky behind the endless ceiling: the share of it that the floor sees is (1 - n . m)/2, by cosine.
TEST_CASE("shadows of an environment's light", "[fogshop]") {
  for (const double a : {0.9, 0.2}) {
    scene::Scene scene = floor_scene();
    const Vec3 m(std::cos(a), std::sin(a), 0);
    scene.surfaces.push_back({"ceiling", scene::Plane{20 * m, m}, scene::Lambert{}});
    scene.media.clear();
    scene.lights.assign(1, scene::make_constant_environment(Rgb(1, 2, 3)));
    finish(scene);
    const auto middle = [&](const std::map<std::string, std::string>& given) {
      return render(scene, given).get("surface", 3, 2);
    };
    CAPTURE(a);
    CHECK(((middle({}) / Rgb(1, 2, 3) - 0.7).abs() < 1e-6).all());
    // Six bands of a step that falls along a great circle.
    CHECK(((middle({{"prt", "true"}, {"prt_rays", "4096"}}) / Rgb(1, 2, 3) - 0.7 * (1 - std::sin(a)) / 2).abs() < 0.03)
              .all());
  }
}

TEST_CASE("the transfer is made where it is needed", "[fogshop]") {
  const auto kept = [](const scene::Scene& scene, std::map<std::string, std::string> values) {
    const Fogshop method;
    const auto prepared = method.prepare(std::make_shared<const scene::Scene>(scene),
                                         scene::Settings(method.settings(), values), {1, {}});
    bool timed = false, stage = false;
    for (const auto& time : prepared->prepare_times()) timed = timed || time.name == "radiance transfer";
    for (const auto& s : prepared->stages()) stage = stage || (s.name == "radiance transfer" && s.kept);
    CHECK(timed == stage);
    return stage;
  };
  scene::Scene scene = floor_scene();
  finish(scene);
  CHECK(kept(scene, {{"reflectance", "npsfT"}, {"prt", "true"}}));
  CHECK_FALSE(kept(scene, {{"reflectance", "npsfT"}}));
  CHECK_FALSE(kept(scene, {{"reflectance", "direct"}, {"prt", "true"}}));
  const Fogshop method;
  CHECK_FALSE(
      method.supports(scene, scene::Settings(method.settings(), {{"reflectance", "sun"}, {"prt", "true"}})).empty());
  scene.surfaces[0].shape = scene::Plane{Point3::Zero(), Vec3::UnitY()};
  finish(scene);
  CHECK_FALSE(kept(scene, {{"reflectance", "npsfT"}, {"prt", "true"}}));
}

}  // namespace radiance_transfer_test
