// Pictures of froxel fog against closed forms, and what must hold whatever the scene.
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/scene.h"
#include "tests/reference/froxel_fog/fog_scenes.h"

namespace picture_test {

using namespace airlight;
using namespace airlight::froxel_fog;

namespace {

const Rgb sigma_t(0.5, 1, 4), albedo(0.9, 0.7, 0.5), irradiance(3, 2, 1);

scene::DirectionalLight sun() { return {Vec3(1, 2, 2).normalized(), irradiance}; }

// Henyey-Greenstein with the light from `to_light` scattered against the ray's direction.
double phase(double g, const Vec3& to_light, const Vec3& direction) {
  const double c = to_light.dot(direction);
  return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * c, 1.5));
}

scene::Medium box_of_fog() {
  return make_medium(scene::Homogeneous{1}, Box{Point3(-9, -9, -1), Point3(9, 9, 1)}, sigma_t, albedo,
                     scene::HenyeyGreenstein{0.4});
}

std::shared_ptr<scene::Scene> box_scene(bool with_wall = false) {
  auto scene = fog_scene({box_of_fog()}, {sun()}, parallel_camera(), 12, 8);
  if (with_wall) {
    scene->surfaces = {{"wall", scene::Plane{Point3(0, 0, 0), Vec3::UnitZ()}, scene::Lambert{Rgb(0.8, 0.5, 0.3)}}};
    finish(*scene);
  }
  return scene;
}

std::vector<Given> variants() {
  return {{},
          {{"depth", "log"}},
          {{"depth", "power"}, {"exponent", "3"}},
          {{"depth", "exponential"}, {"near", "0.01"}},
          {{"tile", "3"}, {"slices", "17"}, {"jitter", "halton"}, {"frames", "3"}, {"filter", "gauss3"}},
          {{"preset", "hdrp"}, {"frames", "3"}},
          {{"preset", "godot"}, {"frames", "3"}, {"volume_size", "4"}}};
}

// A copy of a scene with a smaller film and a camera that has the media in view.
std::shared_ptr<scene::Scene> resized(const scene::Scene& scene, int width, int height) {
  auto small = std::make_shared<scene::Scene>(scene);
  if (small->camera.kind == scene::Camera::Kind::perspective) small->camera = wide_camera();
  small->width = width;
  small->height = height;
  finish(*small);
  return small;
}

const scene::Stage* find(const std::vector<scene::Stage>& stages, const std::string& name) {
  for (const scene::Stage& stage : stages)
    if (stage.name == name) return &stage;
  return nullptr;
}

std::vector<scene::Stage> stages_of(const std::shared_ptr<const scene::Scene>& scene, const Given& given) {
  const FroxelFog fog;
  return fog.prepare(scene, {fog.settings(), given}, {})->stages();
}

}  // namespace

// Slices that are fitted begin and end with the box, and those between see a constant: exact to the rounding of floats.
TEST_CASE("froxel fog: a box under a sun without self shadow has its closed form", "[froxel_fog]") {
  const auto scene = box_scene();
  const Rgb through = (-2 * sigma_t).exp();
  const Rgb light = albedo * irradiance * phase(0.4, sun().to_light, -Vec3::UnitZ()) * (1 - through);
  for (const char* slices : {"1", "2", "64"})
    for (const char* tile : {"1", "5"}) {
      const scene::Film film = fog(scene, {{"self_shadow", "none"}, {"slices", slices}, {"tile", tile}});
      CHECK(distance_from(film, "airlight", light) < 1e-6);
      CHECK(distance_from(film, "transmittance", through) < 1e-6);
      CHECK(distance_from(film, "mean", light) < 1e-6);
    }
}

