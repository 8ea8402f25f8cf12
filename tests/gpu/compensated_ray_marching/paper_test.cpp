// variant = paper on the device against the CPU: every layer of every setting, extremes, frames after frames, what goes up for them.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/compensated_ray_marching/compensated_ray_marching.h"
#include "gpu/context.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/geometry/shapes.h"
#include "scene/math/random.h"
#include "tests/gpu/compensated_ray_marching/pictures.h"

namespace paper_test {

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

Given paper(Given more = {}) {
  more["variant"] = "paper";
  return more;
}

// Many, overlapping, of a plume 1 m wide.
scene::GaussianSum cloud(int count) {
  scene::GaussianSum sum;
  sum.cutoff = 3;
  for (int i = 0; i < count; ++i) {
    const PhiloxCounter a = philox4x32_10({std::uint32_t(i), 0, 0, 0}, {2008, 5}),
                        b = philox4x32_10({std::uint32_t(i), 1, 0, 0}, {2008, 5});
    sum.gaussians.push_back({Point3(uniform32(a[0]), 1.5 * uniform32(a[1]), uniform32(a[2])) - Point3(0.5, 0.75, 0.5),
                             0.08 + 0.12 * uniform32(b[0]), 0.1 + 0.9 * uniform32(b[1])});
  }
  return sum;
}
using gpu::test::compare;
void compare(const std::shared_ptr<scene::Scene>& scene, const Given& given = paper()) {
  const scene::Rendering a = render(cpu, scene, given), b = render(device, scene, given);
  compare(a.film, b.film);
  for (const char* counter : {"iterations", "negative_share"})
    if (a.counters.count(counter)) {
      CAPTURE(counter);
      CHECK(std::abs(a.counters.at(counter) - b.counters.at(counter)) < 1e-12);
    }
}

}  // namespace

DEVICE_TEST_CASE("paper on the device: thin to thick, albedo to .99", "[gpu][compensated_ray_marching][paper]") {
  for (const double sigma_t : {1e-6, 1e-3, 0.3, 4.0, 50.0, 7e3})
    for (const double albedo : {0.0, 0.5, 0.99}) {
      CAPTURE(sigma_t, albedo);
      compare(scene_13_wide(puffs(), sigma_t, albedo, uneven()));
    }
}

DEVICE_TEST_CASE("paper on the device: stages kept and left out as on the CPU",
                 "[gpu][compensated_ray_marching][paper]") {
  for (const double sigma_t : {1e-6, 1.6e-4, 1.8e-4, 3.0}) {
    const auto scene = scene_13_wide(puffs(), sigma_t, 0.8, uneven());
    const auto again = [&](const scene::Renderer& renderer) {
      const auto prepared = renderer.prepare(scene, {renderer.settings(), paper()}, {1, {}});
      for (const scene::Stage& s : prepared->stages())
        if (s.name == "multiple scattering") return std::pair(s.kept, s.kept ? std::string() : s.reason);
      return std::pair(false, std::string("no such stage"));
    };
    CAPTURE(sigma_t);
    CHECK(again(device).first == (sigma_t > 1.7e-4));
    CHECK(again(device) == again(cpu));
  }
}

DEVICE_TEST_CASE("paper on the device: every setting", "[gpu][compensated_ray_marching][paper][thorough]") {
  const auto grey = scene_13_wide(cloud(70), 6, 0.8, scene::make_constant_environment(Rgb::Ones()));
  auto coloured = scene_13_wide(cloud(70), 6, 0.8, uneven());
  coloured->media[0].sigma_t = Rgb(2, 6, 6);
  coloured->media[0].albedo = Rgb(0.9, 0.6, 0.6);
  coloured->media[0].phase = scene::HenyeyGreenstein{0.6};
  coloured->ambient_in_scatter = Rgb(0.1, 0.2, 0.3);
  finish(*coloured);
  // All pairs of order and transmittance up to order 3; above it, where systems are large, half of them.
  const char* const transmittances[] = {"ol", "hyb", "series", "directional"};
  for (int order = 1; order <= 6; ++order)
    for (int t = 0; t < 4; ++t) {
      if (order > 3 && (order + t) % 2) continue;
      CAPTURE(order, transmittances[t]);
      compare(coloured,
              paper({{"order", std::to_string(order)}, {"transmittance", transmittances[t]}, {"iterations", "12"}}));
    }
  for (Given more : {Given{{"multiple", "none"}}, Given{{"multiple", "corrected"}}, Given{{"iterations", "1"}},
                     Given{{"solver", "cg_scaled"}}, Given{{"solver", "lsqr"}}, Given{{"solver", "lsqr_scaled"}},
                     Given{{"slice_weight", "exact"}, {"slices", "77"}}, Given{{"slice_weight", "printed"}},
                     Given{{"tolerance", "0.5"}}}) {
    more.insert({"iterations", "12"});
    CAPTURE(more);
    compare(coloured, paper(more));
    compare(grey, paper(more));
  }
}

