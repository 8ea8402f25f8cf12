// The renderer on the device against the CPU: every layer, at the worst pixel; frames after frames; extremes; what it refuses.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/compensated_ray_marching/compensated_ray_marching.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/geometry/shapes.h"
#include "tests/gpu/compensated_ray_marching/pictures.h"

namespace renderer_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;
using gpu::test::backdrop_with_depths;
using gpu::test::fitted_with_residual;
using gpu::test::scene_13_wide;
using gpu::test::uneven_voxels;

namespace {

const compensated_ray_marching::CompensatedRayMarching cpu;
const gpu::compensated_ray_marching::CompensatedRayMarching device;
// 72 directions: how many there are changes no kernel, and the experiment compensated_ray_marching/parity_gpu compares the default.
const Given small{{"cells", "12"}, {"tolerance", "1e-5"}, {"levels", "6"}};

const Given diffusion{{"cells", "12"},       {"levels", "6"},        {"multiple", "p1"},
                      {"tolerance", "1e-9"}, {"iterations", "5000"}, {"deepest_cell", "9"}};

using gpu::test::compare;
void compare(const std::shared_ptr<scene::Scene>& scene, const Given& given = small) {
  compare(picture(cpu, scene, given), picture(device, scene, given));
}

}  // namespace

DEVICE_TEST_CASE("compensated march on the device: thin to thick, albedo to 1",
                 "[gpu][compensated_ray_marching][slow][thorough]") {
  for (const double sigma_t : {1e-3, 0.3, 4.0, 20.0})
    for (const double albedo : {0.5, 1.0}) {
      CAPTURE(sigma_t, albedo);
      Given given = small;
      given["deepest_cell"] = "4";  // 20 cells of the deepest, where 1.5 makes 50
      compare(scene_13_wide(puffs(), sigma_t, albedo, uneven()), given);
    }
}

DEVICE_TEST_CASE("compensated march on the device: colours, phase functions, orders, suns, weights",
                 "[gpu][compensated_ray_marching]") {
  auto scene = scene_13_wide(puffs(), 3, 0.9, uneven());
  scene->media[0].sigma_t = Rgb(2, 3, 3);
  scene->media[0].albedo = Rgb(0.9, 0.6, 0.6);
  scene->ambient_in_scatter = Rgb(0.1, 0.2, 0.3);
  for (const scene::PhaseFunction& phase :
       {scene::PhaseFunction(scene::HenyeyGreenstein{0.6}), scene::PhaseFunction(scene::Murky{})}) {
    scene->media[0].phase = phase;
    finish(*scene);
    compare(scene);
  }
  scene->lights.push_back(scene::DirectionalLight{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)});
  scene->lights.push_back(scene::make_constant_environment(Rgb(0.2, 0.1, 0)));
  finish(*scene);
  compare(scene);
  for (const char* order : {"1", "3"}) {
    Given given = small;
    given["order"] = order;
    given["slice_weight"] = order[0] == '1' ? "printed" : "paper";
    given["levels"] = "5";
    CAPTURE(order);
    compare(scene, given);
  }
  compare(scene, {{"cells", "12"}, {"multiple", "none"}});
}

DEVICE_TEST_CASE("compensated march on the device: as many directions and bands as there can be",
                 "[gpu][compensated_ray_marching]") {
  const auto scene = scene_13_wide(puffs(), 3, 0.8, uneven());
  Given given = diffusion;
  given["cells"] = "6";
  given["levels"] = "32";
  given["order"] = "6";
  compare(scene, given);
  compare(scene, {{"cells", "6"},
                  {"tolerance", "1e-5"},
                  {"levels", "4"},
                  {"order", "6"},
                  {"ordinate_levels", "16"},
                  {"azimuths", "64"}});
}

DEVICE_TEST_CASE("compensated march on the device: voxels, turned, and what Gaussians leave",
                 "[gpu][compensated_ray_marching]") {
  const auto grid = uneven_voxels({-1, -0.4, -0.8});
  grid->origin_index = {1, -2, 0};
  for (const bool clamped : {false, true}) {
    grid->clamp_border = clamped;
    compare(scene_13_wide(scene::GridPointer(grid), 3, 0.8, uneven()));
  }
  for (const char* residual : {"true", "false"}) {
    Given given = small;
    given["residual"] = residual;
    compare(scene_13_wide(fitted_with_residual(*grid), 3, 0.8, uneven()), given);
  }
}