// Slices from 2 to 4 m have an end at the wall, 3 m away.
TEST_CASE("froxel fog: where slices end at a wall, the transmittance to it is exact", "[froxel_fog]") {
  const auto scene = box_scene(true);
  const Rgb through = (-sigma_t).exp();
  const double cosine = sun().to_light[2];
  const Rgb lit = Rgb(0.8, 0.5, 0.3) / pi * irradiance * cosine;
  const scene::Film film = fog(scene, {{"self_shadow", "none"}, {"near", "2"}, {"far", "4"}, {"slices", "8"}});
  CHECK(distance_from(film, "transmittance", through) < 1e-6);
  CHECK(distance_from(film, "surface", through * lit) < 1e-6);
  CHECK(distance_from(film, "airlight",
                      albedo * irradiance * phase(0.4, sun().to_light, -Vec3::UnitZ()) * (1 - through)) < 1e-6);
  // Through 1 m of fog along z, the sun's rays come through 1 / cosine.
  const scene::Film shadowed = fog(scene, {{"near", "2"}, {"far", "4"}, {"slices", "8"}});
  CHECK(distance_from(shadowed, "surface", through * lit * (-sigma_t / cosine).exp()) < 1e-6);
  CHECK(distance_from(shadowed, "transmittance", through) < 1e-6);
  // A froxel whose middle is not before the wall is empty: an end within a slice can miss half its depth, of 4 / 41 in blue.
  const scene::Film between = fog(scene, {{"self_shadow", "none"}, {"near", "2"}, {"far", "4"}, {"slices", "41"}});
  CHECK(distance_from(between, "transmittance", through) == Approx(std::expm1(4 / 41.0)).epsilon(1e-5));
}

// The slices end 16 deep at the ray with the greatest view depth, deeper on all others: exp(-16) = 1.1e-7 is not seen.
TEST_CASE("froxel fog: endless fog under a sun without self shadow has its closed form", "[froxel_fog]") {
  const Rgb grey = Rgb::Constant(0.7);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const auto scene = fog_scene({make_medium(scene::Homogeneous{scale}, scene::Unbounded{}, grey, albedo)}, {sun()},
                                 wide_camera(), 12, 8);
    const scene::Film film = fog(scene, {{"self_shadow", "none"}, {"tile", "1"}});
    CHECK(distance_from(film, "airlight", albedo * irradiance / (4 * pi)) < 1.2e-6);
    CHECK(*std::max_element(film.layer("transmittance").begin(), film.layer("transmittance").end()) < 1.2e-7);
    // With self shadow nothing comes in from infinitely far away.
    const scene::Film dark = fog(scene, {});
    CHECK(*std::max_element(dark.layer("airlight").begin(), dark.layer("airlight").end()) == 0);
  }
}

TEST_CASE("froxel fog: what the range leaves out is not seen, and the stages say so", "[froxel_fog]") {
  const auto scene = box_scene();
  const Rgb phased = albedo * irradiance * phase(0.4, sun().to_light, -Vec3::UnitZ());
  const Given half = {{"self_shadow", "none"}, {"near", "2"}, {"far", "3"}};
  CHECK(distance_from(fog(scene, half), "airlight", phased * (1 - (-sigma_t).exp())) < 1e-6);
  const scene::Stage* cut = find(stages_of(scene, half), "media_outside_range");
  REQUIRE(cut != nullptr);
  const auto stages = stages_of(scene, half);
  CHECK(find(stages, "media_outside_range")->reason ==
        "media from 2 to 4 m are cut to 2 to 3 m; what lies outside is not seen");
  CHECK(find(stages_of(scene, {}), "media_outside_range") == nullptr);
  CHECK(find(stages_of(scene, {{"far", "4"}}), "media_outside_range") == nullptr);
  CHECK(find(stages_of(scene, {{"near", "5"}}), "media_outside_range") != nullptr);
  const scene::Film none = fog(scene, {{"near", "5"}});
  CHECK(distance_from(none, "transmittance", Rgb::Ones()) == 0);
  CHECK(none.layer("airlight") == std::vector<float>(none.layer("airlight").size(), 0));
  const auto fitted = stages_of(scene, {});
  CHECK(find(fitted, "inject")->reason == "2 x 1 x 64 froxels of 8 x 8 pixels from 2 to 4 m; 64 slices cover media");
  CHECK_FALSE(find(fitted, "light_maps")->kept);
  CHECK_THAT(find(stages, "light_maps")->reason, Catch::StartsWith("self_shadow = none"));
  CHECK(find(stages_of(scene, {{"preset", "hdrp"}}), "preset")->kept);
}

