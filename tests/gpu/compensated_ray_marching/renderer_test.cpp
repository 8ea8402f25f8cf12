// The renderer on the device against the CPU: every layer, at the worst pixel; frames after frames; extremes; what it refuses.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/compensated_ray_marching/compensated_ray_marching_gpu.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/convert/residual.h"
#include "scene/geometry/shapes.h"
#include "scene/media/fitted.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/methods/compensated_ray_marching/risen.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"
#include "tests/pictures.h"

namespace renderer_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

const compensated_ray_marching::CompensatedRayMarching cpu;
const gpu::CompensatedRayMarchingGpu device;
// Single precision: depths and places are rounded to 6e-8 of the whole, solves are carried on to 1e-5.
constexpr double bound = 5e-5;
// 72 directions: how many there are changes no kernel, and the experiment compensated_ray_marching/parity_gpu compares the default.
const Given small{{"cells", "12"}, {"tolerance", "1e-5"}, {"levels", "6"}};

scene::GaussianSum puffs() {
  scene::GaussianSum sum;
  sum.cutoff = 3;
  sum.gaussians = {{{0, 0, 0}, 0.4, 1}, {{0.5, 0.2, -0.1}, 0.25, 0.7}, {{-0.3, 0.4, 0.2}, 0.3, 0.9}};
  return sum;
}
scene::EnvironmentLight uneven(double turn = 0) {
  const double one = std::sqrt(4 * pi), slope = std::sqrt(4 * pi / 3);
  const Mat3 rotation = Eigen::AngleAxisd(turn, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  return scene::make_sh_environment(
      {Rgb::Constant(one), Rgb(-0.8 * slope, 0, 0.2), Rgb(0, 0.5, 0), Rgb(0, -0.5 * slope, 0.4)}, rotation,
      Rgb::Ones());
}
std::shared_ptr<scene::Scene> scene_of(scene::DensityField field, double sigma_t, double albedo,
                                       scene::EnvironmentLight light) {
  auto s = std::make_shared<scene::Scene>();
  s->camera = scene::look_at({0.3, 0.5, 4}, {0, 0.1, 0}, Vec3::UnitY());
  s->camera.vertical_fov = 0.6;
  s->width = 13;
  s->height = 9;
  s->lights = {std::move(light)};
  scene::Medium smoke;
  smoke.field = std::move(field);
  smoke.sigma_t = Rgb::Constant(sigma_t);
  smoke.albedo = Rgb::Constant(albedo);
  s->media = {smoke};
  finish(*s);
  return s;
}

void compare(const scene::Film& a, const scene::Film& b, double most = bound) {
  REQUIRE(a.layers.size() == b.layers.size());
  most += 20 * gpu::test::injected_error();
  for (const auto& [layer, values] : a.layers) {
    CAPTURE(layer);
    CHECK(gpu::test::quantile(a, b, layer, 1) < most);
  }
}
void compare(const std::shared_ptr<scene::Scene>& scene, const Given& given = small, double most = bound) {
  compare(picture(cpu, scene, given), picture(device, scene, given), most);
}

}  // namespace

TEST_CASE("compensated march on the device: thin to thick, albedo to 1",
          "[gpu][compensated_ray_marching][slow][thorough]") {
  if (!gpu::test::device()) return;
  for (const double sigma_t : {1e-3, 0.3, 4.0, 20.0})
    for (const double albedo : {0.5, 1.0}) {
      CAPTURE(sigma_t, albedo);
      Given given = small;
      given["deepest_cell"] = "4";  // 20 cells of the deepest, where 1.5 makes 50
      compare(scene_of(puffs(), sigma_t, albedo, uneven()), given);
    }
}

TEST_CASE("compensated march on the device: colours, phase functions, orders, suns, weights",
          "[gpu][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  auto scene = scene_of(puffs(), 3, 0.9, uneven());
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

TEST_CASE("compensated march on the device: voxels, turned, and what Gaussians leave",
          "[gpu][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {9, 7, 8};
  grid->origin_index = {1, -2, 0};
  grid->voxel_size = 0.2;
  grid->rotation = Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  grid->translation = {-1, -0.4, -0.8};
  for (int i = 0; i < 9 * 7 * 8; ++i) grid->values.push_back(float(std::max(0.0, 0.4 + std::sin(0.37 * i))));
  for (const bool clamped : {false, true}) {
    grid->clamp_border = clamped;
    compare(scene_of(scene::GridPointer(grid), 3, 0.8, uneven()));
  }
  auto fitted = std::make_shared<scene::Fitted>();
  fitted->gaussians = puffs();
  fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(*grid, fitted->gaussians, {0, {}}));
  fitted->grid = *grid;
  for (const char* residual : {"true", "false"}) {
    Given given = small;
    given["residual"] = residual;
    compare(scene_of(scene::FittedPointer(fitted), 3, 0.8, uneven()), given);
  }
}

