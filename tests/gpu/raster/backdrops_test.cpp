// Backdrops and particles on the device: the picture of the CPU.
#include <catch2/catch.hpp>

#include "gpu/legendre_fluids/light.h"
#include "gpu/ray_marcher/ray_marcher.h"
#include "methods/legendre_fluids/light.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "tests/gpu/device.h"

namespace backdrops_test {

using namespace airlight;

namespace {

const std::string lamp = R"([[light]]
type = "point"
position = [1, 3, 2]
intensity = [30, 25, 20]
[[medium]]
type = "gaussians"
sigma_t = [0.3, 0.4, 0.6]
gaussians = [{ center = [0, 0, -1], width = 2, amplitude = 1 }, { center = [1, 1, -4], width = 1.5, amplitude = 0.8 }]
)";
const std::string sun = R"([[light]]
type = "directional"
to_light = [1, 3, 2]
irradiance = 9
[[medium]]
type = "legendre"
sigma_t = [0.3, 0.4, 0.6]
lo = [-3, -3, -8]
hi = [3, 3, 3]
size = [2, 1, 3]
coefficients = [2, 0.3, 0.2, 0.4, -0.1, 0.1]
)";

scene::Scene with_backdrops(const std::string& lit_medium, const std::string& more) {
  scene::Scene scene = scene::parse_scene(R"([film]
width = 40
height = 30
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
[[light]]
type = "environment"
radiance = [0.1, 0.2, 0.3]
)" + lit_medium + R"([[particles]]
type = "sheet"
count = 60
region = { type = "sphere", center = [0, 0, -1], radius = 2 }
radius = 0.15
radiance = [[1, 0.2, 0.1], [0.2, 0.3, 1]]
)" + more,
                                          "s.toml", "");
  // Twice as fine as the film, so that centres of its pixels lie between pixels of the picture; each seventh without an end.
  scene::Backdrop picture{80, 60, {}, {}, true};
  for (int i = 0; i < 80 * 60; ++i) {
    for (int c = 0; c < 3; ++c) picture.radiance.push_back(float((i * 37 + c * 11) % 101) / 100);
    picture.depth.push_back(i % 7 == 0 ? float(infinity) : float(1 + (i * 13) % 29 * 0.4));
  }
  scene.backdrops.push_back(std::make_shared<const scene::Backdrop>(picture));
  finish(scene);
  return scene;
}

// Compares the two films, layer by layer, on a cold and on a warm frame.
void compare(const scene::Renderer& processor, const scene::Renderer& device, const scene::Scene& content,
             const std::map<std::string, std::string>& given) {
  const auto scene = std::make_shared<const scene::Scene>(content);
  const scene::Film expected =
      processor.prepare(scene, {processor.settings(), given}, {})->render(view_of(*scene), {}).film;
  const auto prepared = device.prepare(scene, {device.settings(), given}, {});
  for (int frame = 0; frame < 2; ++frame) {
    const scene::Film found = prepared->render(view_of(*scene), {}).film;
    for (const char* layer : {"surface", "transmittance", "airlight", "mean"}) {
      double greatest = 0, scale = 0;
      for (std::size_t i = 0; i < 3 * expected.pixels(); ++i) {
        greatest = std::max(greatest, double(std::abs(found.layer(layer)[i] - expected.layer(layer)[i])));
        scale = std::max(scale, double(expected.layer(layer)[i]));
      }
      CAPTURE(layer, greatest, scale);
      CHECK(scale > 0.1);
      CHECK(greatest < 1e-5 * scale + 10 * gpu::test::injected_error());
    }
  }
  scene::View other = view_of(*scene);
  other.camera.position += Vec3(1, 0, 0);
  CHECK_THROWS_WITH(prepared->render(other, {}), Catch::Contains("own camera"));
}

}  // namespace

DEVICE_TEST_CASE("ray marcher: the device sees backdrops and particles as the processor does",
                 "[gpu][ray_marcher][backdrop][thorough]") {
  const std::string more = GENERATE("", "[[surface]]\ntype = 'sphere'\ncenter = [0, 0, -2]\nradius = 1\n");
  compare(ray_marcher::RayMarcher(), gpu::ray_marcher::RayMarcher(), with_backdrops(lamp, more),
          {{"steps", "32"}, {"shadow_steps", "8"}, {"environment_directions", "8"}});
}

DEVICE_TEST_CASE("Legendre light: the device sees backdrops and particles as the processor does",
                 "[gpu][legendre_fluids][backdrop][thorough]") {
  compare(legendre_fluids::LegendreLight(), gpu::legendre_fluids::LegendreLight(), with_backdrops(sun, ""), {});
}

}  // namespace backdrops_test
