// The default's steps keep the error that `airlight explain` states.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/deterministic/airlight.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace default_test {

using namespace airlight;
using namespace airlight::ray_marcher;

// At worst 6.8 % where surfaces cast shadows: fig7 and spot, seen by 32 x 32 pixels. results/reference/marcher_default
// has more.
TEST_CASE("ray marcher: the default keeps its stated error", "[ray_marcher]") {
  for (const char* name : {"plume_sun", "elephant_fog", "elephant_gaussians", "crosscheck/sphere_point_inside",
                           "crosscheck/grid_coloured_point", "shadow_planes/fig7", "shadow_planes/spot",
                           "shadow_planes/fog_ball", "fogshop/tube"}) {
    const auto scene = std::make_shared<const scene::Scene>(
        scene::load_scene(std::string(AIRLIGHT_SOURCE_DIR "/experiments/scenes/") + name + ".toml"));
    scene::View view = view_of(*scene);
    view.width = view.height = scene->geometry ? 32 : 16;
    const deterministic::AirlightIntegrator truth(*scene, {1e-4, 200000});  // a hundredth of what is stated
    const RayMarcher marcher;
    const auto prepared = marcher.prepare(scene, {marcher.settings(), {}}, {1, {}});
    const scene::Film film = prepared->render(view, {1, {}}).film;
    double difference = 0, size = 0;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const Ray ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
        const auto exact = truth(ray, scene::ray_end(*scene, ray).t);
        difference += (film.get("airlight", x, y) - exact.radiance).square().sum();
        size += exact.radiance.square().sum();
      }
    const double stated = stated_error(*scene);
    CHECK(stated == (scene->geometry ? 0.08 : 0.015));
    CAPTURE(name, stated);
    CHECK(std::sqrt(difference / size) < stated);
    CHECK_THAT(prepared->stages()[0].reason, Catch::Contains(scene->geometry ? "within 8 %" : "within 1.5 %"));
  }
}

}  // namespace default_test