TEST_CASE("froxel fog: stages that are left out take no time", "[froxel_fog]") {
  auto away = std::make_shared<scene::Scene>(*box_scene());
  away->camera.forward = Vec3::UnitZ();
  finish(*away);
  auto scenes = ray_marcher::assorted_scenes();
  scenes.emplace_back("a camera that looks away", away);
  for (const auto& [name, scene] : scenes)
    for (const Given& given : variants()) {
      const auto small = resized(*scene, 9, 7);
      const FroxelFog fog;
      const auto prepared = fog.prepare(small, {fog.settings(), given}, {});
      const auto stages = prepared->stages();
      const auto rendering = prepared->render(view_of(*small), {});
      CAPTURE(name, given);
      for (const scene::StageTime& time : rendering.times) {
        CAPTURE(time.name);
        const scene::Stage* stage = find(stages, time.name);
        REQUIRE(stage != nullptr);
        CHECK(stage->kept);
      }
      CHECK((rendering.counters.at("froxels") > 0) == find(stages, "inject")->kept);
      if (given.count("preset") == 1) CHECK(rendering.counters.at("look_ups") == 0);
    }
}

// A scene of any size is the same picture, but for rounding: by a power of two all but the kernels' places.
TEST_CASE("froxel fog: pictures do not depend on the scene's size", "[froxel_fog]") {
  for (const auto& [name, one] : ray_marcher::assorted_scenes()) {
    const auto& scene = one;
    if (scene->geometry) continue;  // surfaces are not scaled
    const auto drawn = [&](double scale) {
      auto scaled = std::make_shared<scene::Scene>(*ray_marcher::scaled_scene(*scene, scale));
      scaled->camera = wide_camera();
      scaled->camera.position *= scale;
      scaled->width = 10;
      scaled->height = 8;
      finish(*scaled);
      return fog(scaled, {{"tile", "2"}, {"slices", "16"}, {"map_size", "32"}, {"environment_directions", "4"}});
    };
    const scene::Film whole = drawn(1);
    for (const double scale : {0x1p-10, 0x1p20}) {
      CAPTURE(name, scale);
      CHECK(test::relative_l2(drawn(scale), whole) < 1e-5);
      CHECK(test::relative_l2(drawn(scale), whole, "transmittance") < 1e-5);
    }
  }
}

TEST_CASE("froxel fog: extreme media, lamps inside and a camera inside leave finite pictures", "[froxel_fog]") {
  for (const auto& [name, scene] : ray_marcher::assorted_scenes())
    for (const double extinction : {1e-6, 1e6})
      for (const double keep : {0.0, 1.0})
        for (Given given : variants()) {
          scene::Scene extreme = *scene;
          for (scene::Medium& medium : extreme.media) medium.sigma_t *= extinction, medium.albedo *= keep;
          extreme.camera = wide_camera();
          extreme.camera.position = Point3(0.05, 0.1, 0.2);  // inside most media
          extreme.lights.push_back(scene::PointLight{extreme.camera.position, Rgb(1, 2, 3), 0});
          extreme.width = 7, extreme.height = 5;
          finish(extreme);
          if (given.count("preset") == 0) given["map_size"] = "8", given["map_steps"] = "16";
          given["environment_directions"] = "2";
          CAPTURE(name, extinction, keep, given);
          REQUIRE(FroxelFog().supports(extreme, {FroxelFog().settings(), given}).empty());
          const scene::Film film = fog(std::make_shared<scene::Scene>(extreme), given);
          CHECK(test::all_finite(film));
          for (const auto& [layer, values] : film.layers) CHECK(*std::min_element(values.begin(), values.end()) >= 0);
          if (keep == 0) CHECK(*std::max_element(film.layer("airlight").begin(), film.layer("airlight").end()) == 0);
        }
}

TEST_CASE("froxel fog: the same bits for any number of threads, with history and filter", "[froxel_fog]") {
  for (const auto& [name, scene] : ray_marcher::assorted_scenes())
    for (Given given : variants()) {
      const auto small = resized(*scene, 40, 30);
      given["environment_directions"] = "2";
      CAPTURE(name, given);
      CHECK(fog(small, given, 1).layers == fog(small, given, 2).layers);
    }
}

}  // namespace picture_test
