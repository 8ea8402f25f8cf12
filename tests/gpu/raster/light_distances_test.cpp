// Light-distance maps against Embree: the distance of every texel, and the faces' places.
#include "gpu/raster/light_distances.h"

#include "scene/geometry/shapes.h"
#include "tests/gpu/device.h"
#include "tests/gpu/raster/hits_against_embree.h"
#include "tests/scene/geometry_scenes.h"

namespace light_distances_test {

using namespace airlight;
using gpu::LightDistances;

// Faces tile the sphere: the texel in which a direction lies, by the rule of light_distances.glsl, has its centre
// within half a texel's diagonal.
TEST_CASE("texels of a light-distance map look where they are looked up", "[raster]") {
  constexpr int side = 32;
  scene::Random random;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 u = random.direction();
    int axis;
    u.cwiseAbs().maxCoeff(&axis);
    const double sign = u[axis] < 0 ? -1 : 1, most = std::abs(u[axis]);
    const int i = int(0.5 * side * (1 + sign * u[(axis + 2) % 3] / most));
    const int j = int(0.5 * side * (1 - u[(axis + 1) % 3] / most));
    const scene::View view = LightDistances::face_view(Point3::Zero(), 2 * axis + (sign < 0), side);
    const Vec3 centre = camera_ray(view.camera, i + 0.5, j + 0.5, side, side).direction;
    CHECK((centre / centre.cwiseAbs().maxCoeff() - u / most).cwiseAbs().maxCoeff() <= 1.0 / side + 1e-12);
    CHECK(view.camera.right.isApprox(view.camera.forward.cross(view.camera.up)));
  }
}

DEVICE_TEST_CASE("lights see what Embree sees", "[gpu][raster]") {
  constexpr int side = 48;
  scene::Scene scene =
      scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/elephant_gaussians.toml", {{"light.0.radius", "0"}});
  scene.surfaces.push_back(scene::surface_of(scene::Sphere{{0.4, -0.3, 0.5}, 0.2}));
  scene.surfaces.push_back(scene::surface_of(scene::make_box({{-3, -0.6, -3}, {3, 4, 3}})));
  finish(scene);
  const std::vector<Point3> lights = {{-0.45, 0.75, 0.35}, {0.4, -0.3, 0.45}, {0, -0.499999, 0.9}};  // one in the ball
  const gpu::Use use(context);
  const LightDistances maps(context, scene, lights, side);
  const auto distances = maps.distances().download<float>();
  const auto primitives = maps.primitives().download<int>();
  REQUIRE(distances.size() == lights.size() * maps.texels_per_light());
  int moved = 0;
  for (std::size_t l = 0; l < lights.size(); ++l)
    for (int face = 0; face < 6; ++face) {
      const scene::View view = LightDistances::face_view(lights[l], face, side);
      const gpu::test::Agreement a = gpu::test::compare(context, scene, view);
      CAPTURE(l, face, a.first);
      CHECK(a.wrong == 0);
      CHECK(a.distance < 6.1e-8);
      moved += a.moved;
      // And that is what the map holds.
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
          const std::size_t at = ((l * 6 + face) * side + j) * side + i;
          const auto hit = scene.geometry->first_hit(camera_ray(view.camera, i + 0.5, j + 0.5, side, side));
          REQUIRE(hit);  // the box is all around
          REQUIRE(primitives[at] >= 0);
          if (std::abs(distances[at] / hit->t - 1) > 1e-6) --moved;
        }
    }
  CHECK(moved >= 0);  // only texels that were seen to lie on an edge differ
  CHECK(moved < 40);  // of 41472
}

}  // namespace light_distances_test