DEVICE_TEST_CASE("compensated march on the device: surfaces, their shadows on smoke and the smoke's on them",
                 "[gpu][compensated_ray_marching]") {
  auto scene = scene_13_wide(puffs(), 4, 0.9, uneven());
  scene->camera = scene::look_at({0.3, 1.7, 3.4}, {0, 0, 0}, Vec3::UnitY());
  scene->width = 26;
  scene->height = 18;
  scene->surfaces = {{"ground", scene::Plane{{0, -0.8, 0}, Vec3::UnitY()}, scene::Lambert{Rgb(0.7, 0.6, 0.5)}},
                     {"ball", scene::Sphere{{0.6, 0.6, 0.5}, 0.25}, scene::Phong{}},
                     {"box", scene::make_box({Point3(-0.9, -0.8, -0.6), Point3(-0.6, 0.1, 0.2)}), scene::Lambert{}}};
  Given single = small;
  single["multiple"] = "none";
  for (const bool sun : {false, true}) {
    if (sun) scene->lights.push_back(scene::DirectionalLight{Vec3(1, 2, 1).normalized(), Rgb(1, 2, 3)});
    finish(*scene);
    compare(scene);
    compare(scene, single);
  }
  // Rotated voxels, without and with a picture with depth behind them. Then no smoke at all.
  scene->media[0].field = scene::GridPointer(uneven_voxels({-0.7, -0.4, -0.8}));
  for (const bool picture : {false, true}) {
    if (picture) scene->backdrops.push_back(backdrop_with_depths(26, 18));
    finish(*scene);
    compare(scene);
  }
  scene->media[0].sigma_t = Rgb::Zero();
  finish(*scene);
  compare(scene);
}

DEVICE_TEST_CASE("compensated march on the device: other lights on surfaces in the next frame",
                 "[gpu][compensated_ray_marching]") {
  const auto lit_by = [](scene::EnvironmentLight light) {
    auto scene = scene_13_wide(puffs(), 4, 0.9, std::move(light));
    scene->surfaces = {{"ground", scene::Plane{{0, -0.8, 0}, Vec3::UnitY()}, scene::Lambert{Rgb(0.7, 0.6, 0.5)}}};
    finish(*scene);
    return scene;
  };
  const auto dark = lit_by(scene::make_constant_environment(Rgb::Zero()));
  // Stages that were left out in the dark are prepared anew.
  CHECK(!device.prepare(dark, {device.settings(), small}, {1, {}})->next(lit_by(uneven(1)), {1, {}}));
  const auto prepared = device.prepare(lit_by(uneven(2)), {device.settings(), small}, {1, {}});
  for (const auto& scene : {lit_by(uneven(1)), dark, lit_by(uneven(0.3))}) {
    compare(picture(cpu, scene, small), next_frame(*prepared, scene).film);
  }
}

DEVICE_TEST_CASE("compensated march on the device: the eye within, from above, far away; no smoke",
                 "[gpu][compensated_ray_marching]") {
  auto scene = scene_13_wide(puffs(), 3, 0.8, uneven());
  for (const scene::Camera& camera : gpu::test::cameras_about_puffs()) {
    scene->camera = camera;
    finish(*scene);
    compare(scene);
  }
  scene::GaussianSum none;
  none.cutoff = 3;
  compare(scene_13_wide(none, 3, 0.8, uneven()));
  compare(scene_13_wide(puffs(), 0, 0.8, uneven()));
}

DEVICE_TEST_CASE("compensated march on the device: the next frame's light as if prepared anew",
                 "[gpu][compensated_ray_marching]") {
  const auto before = scene_13_wide(puffs(), 4, 0.9, uneven(2)), after = scene_13_wide(puffs(), 4, 0.9, uneven(0.3));
  const auto prepared = device.prepare(before, {device.settings(), small}, {1, {}});
  for (const auto& scene : {after, before, after}) {
    const scene::Rendering warm = next_frame(*prepared, scene);
    compare(picture(cpu, scene, small), warm.film);
    CHECK(warm.counters.at("iterations") > 0);
    CHECK(warm.counters.at("multiple_error") <= 1e-5);
  }
  // Another colour of light, and a sun: lights are arranged anew.
  auto sun = scene_13_wide(puffs(), 4, 0.9, scene::make_constant_environment(Rgb::Ones()));
  compare(picture(cpu, sun, small), next_frame(*prepared, sun).film);
  sun->lights.push_back(scene::DirectionalLight{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)});
  finish(*sun);
  compare(picture(cpu, sun, small), next_frame(*prepared, sun).film);
}

