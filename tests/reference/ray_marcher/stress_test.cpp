// Extreme scenes: every pixel finite, and the limit that must hold (stress list of the references).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/reference/ray_marcher/march_scenes.h"

namespace stress_test {

using namespace airlight;
using namespace airlight::ray_marcher;

namespace {

scene::View looking(const Point3& from, const Point3& to) {
  scene::View view;
  view.camera = scene::look_at(from, to, Vec3::UnitY());
  view.camera.vertical_fov = 0.8;
  view.width = view.height = 5;  // odd: the centre pixel looks straight at `to`
  return view;
}

void check_finite(const scene::Film& film) {
  for (const auto& [name, values] : film.layers)
    for (const float v : values) {
      CHECK(std::isfinite(v));
      CHECK(v >= 0);
    }
}

scene::DensityField field_of(int kind) {
  if (kind == 0) return scene::Homogeneous{1};
  if (kind == 1) return scene::GaussianSum{{{Point3(0, 0, 0), 0.5, 1}, {Point3(0.3, 0.1, 0), 0.2, 2}}, 0.1, infinity};
  return make_smoke(16, 0.125, Vec3(-0.95, -0.95, -0.95), Mat3::Identity());
}

}  // namespace

TEST_CASE("ray marcher: extreme extinctions, lights and cameras stay finite", "[ray_marcher]") {
  const Point3 centre(0.05, 0.02, 0.01);
  for (const double extinction : {1e6, 1e3, 1.0, 1e-8})
    for (int kind = 0; kind < 3; ++kind)
      for (const char* kernel : {"auto", "scalar"})
        for (const char* spacing : {"graded", "uniform"}) {
          INFO("extinction " << extinction << ", field " << kind << ", " << kernel << ", " << spacing);
          const Given given = {{"steps", "24"}, {"shadow_steps", "12"}, {"kernel", kernel}, {"spacing", spacing}};
          const auto medium = [&](const scene::Region& region, scene::PhaseFunction phase) {
            return make_medium(field_of(kind), region, Rgb(extinction, 2 * extinction, 0), Rgb::Constant(0.99), phase);
          };
          for (const scene::Region& region :
               {scene::Region(scene::Unbounded{}), scene::Region(scene::Sphere{centre, 0.8})}) {
            // Light inside the medium; a light 1e-9 off the centre ray; one in the camera's plane; peaked phases.
            const auto scene = make_scene({medium(region, scene::HenyeyGreenstein{0.999})},
                                          {scene::PointLight{centre + Point3(1e-9, 0, 0), Rgb(1, 2, 3), 0},
                                           scene::PointLight{Point3(0, 1e-9, 2), Rgb(1, 2, 3), 0},
                                           scene::DirectionalLight{Vec3::UnitY(), Rgb(1, 2, 3)}});
            check_finite(render(scene, looking(Point3(0, 0, 3), centre), given).film);
            // Camera inside.
            check_finite(render(scene, looking(Point3(0.1, 0.1, 0.1), Point3(0, 0, -1)), given).film);
            const auto back = make_scene({medium(region, scene::HenyeyGreenstein{-0.999})},
                                         {scene::DirectionalLight{Vec3::UnitZ(), Rgb(1, 2, 3)}});
            check_finite(render(back, looking(Point3(0, 0, 3), centre), given).film);
          }
        }
}

// A light exactly on the centre ray: the airlight there is infinite, and no answer is right. One exactly on a camera
// outside the medium is on all rays, and none is spoilt. (On a camera inside a medium it is refused: stress case 11.)
TEST_CASE("ray marcher: a light on a ray is refused in a medium, and spoils no pixel outside", "[ray_marcher]") {
  for (const char* kernel : {"auto", "scalar"})
    for (const char* spacing : {"graded", "uniform"}) {
      const auto seen = [&](const Point3& light) {
        auto scene = std::make_shared<scene::Scene>(
            *make_scene({make_medium(scene::Homogeneous{1}, scene::Sphere{}, Rgb::Ones(), Rgb::Ones())},
                        {scene::PointLight{light, Rgb::Ones(), 0}}));
        scene->camera = looking(Point3(0, 0, 3), Point3::Zero()).camera;
        return render(scene, looking(Point3(0, 0, 3), Point3::Zero()), {{"kernel", kernel}, {"spacing", spacing}}).film;
      };
      CHECK_THROWS_WITH(seen(Point3(0, 0, 0)), Catch::Contains("light 0 stands 0 m beside the ray of pixel (2, 2)"));
      check_finite(seen(Point3(0, 0, 3)));
    }
}

// Optical depth to 0: L / extinction tends to albedo * phase * irradiance * path, here 0.9 / (4 pi) * 2 * 2; the next
// term is the optical depth, 4e-8.
TEST_CASE("ray marcher: thin fog is proportional to its extinction", "[ray_marcher]") {
  const auto scene =
      make_scene({make_medium(scene::Homogeneous{1}, scene::Sphere{}, Rgb::Constant(1e-8), Rgb::Constant(0.9))},
                 {scene::DirectionalLight{Vec3::UnitY(), Rgb::Constant(2)}});
  for (const char* kernel : {"auto", "scalar"}) {
    const auto film = render(scene, looking(Point3(0, 0, 3), Point3::Zero()), {{"kernel", kernel}}).film;
    CHECK(film.get("airlight", 2, 2)[0] / 1e-8 == Approx(0.9 / (4 * pi) * 4).epsilon(1e-6));
  }
}

// Optical depth to infinity, light from behind the camera: the surface of a dense sphere is a half space for single
// scattering, albedo * p * E * 1 / (mu + mu0) with mu = mu0 = 1, that is albedo p E / 2, once steps resolve the mean
// free path of 1e-3 at the surface: 4e4 steps of 5e-5, 5 % of it each, midpoint error (0.05)^2 / 12 of the light, 2e-4.
TEST_CASE("ray marcher: a dense sphere lit from the camera is half a space", "[ray_marcher]") {
  const auto scene =
      make_scene({make_medium(scene::Homogeneous{1}, scene::Sphere{}, Rgb::Constant(1e3), Rgb::Constant(0.9))},
                 {scene::DirectionalLight{Vec3::UnitZ(), Rgb::Constant(2)}});
  scene::View view = looking(Point3(0, 0, 3), Point3::Zero());
  view.width = view.height = 1;
  const auto film = render(scene, view, {{"steps", "40000"}}).film;
  CHECK(film.get("airlight", 0, 0)[0] == Approx(0.9 / (4 * pi) * 2 / 2).epsilon(5e-4));
  CHECK(film.get("transmittance", 0, 0)[0] == 0);
}

// Far from the origin: the picture is the same as at the origin, to the digits that coordinates of 1e6 m leave in
// double (1e-10 m), far below float's.
TEST_CASE("ray marcher: a scene far from the origin looks the same", "[ray_marcher]") {
  const Vec3 far(1e6, -2e6, 3e6);
  for (int kind = 0; kind < 3; ++kind) {
    const auto make = [&](const Vec3& shift) {
      scene::DensityField field = field_of(kind);
      if (auto* sum = std::get_if<scene::GaussianSum>(&field))
        for (auto& g : sum->gaussians) g.center += shift;
      if (auto* grid = std::get_if<std::shared_ptr<const scene::VoxelGrid>>(&field)) {
        auto copy = std::make_shared<scene::VoxelGrid>(**grid);
        copy->translation += shift;
        *grid = copy;
      }
      return make_scene({make_medium(field, scene::Sphere{shift, 0.9}, Rgb(1, 2, 3), Rgb::Constant(0.9))},
                        {scene::PointLight{Point3(0.3, 0.4, 0.2) + shift, Rgb(1, 2, 3), 0}});
    };
    const auto near_film = render(make(Vec3::Zero()), looking(Point3(0, 0.1, 3), Point3::Zero()), {}).film;
    scene::View view = looking(Point3(0, 0.1, 3), Point3::Zero());
    view.camera.position += far;
    const auto far_film = render(make(far), view, {}).film;
    for (std::size_t i = 0; i < near_film.layer("mean").size(); ++i)
      CHECK(far_film.layer("mean")[i] == Approx(near_film.layer("mean")[i]).epsilon(2e-5).margin(1e-9));
  }
}

}  // namespace stress_test
