// Media of any thickness, against the quadrature.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/deterministic/airlight.h"
#include "reference/ray_marcher/depth.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace thick_test {

using namespace airlight;
using namespace airlight::ray_marcher;

namespace {

scene::View from_the_front() {
  scene::View view;
  view.camera = scene::look_at(Point3(0.2, 0.3, 4), Point3::Zero(), Vec3::UnitY());
  view.camera.vertical_fov = 0.4;
  view.width = view.height = 5;
  return view;
}

scene::DensityField field_of(int kind) {
  if (kind == 0) return scene::Homogeneous{1};
  if (kind == 1) return scene::GaussianSum{{{Point3(0, 0, 0), 0.4, 1}, {Point3(0.3, 0.1, 0), 0.2, 2}}, 0, infinity};
  return make_smoke(12, 0.18, Vec3(-1, -1, -1), Mat3::Identity());
}

std::shared_ptr<scene::Scene> thick(int kind, double extinction) {
  const auto scene =
      make_scene({make_medium(field_of(kind), scene::Sphere{Point3::Zero(), 1}, Rgb::Constant(extinction),
                              Rgb::Constant(0.9), scene::HenyeyGreenstein{0.3})},
                 {scene::DirectionalLight{Vec3(0.4, 0.5, 1).normalized(), Rgb(3, 2, 1)},
                  scene::PointLight{Point3(-1.5, 1, 2.5), Rgb(5, 6, 7), 0}});
  scene->camera = from_the_front().camera;
  return scene;
}

// The airlight of every pixel by the quadrature.
std::vector<Rgb> truth_of(const scene::Scene& scene, const scene::View& view) {
  const deterministic::AirlightIntegrator truth(scene, {1e-5, 2000000});
  std::vector<Rgb> pixels;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const auto exact = truth(camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height), infinity);
      REQUIRE(exact.converged);
      pixels.push_back(exact.radiance);
    }
  return pixels;
}

// Relative L2 distance of a film's airlight from it.
double error_of(const scene::Film& film, const std::vector<Rgb>& truth) {
  double difference = 0, size = 0;
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x) {
      const Rgb& exact = truth[std::size_t(x + y * film.width)];
      difference += (Rgb(film.get("airlight", x, y)) - exact).square().sum();
      size += exact.square().sum();
    }
  REQUIRE(size > 0);
  return std::sqrt(difference / size);
}

}  // namespace

// Steps are left alone up to an optical depth x of 0.5 (64 steps), or behind one that is divided: where the light falls
// as exp(-2 depth), lit from where it is seen, the midpoint rule errs by 1 - x/sinh(x): 4 % of all light at 0.5, and at
// most 2 % as the second step, exp(-2x) (1 - x/sinh(x)) at x = 1. Columns err by about as much again, and a grid begins
// with a kink within a step, of order 1. Without steps that follow the depth all light is lost: 0 at 1e6 where .005 is
// right.
TEST_CASE("ray marcher: media of any thickness", "[ray_marcher][slow][thorough]") {
  const scene::View view = from_the_front();
  for (int kind = 0; kind < 3; ++kind)
    for (double extinction = 1; extinction < 2e9; extinction *= kind == 0 && extinction < 1e3 ? 2 : 10) {
      const auto scene = thick(kind, extinction);
      const std::vector<Rgb> truth = truth_of(*scene, view);
      for (const char* kernel : {"auto", "scalar"}) {
        const auto error = [&](const char* steps, const char* shadow_steps) {
          const Given given{{"kernel", kernel}, {"steps", steps}, {"shadow_steps", shadow_steps}};
          return error_of(render(scene, view, given).film, truth);
        };
        CAPTURE(kind, extinction, kernel);
        CHECK(error("64", "32") < stated_error(*scene));
        CHECK(error("128", "64") < (kind == 2 ? 0.03 : 0.02));
      }
    }
}

// A lamp deep in endless fog: the picture is as dark as e^-depth, and what the lamp's neighbourhood adds to it is most
// of it, because of the inverse square. Rays cut 16 depths from the eye missed 15 % of the light 30 depths deep and
// erred by 0.36; steps that grew from the eye on erred by 0.026 at 8 to 10; steps too long behind 40 made it 1e7 times
// too bright 100 deep. Beyond 80 pixels have no more digits in single precision.
TEST_CASE("ray marcher: a lamp at any depth of endless fog", "[ray_marcher]") {
  scene::View view;
  view.camera = scene::look_at(Point3::Zero(), Point3(1, 0, 1), Vec3::UnitY());
  view.width = 9, view.height = 7;
  for (const double depth : {1.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 80.0}) {
    const auto scene = make_scene({make_medium(scene::Homogeneous{1}, scene::Unbounded{}, Rgb(0.9, 1, 0.95) * depth / 4,
                                               Rgb::Constant(0.9), scene::HenyeyGreenstein{0.3})},
                                  {scene::PointLight{Point3(0, 0, 4), Rgb(5, 6, 7), 0}});
    scene->camera = view.camera;
    const std::vector<Rgb> truth = truth_of(*scene, view);
    for (const char* kernel : {"auto", "scalar"})
      for (const char* spacing : {"graded", "uniform"}) {
        CAPTURE(depth, kernel, spacing);
        const auto error = [&](const char* steps) {
          const Given given{{"kernel", kernel}, {"steps", steps}, {"spacing", spacing}};
          return error_of(render(scene, view, given).film, truth);
        };
        CHECK(error("64") < stated_error(*scene));
        CHECK(error("256") < 0.005);
      }
  }
}

// The closed answer for a ball so thick that its surface is flat: light that scatters once in a half space, albedo *
// phase * E * mu0 / (mu + mu0); the next term is of the order 1 / extinction, 1e-6. And lights add up: at 1e5 the
// quadrature once lost one of two, each of which it had right alone.
TEST_CASE("quadrature: two lights on a thick ball", "[deterministic]") {
  const scene::View view = from_the_front();
  for (const double extinction : {1e5, 1e6, 1e9, 1e11, 1e12}) {
    const auto both = thick(0, extinction);
    // Places in double are known to 5e-16 here, twice along the way: more than that cannot be asked.
    const double rounding = 2e-15 * extinction;
    const deterministic::AirlightIntegrator truth(*both, {1e-9 + 10 * rounding, 2000000});
    for (int i = 0; i < 6; ++i) {
      const Ray ray = camera_ray(view.camera, i + 0.5, i + 0.5, 6, 6);
      const Point3 x = ray.at(clip(both->media[0].region, ray, {0, infinity}).lo);
      Rgb expected = Rgb::Zero();
      for (const scene::Light& light : both->lights) {
        const scene::Incident in = incident(light, x);
        const double mu0 = x.dot(in.to_light), mu = -x.dot(ray.direction);
        if (mu0 < 0) continue;  // behind the ball
        REQUIRE(mu0 > 0.05);
        expected +=
            0.9 * phase_value(both->media[0].phase, in.to_light.dot(ray.direction)) * in.irradiance * mu0 / (mu + mu0);
      }
      const auto exact = truth(ray, infinity);
      CAPTURE(extinction, i);
      CHECK(exact.converged);
      for (int c = 0; c < 3; ++c)
        CHECK(exact.radiance[c] == Approx(expected[c]).epsilon(100 / extinction + 10 * rounding));
    }
  }
}

}  // namespace thick_test
