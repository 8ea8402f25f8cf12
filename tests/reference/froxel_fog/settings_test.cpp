// Presets, what overrides them, and what is refused.
#include <catch2/catch.hpp>

#include "reference/froxel_fog/options.h"
#include "scene/base/error.h"
#include "tests/reference/froxel_fog/fog_scenes.h"

namespace settings_test {

using namespace airlight;
using namespace airlight::froxel_fog;

namespace {

scene::Settings effective(const Given& given) { return effective_settings({option_specs(), given}); }

std::vector<std::string> reasons(const scene::Scene& scene, const Given& given) {
  return FroxelFog().supports(scene, {FroxelFog().settings(), given});
}

std::shared_ptr<scene::Scene> box_scene() {
  return fog_scene(
      {make_medium(scene::Homogeneous{1}, Box{Point3(-1, -1, -1), Point3(1, 1, 1)}, Rgb(1, 2, 4), Rgb(0.9, 0.7, 0.5))},
      {scene::DirectionalLight{Vec3::UnitY(), Rgb(3, 2, 1)}}, parallel_camera(), 16, 12);
}

}  // namespace

TEST_CASE("froxel fog: presets are the engines' defaults, and given settings override them", "[froxel_fog]") {
  const std::map<std::string, Given> presets = {{"fitted",
                                                 {{"tile", "8"},
                                                  {"volume_size", "0"},
                                                  {"slices", "64"},
                                                  {"near", "0"},
                                                  {"far", "0"},
                                                  {"depth", "equal"},
                                                  {"frames", "1"},
                                                  {"jitter", "none"},
                                                  {"filter", "none"},
                                                  {"blend", "mean"},
                                                  {"self_shadow", "map"}}},
                                                {"hdrp",
                                                 {{"tile", "8"},
                                                  {"volume_size", "0"},
                                                  {"slices", "64"},
                                                  {"near", "0.1"},
                                                  {"far", "64"},
                                                  {"depth", "log"},
                                                  {"log_c", "0.5"},
                                                  {"jitter", "hdrp"},
                                                  {"filter", "gauss3"},
                                                  {"blend", "ema"},
                                                  {"frames", "1"},
                                                  {"history_weight", "0.8571428571428571"},  // 6/7
                                                  {"self_shadow", "none"}}},
                                                {"godot",
                                                 {{"volume_size", "64"},
                                                  {"slices", "64"},
                                                  {"near", "0"},
                                                  {"far", "64"},
                                                  {"depth", "power"},
                                                  {"exponent", "2"},
                                                  {"frames", "16"},
                                                  {"jitter", "halton"},
                                                  {"filter", "gauss7"},
                                                  {"blend", "ema"},
                                                  {"history_weight", "0.9"},
                                                  {"self_shadow", "none"}}}};
  for (const auto& [preset, expected] : presets) {
    const scene::Settings settings = effective({{"preset", preset}});
    for (const auto& [name, value] : expected) {
      CAPTURE(preset, name);
      CHECK(settings.text(name) == value);
    }
  }
  CHECK(effective({}).canonical() == effective({{"preset", "fitted"}}).canonical());
  const Options o = read_options(
      effective({{"preset", "godot"}, {"exponent", "3"}, {"frames", "4"}, {"self_shadow", "map"}, {"map_size", "32"}}));
  CHECK((o.preset == Preset::godot && o.exponent == 3 && o.frames == 4 && o.far == 64 && o.filter == Filter::gauss7));
  CHECK((o.media.self_shadow && o.media.map.size == 32));
  const Options still = read_options(effective({{"preset", "godot"}, {"jitter", "none"}}));
  CHECK(still.frames == 1);  // frames without jitter are one
  CHECK_THAT(fog(box_scene(), {{"preset", "hdrp"}, {"slices", "8"}}).metadata.at("settings"),
             Catch::Contains("preset=hdrp") && Catch::Contains("slices=8") && Catch::Contains("far=64"));
}

TEST_CASE("froxel fog: settings that nothing reads are refused beside the defaults of their preset", "[froxel_fog]") {
  const auto scene = box_scene();
  const auto refused = [&](const Given& given, const std::string& part) {
    CAPTURE(part);
    try {
      const auto found = reasons(*scene, given);
      REQUIRE(found.size() == 1);
      CHECK_THAT(found[0], Catch::Contains(part));
    } catch (const Error& error) {
      CHECK_THAT(error.what(), Catch::Contains(part));
    }
  };
  refused({{"exponent", "3"}}, "exponent = 3 is not read with depth = equal");
  refused({{"preset", "hdrp"}, {"exponent", "3"}}, "exponent = 3 is not read with depth = log");
  refused({{"preset", "godot"}, {"tile", "4"}}, "tile = 4 is not read with volume_size = 64");
  refused({{"preset", "godot"}, {"jitter", "none"}, {"frames", "4"}}, "frames = 4 is not read with jitter = none");
  refused({{"preset", "godot"}, {"map_size", "64"}}, "map_size = 64 is not read with self_shadow = none");
  refused({{"preset", "hdrp"}, {"history_weight", "0.5"}}, "history_weight = 0.5 is not read with frames = 1");
  refused({{"frames", "4"}}, "frames = 4 is not read with jitter = none");
  refused({{"jitter", "halton"}, {"frames", "4"}, {"history_weight", "0.5"}}, "is not read with blend = mean");
  refused({{"blend", "ema"}}, "blend = ema is not read with");
  refused({{"preset", "godot"}, {"reproject", "true"}, {"frames", "4"}},
          "frames = 4 is not read with reproject = true");
  CHECK(reasons(*scene, {{"preset", "godot"}, {"volume_size", "0"}, {"tile", "4"}}).empty());
  CHECK(reasons(*scene, {{"preset", "hdrp"}, {"frames", "2"}, {"history_weight", "0.5"}}).empty());
  CHECK(reasons(*scene, {{"reproject", "true"}, {"history_weight", "0.5"}}).empty());
  CHECK_THROWS_WITH(reasons(*scene, {{"slice", "3"}}), Catch::Contains("unknown setting 'slice'"));
}

TEST_CASE("froxel fog: ranges, work and media that cannot be done are refused in one line", "[froxel_fog]") {
  const auto scene = box_scene();
  const auto refused = [&](const scene::Scene& s, const Given& given, const std::string& part) {
    CAPTURE(part);
    const auto found = reasons(s, given);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Catch::Contains(part));
    CHECK(found[0].find('\n') == std::string::npos);
    CHECK_THROWS_AS(FroxelFog().prepare(std::make_shared<scene::Scene>(s), {FroxelFog().settings(), given}, {}),
                    scene::NotSupported);
  };
  refused(*scene, {{"near", "5"}, {"far", "5"}}, "near = 5 is not before far = 5");
  refused(*scene, {{"depth", "exponential"}}, "near = 0 with depth = exponential");
  CHECK(reasons(*scene, {{"depth", "exponential"}, {"near", "0.1"}}).empty());
  refused(*scene, {{"map_encoding", "fourier"}, {"map_coefficients", "8"}}, "map_coefficients = 8 is even");
  scene::Scene large = *scene;
  large.width = large.height = 16384;
  refused(large, {{"tile", "1"}, {"slices", "4096"}}, "expected at most 1e+12");
  scene::Scene thick = *scene;
  thick.media[0].sigma_t.setConstant(1e15);
  refused(thick, {}, "a medium is so thick");
}

}  // namespace settings_test