DEVICE_TEST_CASE("paper on the device: phase functions at their ends, light below 0 and none",
                 "[gpu][compensated_ray_marching][paper]") {
  auto scene = scene_13_wide(puffs(), 4, 0.9, uneven());
  for (const double g : {-0.99, 0.99}) {
    scene->media[0].phase = scene::HenyeyGreenstein{g};
    finish(*scene);
    CAPTURE(g);
    compare(scene);
  }
  scene->media[0].phase = scene::Murky{};
  finish(*scene);
  compare(scene);
  const double one = std::sqrt(4 * pi), slope = std::sqrt(4 * pi / 3);
  compare(scene_13_wide(puffs(), 4, 0.9,
                        scene::make_sh_environment(
                            {Rgb::Constant(0.4 * one), Rgb::Constant(slope), Rgb::Constant(-slope), Rgb(0.3, -1, 1)},
                            Mat3::Identity(), Rgb::Ones())));
  const auto dark = scene_13_wide(puffs(), 4, 0.9, scene::make_constant_environment(Rgb::Zero()));
  compare(dark);
  const scene::Film film = picture(device, dark, paper());
  for (const float v : film.layer("airlight")) REQUIRE(v == 0);
}

DEVICE_TEST_CASE("paper on the device: no Gaussian, one, two at one place, some without weight",
                 "[gpu][compensated_ray_marching][paper]") {
  scene::GaussianSum none, one, twins, idle = puffs(), uncut = puffs();
  none.cutoff = one.cutoff = twins.cutoff = 3;
  one.gaussians = {{{0, 0, 0}, 0.5, 1}};
  twins.gaussians = {{{0, 0, 0}, 0.5, 0.5}, {{0, 0, 0}, 0.5, 0.5}};
  idle.gaussians.push_back({{0, 0, 0}, 0.5, 0});
  idle.gaussians.push_back({{30, 0, 0}, 0.1, 0});  // where there is nothing at all
  uncut.cutoff = infinity;
  for (const scene::GaussianSum& sum : {none, one, twins, idle, uncut})
    for (const char* multiple : {"as_printed", "corrected"}) {
      CAPTURE(sum.gaussians.size(), multiple);
      compare(scene_13_wide(sum, 3, 0.8, uneven()), paper({{"multiple", multiple}, {"iterations", "12"}}));
    }
  compare(scene_13_wide(puffs(), 0, 0.8, uneven()));
}

DEVICE_TEST_CASE("paper on the device: the eye within, from above, far away",
                 "[gpu][compensated_ray_marching][paper]") {
  auto scene = scene_13_wide(puffs(), 3, 0.8, uneven());
  for (const scene::Camera& camera : gpu::test::cameras_about_puffs()) {
    scene->camera = camera;
    finish(*scene);
    compare(scene);
  }
}

DEVICE_TEST_CASE("paper on the device: what Gaussians leave of voxels, turned",
                 "[gpu][compensated_ray_marching][paper][thorough]") {
  const auto grid = uneven_voxels({-1, -0.4, -0.8});
  grid->origin_index = {1, -2, 0};
  for (const bool clamped : {false, true}) {
    grid->clamp_border = clamped;
    const auto scene = scene_13_wide(fitted_with_residual(*grid), 3, 0.8, uneven());
    compare(scene, paper({{"residual", "false"}}));
    const Given of_grid{{"multiple", "none"}, {"cells", "12"}, {"levels", "6"}};
    compare(scene, of_grid);
    for (const scene::Region& region :
         {scene::Region(Box{{-1, -1, -0.2}, {0.3, 0.1, 1}}), scene::Region(scene::Sphere{{0.1, 0, 0}, 0.45}),
          scene::Region(scene::Slab{Vec3(1, 2, 0).normalized(), -0.2, 0.15})}) {
      CAPTURE(region_name(region));
      auto cut = std::make_shared<scene::Scene>(*scene);
      cut->media[0].region = region;
      finish(*cut);
      compare(cut, paper({{"multiple", "none"}}));
      compare(cut, of_grid);
      cut->media[0].field = puffs();
      finish(*cut);
      compare(cut, of_grid);
    }
    // All stores have the same levels; the processor's grid rounds them to floats.
    const scene::Film grid = picture(cpu, scene, paper()), bricks = picture(device, scene, paper());
    compare(grid, bricks);
    for (const char* store : {"grid", "bricks", "hash"}) {
      CAPTURE(clamped, store);
      const Given given = paper({{"residual_store", store}});
      compare(picture(cpu, scene, given), grid, 1e-6);
      const scene::Film film = picture(device, scene, given);
      for (const auto& [layer, values] : bricks.layers) CHECK(film.layer(layer) == values);
    }
  }
}

