// Backdrops and particles on the device: the picture of the CPU.
#include <catch2/catch.hpp>

#include "gpu/fogshop/fogshop.h"
#include "gpu/legendre_fluids/light.h"
#include "gpu/ray_marcher/ray_marcher.h"
#include "gpu/wavelet_fog/wavelet_fog.h"
#include "methods/fogshop/fogshop.h"
#include "methods/legendre_fluids/light.h"
#include "methods/wavelet_fog/wavelet_fog.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"
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
             const std::map<std::string, std::string>& given, double bound = 1e-5) {
  const auto scene = std::make_shared<const scene::Scene>(content);
  const scene::Film expected =
      processor.prepare(scene, {processor.settings(), given}, {})->render(view_of(*scene), {}).film;
  const auto prepared = device.prepare(scene, {device.settings(), given}, {});
  for (int frame = 0; frame < 2; ++frame) {
    const scene::Film found = prepared->render(view_of(*scene), {}).film;
    CHECK(found.layers.size() == expected.layers.size());
    for (const auto& [layer, values] : expected.layers) {
      double greatest = 0, scale = 0;
      for (std::size_t i = 0; i < 3 * expected.pixels(); ++i) {
        greatest = std::max(greatest, double(std::abs(found.layer(layer)[i] - expected.layer(layer)[i])));
        scale = std::max(scale, double(expected.layer(layer)[i]));
      }
      CAPTURE(layer, greatest, scale);
      CHECK(scale > 0.04);
      CHECK(greatest < bound * scale + 10 * gpu::test::injected_error());
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

// A sphere in front of some pixels of the picture, behind others.
DEVICE_TEST_CASE("Fogshop: the device sees backdrops and particles as the processor does", "[gpu][fogshop][backdrop]") {
  const std::string sphere = "[[surface]]\ntype = 'sphere'\ncenter = [0, 0, -2]\nradius = 1\n";
  const std::map<std::string, std::string> kinds[] = {{{"K", "24"}, {"reflectance", "npsfT"}},
                                                      {{"variant", "paper"}},
                                                      {{"downsample", "2"}, {"upsample", "paper"}, {"K", "8"}}};
  for (const std::string& more : {std::string(), sphere})
    for (std::map<std::string, std::string> given : kinds) {
      if (more.empty()) given.erase("reflectance");
      given.emplace("erf", "erf10");
      CAPTURE(more, given);
      compare(fogshop::Fogshop(), gpu::fogshop::Fogshop(), with_backdrops(lamp, more), given, 3e-5);
    }
}

DEVICE_TEST_CASE("wavelet fog: the device sees backdrops and particles as the processor does",
                 "[gpu][wavelet_fog][backdrop]") {
  const std::string sphere = "[[surface]]\ntype = 'sphere'\ncenter = [0, 0, -2]\nradius = 1\n";
  for (const std::string& more : {std::string(), sphere}) {
    scene::Scene scene =
        with_backdrops("[[light]]\ntype = 'directional'\nto_light = [1, 3, 2]\nirradiance = 9\n", more);
    auto fog = std::make_shared<scene::Fogmap>();
    std::vector<double> values;
    for (int i = 0; i < 12 * 12; ++i) values.push_back((i * 7) % 5 * 0.4);
    fog->map = scene::SplineMap(2, {{0, 0}, {12, 12}}, values);
    fog->x0 = fog->z0 = -7;
    scene::Medium medium;
    medium.field = scene::FogmapPointer(fog);
    medium.region = scene::Slab{Vec3::UnitY(), -5, 5};
    medium.sigma_t = Rgb(0.1, 0.2, 0.3);
    scene.media = {medium};
    finish(scene);
    for (const char* sun : {"false", "true"})
      compare(wavelet_fog::WaveletFog(), gpu::wavelet_fog::WaveletFog(), scene, {{"sun", sun}});
  }
}

}  // namespace backdrops_test