DEVICE_TEST_CASE("compensated march on the device: other smoke as if prepared anew, in fewer iterations",
                 "[gpu][compensated_ray_marching]") {
  const auto at = [](double step, double sigma_t) {
    return scene_13_wide(risen(puffs(), step), sigma_t, 0.9, uneven());
  };
  const auto prepared = device.prepare(at(0, 4), {device.settings(), small}, {1, {}});
  for (const auto& scene : {at(0.02, 0), at(0.02, 4.1)}) {
    const scene::Rendering warm = next_frame(*prepared, scene);
    const scene::Rendering cold =
        device.prepare(scene, {device.settings(), small}, {1, {}})->render(view_of(*scene), {1, {}});
    compare(cold.film, warm.film);
    if (scene->media[0].sigma_t[0] == 0) continue;
    CHECK(warm.counters.at("iterations") > 0);
    CHECK(warm.counters.at("iterations") < cold.counters.at("iterations"));
  }
  const auto once = device.prepare(at(0, 4), {device.settings(), {{"multiple", "none"}}}, {1, {}});
  CHECK_FALSE(once->next(at(0.02, 4), {1, {}}));
}

DEVICE_TEST_CASE("compensated march on the device: a map that turns, and another, in the next frame",
                 "[gpu][compensated_ray_marching][thorough]") {
  const auto map = rough_map(64, 32);
  const auto at = [&](double turn) { return scene_13_wide(puffs(), 4, 0.9, rough_sky(turn, map)); };
  const auto prepared = device.prepare(at(0), {device.settings(), small}, {1, {}});
  for (const auto& scene :
       {at(0.4), at(2), scene_13_wide(puffs(), 4, 0.9, rough_sky(2, rough_map(32, 16, 3))), at(0)}) {
    compare(picture(cpu, scene, small), next_frame(*prepared, scene).film);
  }
}

DEVICE_TEST_CASE("compensated march on the device: suns that move, come and go, for a bit a node",
                 "[gpu][compensated_ray_marching][thorough]") {
  const Given few{{"cells", "8"}, {"tolerance", "1e-5"}, {"levels", "6"}};
  const scene::DirectionalLight high{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)},
      low{Vec3(-3, 1, 1).normalized(), Rgb(3, 1, 0)}, along{Vec3::UnitX(), Rgb(1, 1, 2)};
  for (const scene::DensityField& field :
       {scene::DensityField(puffs()), scene::DensityField(scene::GridPointer(uneven_voxels({-0.8, -0.6, -0.7}, 0)))})
    for (const bool objects : {false, true}) {
      const auto lit_by = [&](const std::vector<scene::DirectionalLight>& suns) {
        auto scene = scene_13_wide(field, 4, 0.9, scene::make_constant_environment(Rgb::Constant(0.2)));
        for (const auto& sun : suns) scene->lights.push_back(sun);
        if (objects) scene->surfaces = {{"ball", scene::Sphere{{0.6, 0.6, 0.5}, 0.25}, scene::Lambert{}}};
        finish(*scene);
        return scene;
      };
      const auto prepared = device.prepare(lit_by({high}), {device.settings(), few}, {1, {}});
      std::size_t before = 1;
      for (const auto& suns : std::vector<std::vector<scene::DirectionalLight>>{
               {low}, {low}, {along, low}, {high, low}, {}, {low}, {high, along}, {high, along, low}}) {
        const auto scene = lit_by(suns);
        const gpu::Use use(context);
        const gpu::Traffic then = context.traffic();
        REQUIRE(prepared->next(scene, {1, {}}));
        const gpu::Traffic moved = context.traffic() - then;
        CAPTURE(objects, suns.size(), field.index());
        compare(picture(cpu, scene, few), prepared->render(view_of(*scene), {1, {}}).film);
        // Upload per direction: the direction and its harmonics (20 floats), its power (4 floats). If a direction
        // moved, also the nodes that it does not see.
        const long directions = 6 * 12 + long(suns.size()), nodes = objects ? 8 * 8 * 8 / 8 : 0;
        if (suns.size() <= before)
          CHECK(moved.bytes_up <= 4 * 24 * directions + long(suns.size()) * (nodes + 4) + 4 * 3 * 4);
        before = std::max(before, suns.size());
      }
    }
}

DEVICE_TEST_CASE("compensated march on the device: black smoke and phase functions at their ends stay finite",
                 "[gpu][compensated_ray_marching][slow][thorough]") {
  const Given any_depth{{"cells", "6"}, {"deepest_cell", "1e9"}, {"iterations", "100"}};
  for (const double sigma_t : {1e-6, 7e3})
    for (const double g : {-0.99, 0.0, 0.99}) {
      auto scene = scene_13_wide(puffs(), sigma_t, 1, uneven());
      scene->media[0].phase = scene::HenyeyGreenstein{g};
      finish(*scene);
      CAPTURE(sigma_t, g);
      const scene::Film film = picture(device, scene, any_depth);
      for (const auto& [layer, values] : film.layers)
        for (const float v : values) REQUIRE((std::isfinite(v) && v >= 0 && v < 100));
    }
}