TEST_CASE("compensated march on the device: surfaces, their shadows on smoke and the smoke's on them",
          "[gpu][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  auto scene = scene_of(puffs(), 4, 0.9, uneven());
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
  // Of voxels, turned, and before a picture with depth; then none at all.
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {9, 7, 8};
  grid->voxel_size = 0.2;
  grid->rotation = Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  grid->translation = {-0.7, -0.4, -0.8};
  for (int i = 0; i < 9 * 7 * 8; ++i) grid->values.push_back(float(std::max(0.0, 0.4 + std::sin(0.37 * i))));
  scene->media[0].field = scene::GridPointer(grid);
  scene::Backdrop backdrop{26, 18, {}, {}, true};
  for (int i = 0; i < 26 * 18; ++i) {
    for (int c = 0; c < 3; ++c) backdrop.radiance.push_back(float(0.1 + 0.001 * i + 0.1 * c));
    backdrop.depth.push_back(float(i % 3 ? 2.5 + 0.01 * i : infinity));
  }
  for (const bool picture : {false, true}) {
    if (picture) scene->backdrops.push_back(std::make_shared<const scene::Backdrop>(backdrop));
    finish(*scene);
    compare(scene);
  }
  scene->media[0].sigma_t = Rgb::Zero();
  finish(*scene);
  compare(scene);
}

TEST_CASE("compensated march on the device: other lights on surfaces in the next frame",
          "[gpu][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  const auto lit_by = [](scene::EnvironmentLight light) {
    auto scene = scene_of(puffs(), 4, 0.9, std::move(light));
    scene->surfaces = {{"ground", scene::Plane{{0, -0.8, 0}, Vec3::UnitY()}, scene::Lambert{Rgb(0.7, 0.6, 0.5)}}};
    finish(*scene);
    return scene;
  };
  const auto dark = lit_by(scene::make_constant_environment(Rgb::Zero()));
  // What was left out in the dark is prepared anew.
  CHECK(!device.prepare(dark, {device.settings(), small}, {1, {}})->next(lit_by(uneven(1)), {1, {}}));
  const auto prepared = device.prepare(lit_by(uneven(2)), {device.settings(), small}, {1, {}});
  for (const auto& scene : {lit_by(uneven(1)), dark, lit_by(uneven(0.3))}) {
    REQUIRE(prepared->next(scene, {1, {}}));
    compare(picture(cpu, scene, small), prepared->render(view_of(*scene), {1, {}}).film);
  }
}

TEST_CASE("compensated march on the device: the eye within, from above, far away; no smoke",
          "[gpu][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  auto scene = scene_of(puffs(), 3, 0.8, uneven());
  scene->camera = scene::look_at({0.05, 0.1, 0}, {1, 0.1, 0}, Vec3::UnitY());
  finish(*scene);
  compare(scene);
  scene->camera = scene::look_at({0, 40, 0}, {0, 0, 0}, Vec3::UnitZ());
  scene->camera.vertical_fov = 0.05;
  finish(*scene);
  compare(scene);
  scene->camera.kind = scene::Camera::Kind::orthographic;
  scene->camera.height = 2;
  finish(*scene);
  compare(scene);
  scene::GaussianSum none;
  none.cutoff = 3;
  compare(scene_of(none, 3, 0.8, uneven()));
  compare(scene_of(puffs(), 0, 0.8, uneven()));
}

TEST_CASE("compensated march on the device: the next frame's light as if prepared anew",
          "[gpu][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  const auto before = scene_of(puffs(), 4, 0.9, uneven(2)), after = scene_of(puffs(), 4, 0.9, uneven(0.3));
  const auto prepared = device.prepare(before, {device.settings(), small}, {1, {}});
  for (const auto& scene : {after, before, after}) {
    REQUIRE(prepared->next(scene, {1, {}}));
    const scene::Rendering warm = prepared->render(view_of(*scene), {1, {}});
    compare(picture(cpu, scene, small), warm.film);
    CHECK(warm.counters.at("iterations") > 0);
    CHECK(warm.counters.at("multiple_error") <= 1e-5);
  }
  // Another colour of light, and a sun: lights are arranged anew.
  auto sun = scene_of(puffs(), 4, 0.9, scene::make_constant_environment(Rgb::Ones()));
  REQUIRE(prepared->next(sun, {1, {}}));
  compare(picture(cpu, sun, small), prepared->render(view_of(*sun), {1, {}}).film);
  sun->lights.push_back(scene::DirectionalLight{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)});
  finish(*sun);
  REQUIRE(prepared->next(sun, {1, {}}));
  compare(picture(cpu, sun, small), prepared->render(view_of(*sun), {1, {}}).film);
}