DEVICE_TEST_CASE("paper on the device: balls and ground, their shadows on smoke and the smoke's on them",
                 "[gpu][compensated_ray_marching][paper][thorough]") {
  auto scene = scene_13_wide(puffs(), 4, 0.9, uneven());
  scene->camera = scene::look_at({0.3, 1.7, 3.4}, {0, 0, 0}, Vec3::UnitY());
  scene->width = 26;
  scene->height = 18;
  scene->surfaces = {{"ground", scene::Plane{{0, -0.8, 0}, Vec3::UnitY()}, scene::Lambert{Rgb(0.7, 0.6, 0.5)}},
                     {"ball", scene::Sphere{{0.6, 0.6, 0.5}, 0.25}, scene::Lambert{Rgb(0.2, 0.3, 0.4)}},
                     {"speck", scene::Sphere{{-3, 2, 0}, 0.01}, scene::Lambert{}},  // less than half a degree
                     {"around a centre", scene::Sphere{{-0.3, 0.4, 0.2}, 0.1}, scene::Lambert{}}};
  finish(*scene);
  for (const Given& more : {Given{}, Given{{"transmittance", "ol"}, {"order", "3"}}, Given{{"order", "6"}},
                            Given{{"transmittance", "directional"}}})
    compare(scene, paper(more));
  // Meshes show shadows, and cast them as spheres.
  auto meshes = std::make_shared<scene::Scene>(*scene);
  meshes->surfaces[0].shape = scene::make_box({{-2, -1, -2}, {2, -0.8, 2}});
  meshes->surfaces[1].shape = scene::make_box({{0.3, 0.4, 0.3}, {0.9, 0.7, 0.6}});
  finish(*meshes);
  for (const char* transmittance : {"hyb", "directional"}) compare(meshes, paper({{"transmittance", transmittance}}));
  scene->media[0].sigma_t = Rgb(3, 4, 5);
  scene->backdrops.push_back(backdrop_with_depths(26, 18));
  finish(*scene);
  compare(scene);
  scene->media[0].sigma_t = Rgb::Zero();
  finish(*scene);
  compare(scene);
  compare(scene, paper({{"transmittance", "directional"}}));
}

DEVICE_TEST_CASE("paper on the device: the next frame's light as the CPU's next frame, for no more than its harmonics",
                 "[gpu][compensated_ray_marching][paper]") {
  const auto lit_by = [](scene::EnvironmentLight light) { return scene_13_wide(cloud(60), 6, 0.9, std::move(light)); };
  const auto white = lit_by(scene::make_constant_environment(Rgb::Ones()));
  // Systems are far from solved after 15 iterations, so that a picture tells what they began with.
  const Given given = paper({{"iterations", "15"}});
  const auto on_cpu = cpu.prepare(white, {cpu.settings(), given}, {1, {}});
  const auto on_device = device.prepare(white, {device.settings(), given}, {1, {}});
  on_device->render(view_of(*white), {1, {}});
  bool was_even = true;  // a constant environment
  for (const auto& [even, light] : {std::pair(true, scene::make_constant_environment(Rgb::Constant(2))),
                                    {false, uneven()},
                                    {false, uneven(0.5)},
                                    {true, scene::make_constant_environment(Rgb::Ones())},
                                    {false, uneven(0.3)},
                                    {false, uneven(0.4)}}) {
    const auto scene = lit_by(light);
    REQUIRE(on_cpu->next(scene, {1, {}}));
    const gpu::Use use(context);
    const gpu::Traffic before = context.traffic();
    const auto times = on_device->next(scene, {1, {}});
    const gpu::Traffic moved = context.traffic() - before;
    REQUIRE(times);
    if (even == was_even) {  // else programs of another environment are wanted for what is seen behind the smoke
      // The light in four bands, and what is seen of it: nothing of the smoke.
      CHECK(moved.bytes_up == 8 * 3 * 16 + (even ? 0 : 4 * 3 * 4));
      CHECK(moved.program_look_ups == 0);
    }
    was_even = even;
    for (const scene::StageTime& time : *times) {
      CAPTURE(time.name);
      CHECK((time.name == "environment" || time.name == "upload" || time.name == "single scattering" ||
             time.name == "multiple scattering"));
    }
    const scene::Rendering a = on_cpu->render(view_of(*scene), {1, {}}),
                           b = on_device->render(view_of(*scene), {1, {}});
    compare(a.film, b.film);
    CHECK(a.counters.at("iterations") == b.counters.at("iterations"));
    CHECK(std::abs(a.counters.at("multiple_error") - b.counters.at("multiple_error")) <
          1e-6 * a.counters.at("multiple_error"));
  }
  // Other smoke, light with colour and without.
  for (const auto& light : {uneven(), scene::make_constant_environment(Rgb::Ones())})
    for (const double step : {0.01, 0.02}) {
      const auto scene = scene_13_wide(risen(cloud(60), step), 5, 0.9, light);
      REQUIRE(on_cpu->next(scene, {1, {}}));
      REQUIRE(on_device->next(scene, {1, {}}));
      const scene::Film a = on_cpu->render(view_of(*scene), {1, {}}).film;
      compare(a, on_device->render(view_of(*scene), {1, {}}).film);
      CHECK(relative_l2(a, picture(cpu, scene, given), "airlight") > 1e-3);  // of nothing they would begin elsewhere
    }
}

