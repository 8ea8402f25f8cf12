// Light of suns that fogmaps scatter, on the GPU as on the CPU.
#include "scene/error.h"
#include "tests/gpu/wavelet_fog/pictures.h"

using namespace airlight;
using namespace airlight::gpu::test;

namespace {

const std::pair<Point3, Point3> views[] = {
    {{-12, 2, -22}, {3, 1.5, 8}}, {{0, 1, 0}, {10, 0.5, 3}}, {{5, 25, 5}, {6, 0, 5.5}}};

const scene::HeightProfile profiles[] = {scene::Layers{{0, 3, 8}, {1, 0.8, 0}}, scene::ExponentialFall{0.5, 2.5},
                                         scene::SameAtAllHeights{}};

std::shared_ptr<scene::Scene> sunny(int degree, const scene::HeightProfile& profile,
                                    const std::pair<Point3, Point3>& view, const Vec3& to_sun) {
  auto made = scene_of(patches(degree, 40, 33, 1, 3 + degree, profile), 0.15, view.first, view.second);
  made->width = 32, made->height = 24;
  made->lights = {scene::DirectionalLight{to_sun.normalized(), Rgb(3, 2.5, 2)}};
  made->media[0].albedo = Rgb(0.9, 0.8, 0.7);
  made->name = fmt::format("degree {} {} from {}, sun at {}", degree, profile_name(profile), view.first[1], to_sun[1]);
  return made;
}

}  // namespace

TEST_CASE("wavelet fog: a sun on the GPU is that of the CPU", "[gpu][wavelet_fog]") {
  if (!gpu::test::device()) return;
  const scene::PhaseFunction phases[] = {scene::Isotropic{}, scene::Rayleigh{}, scene::HenyeyGreenstein{0.7},
                                         scene::Hazy{}, scene::Murky{}};
  int i = 0;
  for (int degree = 0; degree <= 3; ++degree)
    for (const scene::HeightProfile& profile : profiles)
      for (const auto& view : views)
        for (const Vec3& to_sun : {Vec3(0.5, 0.4, 0.3), Vec3(-1, 0.05, 0.2), Vec3(0, 1, 0)}) {
          const auto scene = sunny(degree, profile, view, to_sun);
          scene->media[0].phase = phases[++i % 5];
          compare(scene, {{"sun", "true"}, {"variant", degree % 2 ? "direct" : "skip"}}, 4e-6);
        }
}

TEST_CASE("wavelet fog: two suns, one below the horizon, thick fog and ends of rays on the GPU", "[gpu][wavelet_fog]") {
  if (!gpu::test::device()) return;
  const auto scene = sunny(1, profiles[0], views[0], {0.3, 0.5, -0.4});
  scene->lights.push_back(scene::DirectionalLight{Vec3(0.6, -0.2, 0.3).normalized(), Rgb(0.5, 1, 2)});
  compare(scene, {{"sun", "true"}}, 1.6e-6);
  scene->media[0].sigma_t = Rgb(0.6, 0.3, 0);  // pieces are halved, rays end, a channel is clear
  compare(scene, {{"sun", "true"}}, 1.6e-6);
  compare(scene,
          {{"sun", "true"}, {"sun_step", "1"}, {"sun_points", "4"}, {"termination", "0.001"}, {"variant", "direct"}},
          1.8e-6);
}

TEST_CASE("wavelet fog: a frame under a sun stays on the device, also where the sun moves", "[gpu][wavelet_fog]") {
  if (!gpu::test::device()) return;
  const gpu::WaveletFogGpu method;
  const Given given{{"sun", "true"}};
  const auto first = sunny(1, profiles[1], views[0], {0.5, 0.4, 0.3});
  const auto prepared = method.prepare(first, {method.settings(), given}, {1, {}});
  scene::Execution none{1, {}}, all{1, {}};
  none.layers.emplace();
  prepared->render(view_of(*first), all);
  const auto second = sunny(1, profiles[1], views[0], {0.5, 0.42, 0.3});
  REQUIRE(prepared->next(second, none));
  scene::Rendering warm = prepared->render(view_of(*second), none);
  CHECK(warm.counters["bytes_up"] == 0);
  CHECK(warm.counters["bytes_down"] == 0);
  CHECK(warm.counters["syncs"] == 1);
  CHECK(warm.counters["allocations"] == 0);
  const scene::Rendering moved = prepared->render(view_of(*second), all), anew = render(method, second, given);
  for (const auto& [layer, values] : anew.film.layers) CHECK(moved.film.layer(layer) == values);
  const scene::Rendering cpu = render(wavelet_fog::WaveletFog(), second, given);
  CHECK(moved.counters.at("sun_points") == Approx(cpu.counters.at("sun_points")).epsilon(2e-3));
}