DEVICE_TEST_CASE("compensated march on the device: diffusion, thin to thick", "[gpu][compensated_ray_marching]") {
  for (const double sigma_t : {0.3, 20.0})
    for (const double albedo : {0.5, 1.0}) {
      CAPTURE(sigma_t, albedo);
      compare(scene_13_wide(puffs(), sigma_t, albedo, uneven()), diffusion);
    }
}

DEVICE_TEST_CASE("compensated march on the device: diffusion of colours, by orders, and in the next frames",
                 "[gpu][compensated_ray_marching]") {
  const auto lit_by = [](scene::EnvironmentLight light) {
    auto scene = scene_13_wide(puffs(), 3, 0.9, std::move(light));
    scene->media[0].sigma_t = Rgb(2, 3, 3);
    scene->media[0].albedo = Rgb(0.9, 0.6, 0.6);
    scene->media[0].phase = scene::HenyeyGreenstein{0.6};
    finish(*scene);
    return scene;
  };
  for (const char* order : {"1", "2", "3"}) {
    Given given = diffusion;
    given["order"] = order;
    CAPTURE(order);
    compare(lit_by(uneven()), given);
  }
  const auto prepared = device.prepare(lit_by(uneven(2)), {device.settings(), diffusion}, {1, {}});
  const double cold = prepared->render(view_of(*lit_by(uneven(2))), {1, {}}).counters.at("iterations");
  auto sun = lit_by(scene::make_constant_environment(Rgb::Constant(0.2)));
  sun->lights.push_back(scene::DirectionalLight{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)});
  finish(*sun);
  const scene::Rendering near = next_frame(*prepared, lit_by(uneven(1.99)));
  compare(picture(cpu, lit_by(uneven(1.99)), diffusion), near.film);
  CHECK(near.counters.at("iterations") < cold);
  CHECK(near.counters.at("multiple_error") <= 1e-9);
  for (const auto& scene : {lit_by(uneven(0.3)), lit_by(scene::make_constant_environment(Rgb::Ones())),
                            lit_by(scene::make_constant_environment(Rgb::Zero())), lit_by(uneven(1)), sun})
    compare(picture(cpu, scene, diffusion), next_frame(*prepared, scene).film);
  // In other smoke diffusion begins with nothing, as on the CPU: it is prepared anew.
  auto risen_puffs = lit_by(uneven(1));
  risen_puffs->media[0].field = risen(puffs(), 0.02);
  finish(*risen_puffs);
  CHECK_FALSE(prepared->next(risen_puffs, {1, {}}));
}

DEVICE_TEST_CASE("compensated march on the device: hard edges of regions", "[gpu][compensated_ray_marching]") {
  auto scene = scene_13_wide(puffs(), 3, 0.9, uneven());
  for (const scene::Region& region :
       {scene::Region(scene::Sphere{{0.1, 0.1, 0}, 0.5}), scene::Region(Box{{-0.4, -0.3, -1}, {0.5, 0.6, 0.3}}),
        scene::Region(scene::Slab{Vec3(1, 2, 0).normalized(), -0.3, 0.4})}) {
    CAPTURE(region_name(region));
    scene->media[0].region = region;
    scene->lights = {uneven()};
    finish(*scene);
    compare(scene);
    scene::DirectionalLight sun;
    sun.to_light = Vec3(1, 2, 1).normalized();
    scene->lights = {sun};
    finish(*scene);
    compare(scene);
  }
}

TEST_CASE("compensated march on the device: refusals name the reason", "[gpu][compensated_ray_marching]") {
  const auto reason = [](const scene::Scene& scene, const Given& given = {}) {
    const auto reasons = device.supports(scene, {device.settings(), given});
    return reasons.empty() ? std::string() : reasons.front();
  };
  auto scene = scene_13_wide(puffs(), 3, 0.8, uneven());
  CHECK(reason(*scene).empty());
  scene->media[0].region = scene::Sphere{};
  CHECK(reason(*scene).empty());
  scene->media[0].field = scene::Homogeneous{};
  CHECK_THAT(reason(*scene), Contains("is homogeneous, expected gaussians or grid or fitted"));
}

}  // namespace renderer_test