DEVICE_TEST_CASE("paper on the device: a map that turns is projected once, by the device",
                 "[gpu][compensated_ray_marching][paper]") {
  const auto map = rough_map(64, 32), other = rough_map(32, 16, 3);
  const auto lit_by = [](double turn, const auto& of) { return scene_13_wide(cloud(60), 6, 0.9, rough_sky(turn, of)); };
  const Given given = paper({{"iterations", "12"}});
  const auto first = lit_by(0, map);
  const auto on_cpu = cpu.prepare(first, {cpu.settings(), given}, {1, {}});
  const auto on_device = device.prepare(first, {device.settings(), given}, {1, {}});
  on_device->render(view_of(*first), {1, {}});
  auto before = map;
  for (const auto& [turn, of] : {std::pair(0.4, map), {2.0, map}, {2.0, other}, {2.5, other}, {1.0, map}}) {
    const auto scene = lit_by(turn, of);
    REQUIRE(on_cpu->next(scene, {1, {}}));
    const gpu::Use use(context);
    const gpu::Traffic traffic = context.traffic();
    REQUIRE(on_device->next(scene, {1, {}}));
    const gpu::Traffic moved = context.traffic() - traffic;
    if (of == before) CHECK(moved.bytes_up == 8 * 3 * 16);  // the light in four bands
    // Beside it the map for what is seen behind the smoke, and the tables of its projection where it was not known.
    const long texels = 4 * 3 * of->width * of->height, tables = 8 * (4 * of->width + 10 * of->height);
    if (of != before) CHECK(moved.bytes_up == 8 * 3 * 16 + texels + (of == other ? tables : 0));
    before = of;
    compare(on_cpu->render(view_of(*scene), {1, {}}).film, on_device->render(view_of(*scene), {1, {}}).film);
  }
}

TEST_CASE("paper on the device: refusals name the reason", "[gpu][compensated_ray_marching][paper]") {
  auto scene = scene_13_wide(puffs(), 3, 0.8, uneven());
  const auto reason = [&](const Given& given) {
    const auto reasons = device.supports(*scene, {device.settings(), paper(given)});
    return reasons.empty() ? std::string() : reasons.front();
  };
  CHECK(reason({}).empty());
  scene->media[0].sigma_t = Rgb::Constant(1e10);
  CHECK_THAT(reason({}), Contains("single precision"));
}

DEVICE_TEST_CASE("paper on the device: solved to the end, and stopped where rounding steers",
                 "[gpu][compensated_ray_marching][paper]") {
  const auto lit = [](double factor) {
    auto scene = scene_13_wide(cloud(70), 6, 0.8, uneven());
    for (Rgb& band : std::get<scene::EnvironmentLight>(scene->lights[0]).sh) band *= factor;
    finish(*scene);
    return scene;
  };
  const auto scene = lit(1);
  for (const char* solver : {"cg", "cg_scaled", "lsqr", "lsqr_scaled"}) {
    const Given given = paper({{"tolerance", "1e-8"}, {"iterations", "100000"}, {"solver", solver}});
    const scene::Rendering solved = render(device, scene, given);
    compare(picture(cpu, scene, given), solved.film);
    CHECK(solved.counters.at("iterations") > 150);
    CHECK(solved.counters.at("multiple_error") <= 1e-8);
  }
  // Directions of conjugate gradients that are no longer orthogonal: the processor's own picture, the light's last bit another, moves as
  // far as the device's differs from it. From the greatest of six to ten times that is what chance leaves.
  const Given given = paper({{"iterations", "40"}});
  const scene::Film alone = picture(cpu, scene, given);
  double steered = 0;
  for (int i = 1; i <= 6; ++i) steered = std::max(steered, relative_l2(picture(cpu, lit(1 + 4e-16 * i), given), alone));
  const double off = relative_l2(picture(device, scene, given), alone);
  CAPTURE(steered, off);
  CHECK(steered > 1e-6);
  CHECK(steered < 0.01);
  CHECK(off < 10 * steered);
}

}  // namespace paper_test
