// Frames of fogmaps on the device: kept state, promises and refusals.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "scene/base/error.h"
#include "scene/media/fogmap.h"
#include "tests/gpu/wavelet_fog/pictures.h"

namespace frame_test {

using namespace airlight;
using namespace airlight::gpu::test;
using airlight::test::greatest_difference;

// A depth that is off by the tolerance moves the transmittance by at most as much.
DEVICE_TEST_CASE("wavelet fog: bound keeps its tolerance on the GPU", "[gpu][wavelet_fog][thorough]") {
  double worst = 0;
  for (int degree = 0; degree <= 2; ++degree)
    for (const Point3& eye : {Point3(-12, 2, -22), Point3(-60, 9, -45)}) {
      const auto scene =
          scene_of(patches(degree, 64, 47, 1, 5 + degree, scene::Layers{{0, 3}, {1, 0.1}}), 0.1, eye, {3, 1, 8});
      const scene::Film direct = render(wavelet_fog::WaveletFog(), scene, {{"variant", "direct"}}).film;
      for (const char* tolerance : {"0.3", "0.03", "0.001"}) {
        const Given given{{"variant", "bound"}, {"tolerance", tolerance}, {"levels", "4"}};
        const double error =
            greatest_difference(render(gpu::wavelet_fog::WaveletFog(), scene, given).film, direct, "transmittance");
        CAPTURE(degree, tolerance);
        CHECK(error <= std::stod(tolerance));
        worst = std::max(worst, error / std::stod(tolerance));
      }
    }
  CHECK(worst > 1e-2);  // coarse grids were read
}

// The depth itself, of a million rays a map, wherever enough is left of the light for a float to tell it.
DEVICE_TEST_CASE("wavelet fog: bound keeps its tolerance on a million rays on the GPU", "[.][wavelet_fog_long]") {
  double worst = 0;
  for (const char* name : {"smooth", "patchy", "hard"}) {
    const auto scene = airlight::test::scene_named(std::string("wavelet_fog/") + name, 1000, 1000);
    const scene::Film film = render(wavelet_fog::WaveletFog(), scene, {{"variant", "direct"}}).film;
    const auto& direct = film.layer("transmittance");
    for (const double tolerance : {0.3, 0.1, 0.03, 0.01, 0.003, 0.001}) {
      const Given given{{"variant", "bound"}, {"tolerance", std::to_string(tolerance)}, {"levels", "4"}};
      const scene::Film bound = render(gpu::wavelet_fog::WaveletFog(), scene, given).film;
      const auto& got = bound.layer("transmittance");
      double error = 0;
      for (std::size_t i = 0; i < direct.size(); i += 3)
        if (direct[i] > 0.01f) error = std::max(error, std::abs(std::log(double(got[i]) / direct[i])));
      CAPTURE(name, tolerance);
      CHECK(error <= tolerance + 2e-5);  // rounding of the two films where a hundredth is left
      worst = std::max(worst, error / tolerance);
    }
  }
  if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("bound on the GPU: at most {:.3f} of its tolerance\n", worst);
  CHECK(worst > 0.05);
}

DEVICE_TEST_CASE("wavelet fog: a ray that ends early on the GPU is off by the threshold at most",
                 "[gpu][wavelet_fog]") {
  const auto scene = airlight::test::scene_named("wavelet_fog/patchy", 96, 72);
  scene->media[0].sigma_t *= 20;
  const scene::Film direct = render(wavelet_fog::WaveletFog(), scene, {{"variant", "direct"}}).film;
  const scene::Rendering all = render(gpu::wavelet_fog::WaveletFog(), scene);
  for (const char* variant : {"skip", "bound"}) {
    Given given{{"variant", variant}, {"termination", "0.02"}};
    if (variant == std::string("bound")) given["tolerance"] = "1e-6";  // coarse levels that add nothing to the error
    const scene::Rendering ended = render(gpu::wavelet_fog::WaveletFog(), scene, given);
    CAPTURE(variant);
    CHECK(greatest_difference(ended.film, direct, "transmittance") <= 0.02 + 2e-6);
    if (variant == std::string("skip")) CHECK(ended.counters.at("cells") < 0.8 * all.counters.at("cells"));
  }
}

DEVICE_TEST_CASE("wavelet fog: cells are counted as on the CPU", "[gpu][wavelet_fog]") {
  const auto scene = airlight::test::scene_named("wavelet_fog/patchy", 64, 48);
  for (const char* variant : {"direct", "skip", "tele", "paper", "polar"}) {
    const Given given{{"variant", variant}};
    const scene::Rendering cpu = render(wavelet_fog::WaveletFog(), scene, given),
                           gpu = render(gpu::wavelet_fog::WaveletFog(), scene, given);
    CAPTURE(variant);
    // Where a walk begins anew from an anchor it cuts a cell in two: one in 32 at most.
    for (const char* counter : {"rays", "cells", "coefficients"})
      CHECK(gpu.counters.at(counter) == Approx(cpu.counters.at(counter)).epsilon(0.03));
    if (variant == std::string("polar")) CHECK(gpu.counters.at("lookups") >= cpu.counters.at("rays") / 2);
  }
}

// The coefficients go up, everything made of them is made there.
DEVICE_TEST_CASE("wavelet fog: a map that changes every frame stays on the device", "[gpu][wavelet_fog][thorough]") {
  const gpu::wavelet_fog::WaveletFog method;
  const auto scene_with = [](unsigned seed) {
    const auto made = scene_of(patches(1, 64, 48, 1, seed), 0.1, {-12, 2, -22}, {3, 1.5, 8});
    made->lights = {scene::DirectionalLight{Vec3(1, 1, 0).normalized(), Rgb::Ones()}};
    scene::Surface ground;
    ground.shape = scene::Plane{Point3::Zero(), Vec3::UnitY()};
    made->surfaces = {ground};
    finish(*made);
    return made;
  };
  for (const char* variant : {"direct", "skip", "bound", "paper", "pre", "polar", "tele"}) {
    Given given{{"variant", variant}};
    if (variant == std::string("tele")) given["coarse"] = "clamped";
    if (variant == std::string("direct")) given["table"] = "4";
    const auto first = scene_with(3);
    const auto prepared = method.prepare(first, {method.settings(), given}, {1, {}});
    scene::Execution none{1, {}}, all{1, {}};
    none.layers.emplace();
    prepared->render(view_of(*first), all);
    for (unsigned seed : {4u, 5u}) {
      auto second = scene_with(seed);
      second->surfaces = first->surfaces, second->geometry = first->geometry;
      const long before = [] {
        const gpu::Use use(gpu::Context::get());
        return gpu::Context::get().traffic().bytes_up;
      }();
      REQUIRE(prepared->next(second, none));
      const gpu::Use use(gpu::Context::get());
      const long up = gpu::Context::get().traffic().bytes_up - before;
      CAPTURE(variant, up);
      CHECK(up <= 4 * (64 + 2) * (48 + 2) + 1024);  // the padded map, and its settings
      scene::Rendering warm = prepared->render(view_of(*second), none);
      CHECK(warm.counters["bytes_up"] == 0);
      CHECK(warm.counters["bytes_down"] == 0);
      CHECK(warm.counters["syncs"] == 1);
      CHECK(warm.counters["allocations"] == 0);
      const scene::Film moved = prepared->render(view_of(*second), all).film, anew = render(method, second, given).film;
      for (const auto& [layer, values] : anew.layers) CHECK(moved.layer(layer) == values);
    }
    // Nothing changed: nothing but settings goes up, no level is made.
    scene::Rendering still = prepared->render(view_of(*first), none);
    for (const scene::StageTime& stage : still.times) CHECK(stage.name != "maps");
    auto other = scene_with(3);
    other->media[0].field = scene::FogmapPointer(patches(1, 65, 48, 1, 3));
    other->surfaces = first->surfaces, other->geometry = first->geometry;
    CHECK_FALSE(prepared->next(other, none));  // grids of another size
  }
}

// Places in double precision, walks from anchors: spec section 3.
DEVICE_TEST_CASE("wavelet fog: maps far away, small, or large keep their digits on the GPU", "[gpu][wavelet_fog]") {
  for (const auto& [far, cell] : std::vector<std::pair<double, double>>{{0, 1}, {1e5, 1}, {1e5, 1e-3}, {9e5, 0.01}}) {
    auto fog = patches(1, 48, 40, cell, 3, scene::Layers{{0, 5 * cell}, {1, 0.2}});
    fog->x0 += far, fog->z0 -= far;
    const Point3 middle(far, 0, -far);
    const auto scene = scene_of(fog, std::min(0.15 / cell, 1e4 / std::max(1.0, far)), middle + cell * Vec3(-12, 2, -22),
                                middle + cell * Vec3(3, 1.5, 8));
    scene->media[0].region = scene::Slab{Vec3::UnitY(), -50 * cell, 60 * cell};
    scene->name = fmt::format("{} m away, cells of {} m", far, cell);
    compare(scene, {{"variant", "skip"}}, 1.4e-6);
  }
}

// More iterations than one dispatch may have on llvmpipe: rays are done in parts.
DEVICE_TEST_CASE("wavelet fog: a map of 8 million cells on the GPU", "[gpu][wavelet_fog][thorough]") {
  const auto scene =
      scene_of(patches(2, 4096, 2048, 0.01, 3, scene::ExponentialFall{0, 3}), 0.2, {-21, 1, -10.5}, {0, 0.9, 0});
  scene->width = 16, scene->height = 12;
  compare(scene, {{"variant", "direct"}}, 1.4e-6);
  compare(scene, {{"variant", "tele"}, {"coarse", "restricted"}}, 1.4e-6);
}

TEST_CASE("wavelet fog: what the GPU refuses, it names", "[gpu][wavelet_fog]") {
  const gpu::wavelet_fog::WaveletFog method;
  auto scene = scene_of(patches(3, 8, 8, 1, 3, scene::ExponentialFall{0, 1}), 0.2, {-9, 2, -9}, {0, 0, 0});
  const auto refused = [&](const Given& given) { return !method.supports(*scene, {method.settings(), given}).empty(); };
  CHECK_FALSE(refused({}));
  CHECK(refused({{"variant", "polar"}}));
  CHECK(refused({{"variant", "tele"}}));
  CHECK_FALSE(refused({{"variant", "direct"}, {"table", "8"}}));
  scene->lights = {scene::PointLight{}};
  CHECK(refused({{"sun", "true"}}));
  scene->media[0].field = scene::Homogeneous{};
  CHECK(refused({}));
}

}  // namespace frame_test
