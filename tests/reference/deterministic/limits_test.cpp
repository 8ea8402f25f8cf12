// A picture that nobody waits for is refused before it is begun.
#include "reference/deterministic/limits.h"

#include <catch2/catch.hpp>
#include <chrono>

#include "reference/deterministic/airlight.h"
#include "reference/deterministic/renderer.h"
#include "scene/base/error.h"

namespace limits_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

// n^3 Gaussians of a width of 0.6 of their spacing in the cube of 2 m around the origin.
Scene cloud(int n) {
  GaussianSum sum;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        sum.gaussians.push_back({Point3(i + 0.5, j + 0.5, k + 0.5) * (2.0 / n) - Vec3::Ones(), 1.2 / n, 0.5});
  Medium medium;
  medium.field = sum;
  medium.sigma_t = Rgb::Ones();
  medium.albedo = Rgb::Ones();
  Scene scene;
  scene.name = "cloud";
  scene.width = scene.height = 512;
  scene.camera = look_at(Point3(0, 0, 4), Point3::Zero(), Vec3::UnitY());
  scene.media = {medium};
  scene.lights = {PointLight{Point3(1, 2, 1), Rgb::Ones(), 0}};
  finish(scene);
  return scene;
}

}  // namespace

TEST_CASE("quadrature: work without end is refused in one line", "[deterministic]") {
  const auto renderer = deterministic::make_renderer();
  const Settings settings(renderer->settings(), {});
  const auto reasons = [&](const Scene& scene) { return renderer->supports(scene, settings); };
  Scene scene = cloud(100);
  REQUIRE(reasons(scene).size() == 1);
  CHECK_THAT(reasons(scene)[0], Catch::Contains("512 x 512 pixels, 1 lights and 1 media need 6e+14 evaluations") &&
                                    Catch::Contains("expected at most 1e+14"));
  CHECK(reasons(scene)[0].find('\n') == std::string::npos);
  CHECK_THROWS_WITH(renderer->prepare(std::make_shared<const Scene>(scene), settings, {}),
                    Catch::StartsWith("cloud: deterministic cannot render this: 512 x 512 pixels"));
  scene.width = scene.height = 64;
  CHECK(reasons(scene).empty());
  // Lights beyond counting, negative amplitudes, whose zeros are sought.
  scene.lights.resize(100, scene.lights[0]);
  CHECK(reasons(scene).size() == 1);
  scene = cloud(50);
  CHECK(reasons(scene).empty());
  std::get<GaussianSum>(scene.media[0].field).gaussians[7].amplitude = -0.1;
  CHECK(reasons(scene).size() == 1);
  // No light, or no extinction: depths alone.
  scene.media[0].sigma_t = Rgb::Zero();
  CHECK(reasons(scene).empty());
  CHECK(deterministic::terms_of_ray(scene) == 0);
}

TEST_CASE("quadrature: the estimate of its work is right to an order of magnitude", "[deterministic]") {
  for (const int n : {1, 3, 6, 12}) {
    const Scene scene = cloud(n);
    const auto got = deterministic::airlight(scene, {Point3(0.1, 0.2, 4), Vec3(0.02, -0.03, -1).normalized()}, infinity,
                                             {1e-4, 200000});
    const double terms = double(got.evaluations) * std::pow(n, 3);
    CAPTURE(n, got.evaluations);
    CHECK(deterministic::terms_of_ray(scene) < 10 * terms);
    CHECK(deterministic::terms_of_ray(scene) > 0.1 * terms);
  }
}

}  // namespace limits_test
