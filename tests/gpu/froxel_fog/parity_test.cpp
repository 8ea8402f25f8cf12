// Froxel fog on the device against froxel fog on the processor: same settings, same grid, same picture to single precision.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "gpu/froxel_fog/froxel_fog.h"
#include "gpu/ray_marcher/rounds.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/reference/froxel_fog/fog_scenes.h"

namespace froxel_parity_test {

using namespace airlight;
using test::Given;
using SharedScene = std::shared_ptr<const scene::Scene>;

namespace {

// A film that is no multiple of froxels.
scene::View look() {
  scene::View view;
  view.camera = scene::look_at(Point3(0.4, 0.3, 4), Point3(0, 0, 0), Vec3::UnitY());
  view.camera.vertical_fov = 0.7;
  view.width = 29;
  view.height = 21;
  return view;
}

SharedScene seen_by(const scene::Scene& original, const scene::View& view) {
  auto scene = std::make_shared<scene::Scene>(original);
  scene->camera = view.camera, scene->width = view.width, scene->height = view.height;
  finish(*scene);
  return scene;
}

Given small_maps(Given given) {
  given.insert({"environment_directions", "8"});
  const bool engine = given.count("preset") != 0 && given["preset"] != "fitted";  // which has no maps
  if (given.count("self_shadow") == 0 ? !engine : given["self_shadow"] == "map")
    given.insert({{"map_size", "40"}, {"map_steps", "50"}});
  return given;
}

struct Bounds {
  double p99 = 2.7e-5, worst = infinity;  // measured: 8.8e-6, of pictures that go on from others
};

void compare(const std::string& name, const scene::Rendering& cpu, const scene::Rendering& gpu,
             const Bounds& bounds = {}) {
  CAPTURE(name);
  gpu::test::agree(name, cpu.film, gpu.film, {bounds.p99, bounds.worst});
  REQUIRE(gpu.film.layers.size() == cpu.film.layers.size());
  const auto warning = [](const scene::Film& film) {
    const auto found = film.metadata.find("warning");
    return found == film.metadata.end() ? "" : found->second.substr(found->second.find(':'));
  };
  CHECK(warning(cpu.film) == warning(gpu.film));
  for (const auto& [counter, value] : cpu.counters) {
    CAPTURE(counter);
    // Points in a boundary may lie on either side, and where nothing is left of a sum rounding may leave something.
    CHECK(gpu.counters.at(counter) == Approx(value).epsilon(4e-3).margin(8));
  }
}

void agree(const std::string& name, const SharedScene& scene, const Given& given, const Bounds& bounds = {}) {
  std::string label = name;
  for (const auto& [setting, value] : given) label += ", " + setting + " = " + value;
  const Given all = small_maps(given);
  compare(label, test::render(froxel_fog::FroxelFog(), scene, all),
          test::render(gpu::froxel_fog::FroxelFog(), scene, all), bounds);
}

SharedScene smoke(const scene::Camera& camera, int width = 29, int height = 21) {
  scene::GaussianSum sum;
  sum.gaussians = {{Point3(0.1, 0.2, 0), 0.3, 2.0}, {Point3(-0.4, 0, 0.3), 0.2, 3.0}};
  return froxel_fog::fog_scene({froxel_fog::make_medium(sum, scene::Unbounded{}, Rgb(2, 3, 4), Rgb(0.9, 0.7, 0.5))},
                               {scene::DirectionalLight{Vec3(1, 2, 1).normalized(), Rgb(2, 2, 2)}}, camera, width,
                               height);
}

}  // namespace

// Every medium, region, phase function, kind of light and surface of the marcher's tests.
DEVICE_TEST_CASE("froxel fog: presets on the GPU are those of the CPU", "[gpu][froxel_fog]") {
  for (const auto& [name, scene] : ray_marcher::assorted_scenes()) {
    if (name == "overlap of all") continue;  // comes again with surfaces
    for (const char* preset : {"fitted", "hdrp", "godot"}) agree(name, seen_by(*scene, look()), {{"preset", preset}});
  }
}

DEVICE_TEST_CASE("froxel fog: every setting of the GPU is that of the CPU", "[gpu][froxel_fog]") {
  const SharedScene scene = smoke(froxel_fog::wide_camera());
  const Given all[] = {{{"tile", "3"}, {"slices", "17"}},
                       {{"volume_size", "9"}},
                       {{"near", "1.5"}},
                       {{"near", "2.5"}, {"far", "3.1"}},
                       {{"near", "9"}},  // beyond the media: an empty range
                       {{"depth", "log"}, {"log_c", "2"}},
                       {{"depth", "power"}, {"exponent", "1.7"}, {"far", "6"}},
                       {{"depth", "exponential"}, {"near", "0.2"}, {"far", "10"}},
                       {{"jitter", "halton"}, {"frames", "5"}},
                       {{"jitter", "halton"}, {"frames", "70"}, {"slices", "5"}},  // two batches
                       {{"jitter", "hdrp"}, {"frames", "9"}, {"blend", "ema"}, {"history_weight", "0.7"}},
                       {{"filter", "gauss3"}},
                       {{"filter", "gauss7"}, {"slices", "3"}},
                       {{"self_shadow", "none"}},
                       {{"map_encoding", "avsm"}},
                       {{"map_encoding", "fourier"}},
                       {{"map_encoding", "beer"}}};
  for (const Given& given : all) agree("smoke", scene, given);
  scene::Camera parallel = froxel_fog::parallel_camera();
  parallel.height = 2;
  agree("parallel rays", smoke(parallel), {{"jitter", "halton"}, {"frames", "3"}});
}

// Surfaces and pictures with depth end the rays of froxels and of pixels, and are seen through the fog.
DEVICE_TEST_CASE("froxel fog: what ends rays on the GPU", "[gpu][froxel_fog]") {
  for (const char* file : {"crosscheck/mesh_in_fog", "crosscheck/surfaces_in_fog", "elephant_fog"}) {
    auto changed = *test::scene_named(file, 61, 45);
    for (scene::Light& light : changed.lights)
      if (auto* point = std::get_if<scene::PointLight>(&light)) point->radius = 0.05;
    agree(file, seen_by(changed, view_of(changed)), {{"tile", "4"}, {"jitter", "halton"}, {"frames", "4"}});
    agree(file, seen_by(changed, view_of(changed)), {{"preset", "hdrp"}, {"tile", "4"}});
    // By the rasteriser, too, but for silhouettes; the rays of froxels go through the tree all the same.
    Given given = small_maps({{"tile", "4"}, {"jitter", "halton"}, {"frames", "4"}});
    const auto scene = seen_by(changed, view_of(changed));
    const scene::Rendering tree = test::render(gpu::froxel_fog::FroxelFog(), scene, given);
    given["first_hits"] = "raster";
    const scene::Rendering raster = test::render(gpu::froxel_fog::FroxelFog(), scene, given);
    CHECK(tree.counters.at("draws") == 0);
    CHECK(raster.counters.at("draws") > 0);
    gpu::test::agree(file, tree.film, raster.film, {4e-6}, {"mean", "airlight", "surface"});
  }
  // Cells' centres lie between the picture's pixels.
  auto behind = std::make_shared<scene::Scene>(*smoke(froxel_fog::wide_camera(), 32, 24));
  scene::Backdrop backdrop{32, 24, {}, {}, true};
  for (int i = 0; i < 32 * 24; ++i) {
    backdrop.depth.push_back(i % 7 == 0 ? float(infinity) : 2.5f + 0.001f * float(i));
    for (int c = 0; c < 3; ++c) backdrop.radiance.push_back(0.1f + 0.01f * float(i % 32 + c));
  }
  behind->backdrops.push_back(std::make_shared<const scene::Backdrop>(backdrop));
  agree("backdrop", behind, {{"tile", "4"}});
  agree("backdrop", behind, {{"tile", "4"}, {"jitter", "halton"}, {"frames", "3"}});
}

// Each picture goes on from the last one, seen by another camera, and lit by a light that moves.
DEVICE_TEST_CASE("froxel fog: pictures that go on on the GPU", "[gpu][froxel_fog]") {
  const auto at = [](int step) {
    const double angle = 0.04 * step;
    scene::Camera camera = scene::look_at(Point3(3 * std::sin(angle), 0.4, 3 * std::cos(angle)),
                                          Point3(0.1, 0.05 * step, 0), Vec3::UnitY());
    camera.vertical_fov = 0.9;
    auto scene = std::make_shared<scene::Scene>(*smoke(camera, step == 3 ? 40 : 29));
    scene->media[0].sigma_t *= 1 + 0.05 * step;
    if (step == 5) scene->camera = scene::look_at(Point3(0, 0, 3), Point3(0, 0, 6), Vec3::UnitY());  // sees no medium
    finish(*scene);
    return scene;
  };
  for (const Given& given :
       {Given{{"reproject", "true"}, {"tile", "4"}, {"slices", "24"}, {"jitter", "halton"}},
        Given{{"reproject", "true"}, {"preset", "godot"}, {"volume_size", "12"}, {"far", "6"}},
        Given{{"reproject", "true"}, {"near", "1"}, {"far", "5"}, {"tile", "4"}, {"depth", "log"}}}) {
    const Given all = small_maps(given);
    const froxel_fog::FroxelFog cpu;
    const gpu::froxel_fog::FroxelFog gpu;
    const auto a = cpu.prepare(at(0), {cpu.settings(), all}, {1, {}}),
               b = gpu.prepare(at(0), {gpu.settings(), all}, {1, {}});
    compare("picture 0", a->render(view_of(*at(0)), {1, {}}), b->render(view_of(*at(0)), {1, {}}));
    for (int step = 1; step <= 6; ++step) {
      const scene::Rendering expected = test::next_frame(*a, at(step)), made = test::next_frame(*b, at(step));
      compare("picture " + std::to_string(step), expected, made);
      CHECK(made.counters.at("froxels") == expected.counters.at("froxels"));
      if (step < 5) CHECK(made.counters.at("reprojected") > 0.3 * made.counters.at("froxels"));
      if (step == 2) CHECK(made.counters.at("allocations") == 0);  // of two volumes that change places
      // Again, from the same history.
      CHECK(b->render(view_of(*at(step)), {1, {}}).film.layers == made.film.layers);
    }
  }
  const gpu::froxel_fog::FroxelFog gpu;
  const auto alone = gpu.prepare(at(0), {gpu.settings(), {}}, {1, {}});  // without reproject there is no history
  CHECK(test::next_frame(*alone, at(1)).film.layers == test::picture(gpu, at(1)).layers);
}

// Where a froxel stops until the next round changes nothing.
DEVICE_TEST_CASE("froxel fog: pictures and counters are the same in any rounds", "[gpu][froxel_fog]") {
  const auto original = test::scene_named("elephant_fog", 24, 18);
  auto changed = *original;
  changed.lights.push_back(scene::make_constant_environment(Rgb(0.5, 0.7, 1)));
  const SharedScene scene = seen_by(changed, view_of(changed));
  const Given given = small_maps({{"slices", "9"}, {"jitter", "halton"}, {"frames", "5"}});
  struct Budget {
    explicit Budget(int budget) { gpu::ray_marcher::Rounds::budget = budget; }
    ~Budget() { gpu::ray_marcher::Rounds::budget = 0; }
  };
  const scene::Rendering whole = [&] {
    const Budget budget(60000);
    return test::render(gpu::froxel_fog::FroxelFog(), scene, given);
  }();
  for (const int iterations : {300, 20}) {
    const Budget budget(iterations);
    const scene::Rendering parts = test::render(gpu::froxel_fog::FroxelFog(), scene, given);
    CHECK(parts.film.layers == whole.film.layers);
    CHECK(parts.counters.at("dispatches") > whole.counters.at("dispatches"));
    for (const char* counter : {"points", "look_ups", "occlusion_rays"})
      CHECK(parts.counters.at(counter) == whole.counters.at(counter));
  }
}

// Thin endless fog: the slices reach so far that none is near the lamp, and the picture says so. Which step is the worst is up to rounding.
DEVICE_TEST_CASE("froxel fog: slices that are too coarse are told on the GPU as on the CPU", "[gpu][froxel_fog]") {
  const SharedScene scene = froxel_fog::fog_scene(
      {froxel_fog::make_medium(scene::Homogeneous{1}, scene::Unbounded{}, Rgb::Constant(1e-6), Rgb::Constant(0.9))},
      {scene::PointLight{Point3(1.5, 2, 0.5), Rgb::Constant(10), 0}}, froxel_fog::wide_camera(), 9, 7);
  const Given given = small_maps({{"tile", "1"}, {"slices", "256"}});
  const scene::Film cpu = test::picture(froxel_fog::FroxelFog(), scene, given),
                    gpu = test::picture(gpu::froxel_fog::FroxelFog(), scene, given);
  const std::string same = "on 100 % of rays a lamp is nearer than half a step";
  CHECK_THAT(cpu.metadata.at("warning"), Catch::StartsWith("froxel_fog: " + same));
  CHECK_THAT(gpu.metadata.at("warning"), Catch::StartsWith("froxel_fog_gpu: " + same));
}

TEST_CASE("froxel fog: what the GPU does not do is said; a render can be stopped", "[gpu][froxel_fog]") {
  const gpu::froxel_fog::FroxelFog fog;
  const auto reasons = [&](const scene::Scene& scene, const Given& given) {
    return fog.supports(scene, {fog.settings(), given});
  };
  const SharedScene scene = smoke(froxel_fog::wide_camera());
  CHECK(reasons(*scene, {}).empty());
  REQUIRE(reasons(*scene, {{"far", "1e7"}}).size() == 1);
  CHECK_THAT(reasons(*scene, {{"far", "1e7"}})[0], Catch::Contains("single precision"));
  CHECK(reasons(*scene, {{"near", "5"}, {"far", "4"}}).size() == 1);
  CHECK(reasons(*test::scene_named("legendre_cloud", 8, 6), {}).empty());
  if (!gpu::test::device()) return;
  const auto prepared = fog.prepare(scene, {fog.settings(), {}}, {1, {}});
  CHECK_THROWS_AS(prepared->render(view_of(*scene), {1, [](double) { return false; }}), scene::Interrupted);
  // And goes on as if nothing had been.
  const scene::Film film = prepared->render(view_of(*scene), {1, {}}).film;
  CHECK(film.layers == test::picture(fog, scene).layers);
}

}  // namespace froxel_parity_test