TEST_CASE("compensated march on the device: other smoke as if prepared anew, in fewer iterations",
          "[gpu][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  const auto at = [](double step, double sigma_t) { return scene_of(risen(puffs(), step), sigma_t, 0.9, uneven()); };
  const auto prepared = device.prepare(at(0, 4), {device.settings(), small}, {1, {}});
  for (const auto& scene : {at(0.02, 0), at(0.02, 4.1)}) {
    REQUIRE(prepared->next(scene, {1, {}}));
    const scene::Rendering warm = prepared->render(view_of(*scene), {1, {}});
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

TEST_CASE("compensated march on the device: a map that turns, and another, in the next frame",
          "[gpu][compensated_ray_marching][thorough]") {
  if (!gpu::test::device()) return;
  const auto map = rough_map(64, 32);
  const auto at = [&](double turn) { return scene_of(puffs(), 4, 0.9, rough_sky(turn, map)); };
  const auto prepared = device.prepare(at(0), {device.settings(), small}, {1, {}});
  for (const auto& scene : {at(0.4), at(2), scene_of(puffs(), 4, 0.9, rough_sky(2, rough_map(32, 16, 3))), at(0)}) {
    REQUIRE(prepared->next(scene, {1, {}}));
    compare(picture(cpu, scene, small), prepared->render(view_of(*scene), {1, {}}).film);
  }
}

TEST_CASE("compensated march on the device: suns that move, come and go, for a bit a node",
          "[gpu][compensated_ray_marching][thorough]") {
  gpu::Context* context = gpu::test::device();
  if (!context) return;
  const Given few{{"cells", "8"}, {"tolerance", "1e-5"}, {"levels", "6"}};
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {9, 7, 8};
  grid->voxel_size = 0.2;
  grid->translation = {-0.8, -0.6, -0.7};
  for (int i = 0; i < 9 * 7 * 8; ++i) grid->values.push_back(float(std::max(0.0, 0.4 + std::sin(0.37 * i))));
  const scene::DirectionalLight high{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)},
      low{Vec3(-3, 1, 1).normalized(), Rgb(3, 1, 0)}, along{Vec3::UnitX(), Rgb(1, 1, 2)};
  for (const scene::DensityField& field : {scene::DensityField(puffs()), scene::DensityField(scene::GridPointer(grid))})
    for (const bool objects : {false, true}) {
      const auto lit_by = [&](const std::vector<scene::DirectionalLight>& suns) {
        auto scene = scene_of(field, 4, 0.9, scene::make_constant_environment(Rgb::Constant(0.2)));
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
        const gpu::Use use(*context);
        const gpu::Traffic then = context->traffic();
        REQUIRE(prepared->next(scene, {1, {}}));
        const gpu::Traffic moved = context->traffic() - then;
        CAPTURE(objects, suns.size(), field.index());
        compare(picture(cpu, scene, few), prepared->render(view_of(*scene), {1, {}}).film);
        // Of each direction where it is, its harmonics, its power: 20 floats and 4; where one moved, the nodes that it does not see.
        const long directions = 6 * 12 + long(suns.size()), nodes = objects ? 8 * 8 * 8 / 8 : 0;
        if (suns.size() <= before)
          CHECK(moved.bytes_up <= 4 * 24 * directions + long(suns.size()) * (nodes + 4) + 4 * 3 * 4);
        before = std::max(before, suns.size());
      }
    }
}

TEST_CASE("compensated march on the device: black smoke and phase functions at their ends stay finite",
          "[gpu][compensated_ray_marching][slow][thorough]") {
  if (!gpu::test::device()) return;
  const Given any_depth{{"cells", "6"}, {"deepest_cell", "1e9"}, {"iterations", "100"}};
  for (const double sigma_t : {1e-6, 7e3})
    for (const double g : {-0.99, 0.0, 0.99}) {
      auto scene = scene_of(puffs(), sigma_t, 1, uneven());
      scene->media[0].phase = scene::HenyeyGreenstein{g};
      finish(*scene);
      CAPTURE(sigma_t, g);
      const scene::Film film = picture(device, scene, any_depth);
      for (const auto& [layer, values] : film.layers)
        for (const float v : values) REQUIRE((std::isfinite(v) && v >= 0 && v < 100));
    }
}

TEST_CASE("compensated march on the device: hard edges of regions", "[gpu][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  auto scene = scene_of(puffs(), 3, 0.9, uneven());
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
  auto scene = scene_of(puffs(), 3, 0.8, uneven());
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, {{"multiple", "p1"}}), Contains("multiple = p1"));
  scene->media[0].region = scene::Sphere{};
  CHECK(reason(*scene).empty());
  scene->media[0].field = scene::Homogeneous{};
  CHECK_THAT(reason(*scene), Contains("is homogeneous, expected gaussians or grid or fitted"));
}

}  // namespace renderer_test
