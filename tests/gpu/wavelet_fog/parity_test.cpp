// Fogmaps on the GPU against those on the CPU: same settings, same picture to single precision. Bounds are within 3 times of what
// is measured.
#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"
#include "tests/gpu/wavelet_fog/pictures.h"

namespace parity_test {

using namespace airlight;
using namespace airlight::gpu::test;

namespace {

const std::pair<Point3, Point3> views[] = {
    {{-12, 2, -22}, {3, 1.5, 8}}, {{0, 1, 0}, {10, 0.5, 3}}, {{-60, 9, -45}, {0, 2, 0}}, {{5, 25, 5}, {6, 0, 5.5}}};

const scene::HeightProfile profiles[] = {scene::SameAtAllHeights{}, scene::Layers{{0, 3, 8}, {1, 0.8, 0}},
                                         scene::ExponentialFall{0.5, 2.5}};

}  // namespace

DEVICE_TEST_CASE("wavelet fog: GPU agrees with CPU in every profile and degree", "[gpu][wavelet_fog]") {
  for (int degree = 0; degree <= 3; ++degree)
    for (const scene::HeightProfile& profile : profiles)
      for (const auto& [eye, at] : views)
        for (const char* variant : {"direct", "skip"}) {
          auto fog = patches(degree, 40, 33, 1, 3 + degree, profile);
          fog->cos_turn = 0.8, fog->sin_turn = 0.6;
          const auto scene = scene_of(fog, 0.15, eye, at);
          scene->name = fmt::format("degree {} {} from {}", degree, profile_name(profile), eye[1]);
          compare(scene, {{"variant", variant}}, 2e-6);
        }
}

DEVICE_TEST_CASE("wavelet fog: every variant on the GPU is that of the CPU", "[gpu][wavelet_fog]") {
  for (int degree = 0; degree <= 2; ++degree)
    for (const char* coarse : {"wavelet", "clamped", "restricted"})
      for (const auto& [eye, at] : views) {
        const auto scene = scene_of(patches(degree, 64, 47, 0.8, 5 + degree, profiles[degree]), 0.2, eye, at);
        scene->name = fmt::format("degree {} from {}", degree, eye[1]);
        for (const char* variant : {"tele", "paper"})
          compare(scene, {{"variant", variant}, {"coarse", coarse}, {"mu", "0.4"}}, 1e-5);
        compare(scene, {{"variant", "bound"}, {"coarse", coarse}}, 1e-5);
        if (coarse != std::string("wavelet")) continue;
        compare(scene, {{"variant", "pre"}, {"mu", "0.4"}}, 1e-5);
        for (const char* variant : {"paper", "pre"}) compare(scene, {{"variant", variant}, {"mu", "1"}}, 3e-5);
      }
}

DEVICE_TEST_CASE("wavelet fog: the polar table on the GPU is that of the CPU", "[gpu][wavelet_fog]") {
  for (int degree = 0; degree <= 3; ++degree)
    for (int profile = 0; profile < 2; ++profile)
      for (const auto& [eye, at] : views) {
        const auto scene = scene_of(patches(degree, 64, 47, 0.8, 5 + degree, profiles[profile]), 0.2, eye, at);
        scene->name = fmt::format("degree {} {} from {}", degree, profile_name(profiles[profile]), eye[1]);
        compare(scene, {{"variant", "polar"}}, 2e-5);
      }
}

DEVICE_TEST_CASE("wavelet fog: the polar table on the GPU begins at the map's rim", "[gpu][wavelet_fog]") {
  for (int profile = 0; profile < 2; ++profile) {
    const auto scene = scene_of(patches(2, 64, 47, 0.8, 7, profiles[profile]), 0.2, {-1200, 90, -700}, {0, 0, 0});
    for (const double fov : {0.08, 0.8}) {
      scene->camera.vertical_fov = fov;
      scene->name = fmt::format("far, {} {}", profile_name(profiles[profile]), fov);
      compare(scene, {{"variant", "polar"}}, 1e-4);
    }
  }
}

// A few cells of a few rays take another entry of a table: in single precision its nearest place may be another. The eye stands beside
// middles between two places, where that would be so in the first cell of all rays.
DEVICE_TEST_CASE("wavelet fog: tables of path integrals on the GPU are those of the CPU", "[gpu][wavelet_fog]") {
  for (int degree = 0; degree <= 2; ++degree)
    for (const scene::HeightProfile& profile : profiles)
      for (const auto& [eye, at] : views) {
        const auto scene =
            scene_of(patches(degree, 64, 47, 0.8, 5 + degree, profile), 0.2, eye + Vec3(0.013, 0, 0.007), at);
        scene->name = fmt::format("table, degree {} {} from {}", degree, profile_name(profile), eye[1]);
        for (const char* variant : {"direct", "paper", "pre"})
          for (const char* lookup : {"nearest", "bilinear"}) {
            const Given given{{"variant", variant}, {"table", "8"}, {"lookup", lookup}, {"mu", "0.4"}};
            compare(scene, scene::without_unread(wavelet_fog::WaveletFog().settings(), given), 1e-5);
          }
      }
}

// The host compresses and converts maps, before they go up.
DEVICE_TEST_CASE("wavelet fog: changed maps on the GPU are those of the CPU", "[gpu][wavelet_fog]") {
  const auto scene = scene_of(patches(2, 64, 47, 0.8, 7, profiles[1]), 0.2, views[2].first, views[2].second);
  for (const Given& given :
       std::vector<Given>{{{"keep", "0.05"}},
                          {{"degree", "0"}},
                          {{"degree", "1"}, {"keep", "0.2"}, {"variant", "tele"}, {"mu", "0.4"}}}) {
    compare(scene, given, 1e-5);
    const std::vector<float> clear = render(wavelet_fog::WaveletFog(), scene, given).film.layer("transmittance");
    CHECK(*std::min_element(clear.begin(), clear.end()) < 0.5);
    CHECK(render(gpu::wavelet_fog::WaveletFog(), scene, given).counters["map_error_ppm"] ==
          render(wavelet_fog::WaveletFog(), scene, given).counters["map_error_ppm"]);
    // A next frame with another map is the frame made anew.
    const gpu::wavelet_fog::WaveletFog method;
    const auto frames = method.prepare(scene, {method.settings(), given}, {1, {}});
    const auto other = scene_of(patches(2, 64, 47, 0.8, 8, profiles[1]), 0.2, views[2].first, views[2].second);
    REQUIRE(frames->next(other, {1, {}}));
    CHECK(frames->render(view_of(*other), {1, {}}).film.layers ==
          method.prepare(other, {method.settings(), given}, {1, {}})->render(view_of(*other), {1, {}}).film.layers);
  }
}

DEVICE_TEST_CASE("wavelet fog: surfaces, lamps and skies on the GPU are those of the CPU", "[gpu][wavelet_fog]") {
  auto valley = airlight::test::scene_named("wavelet_fog/valley", 96, 72);
  compare(valley, {}, 1.7e-6);
  compare(valley, {{"variant", "tele"}}, 3e-6);
  compare(valley, {{"variant", "polar"}, {"first_hits", "raster"}}, 9e-6);
  // A lamp and a spot in the fog, the first a ball, a second map across the first.
  valley->lights.push_back(scene::PointLight{{-4, 2, -6}, Rgb(40, 30, 20), 0.4});
  scene::SpotLight spot;
  spot.position = {3, 6, -12}, spot.axis = Vec3(0.1, -1, 0.6).normalized(), spot.intensity = Rgb(90, 120, 150);
  valley->lights.push_back(spot);
  scene::Medium second;
  second.field = scene::FogmapPointer(patches(1, 20, 20, 2, 7, scene::ExponentialFall{-1, 2}));
  second.region = Box{{-15, -9, -15}, {15, 9, 15}};
  second.sigma_t = Rgb(0.05, 0, 0.1);
  valley->media.push_back(second);
  compare(valley, {}, 1.7e-6);
}

}  // namespace parity_test
