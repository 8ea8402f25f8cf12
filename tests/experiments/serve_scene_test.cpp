// Scenes in `airlight serve`: changed values mean what they mean in --override.
#include <catch2/catch.hpp>

#include "experiments/serve/answers.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/serving.h"
#include "tests/temporary_folder.h"

namespace serve_scene_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::experiments;
using namespace airlight::experiments::serve;
using Catch::Contains;

TEST_CASE("Serve: changed scenes are those of --override", "[experiments][serve]") {
  const std::string common = scenes + "common/";
  struct Case {
    std::string file, path, value;
  };
  for (const auto& [file, path, value] : {Case{"lamp_in_patches.toml", "camera.position", "[0, 5, 4]"},
                                          {"lamp_in_patches.toml", "light.0.position", "[0.5, 1.1, 0.3]"},
                                          {"lamp_in_patches.toml", "medium.0.sigma_t", "[0.5, 1, 2]"},
                                          {"lamp_in_patches.toml", "medium.0.phase", "{ type = \"hg\", g = 0.5 }"},
                                          {"cloud.toml", "light.0.to_light", "[1, 1, 1]"},
                                          {"cloud.toml", "light.0.irradiance", "[1, 2, 3]"},
                                          {"cloud.toml", "medium.0.albedo", "[0.9, 0.5, 0.1]"},
                                          {"hills.toml", "camera.vertical_fov", "0.5"},
                                          {"hills.toml", "medium.0.sigma_t", "0.2"}}) {
    INFO(file << " " << path);
    const SceneSource source(common + file);
    const auto changed = source.with({{path, value}});
    const scene::Scene read = scene::load_scene(common + file, {{path, value}});
    CHECK(changed->hash == read.hash);
    CHECK(changed->light_hash == read.light_hash);
    CHECK(changed->matter_hash == read.matter_hash);
    CHECK(changed->hash != source.with({})->hash);
    CHECK(changed->geometry == source.with({})->geometry);
  }
}

TEST_CASE("Serve: an environment is turned and scaled as by --override", "[experiments][serve]") {
  TemporaryFolder folder;
  folder.write("sky.toml", R"([camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
[[light]]
type = "environment"
sh = [[1, 1, 1], [0.1, 0.2, 0.3], [0.2, 0.1, 0], [0, 0.1, 0.2]]
rotation = { axis = [0, 1, 0], angle = 0.25 }
[[medium]]
type = "homogeneous"
region = { type = "sphere", center = [0, 0, 0], radius = 1 }
)");
  const std::string file = folder.file("sky.toml");
  const SceneSource source(file);
  for (const scene::Overrides& values : {scene::Overrides{{"light.0.rotation", "{ axis = [0, 1, 0], angle = 1.5 }"}},
                                         scene::Overrides{{"light.0.scale", "[2, 1, 1]"}}})
    CHECK(source.with(values)->hash == scene::load_scene(file, values).hash);
  const json described = parse_json(scene_answer(source, *source.with({})), "answer");
  CHECK(described["lights"][0]["turn"].get<double>() == Approx(0.25));
}

TEST_CASE("Serve: frames of a sequence are read as by --override", "[experiments][serve]") {
  TemporaryFolder folder;
  for (const char* name : {"smoke_0001.vdb", "smoke_0012.vdb"})
    std::filesystem::copy_file(root + "/experiments/data/plume_0024.vdb", folder.file(name));
  folder.write("smoke_none.vdb", "");
  folder.write("sequence.toml", R"([camera]
position = [0, 1, 5]
look_at = [0, 1, 0]
[[light]]
type = "directional"
to_light = [2, 2, 1]
irradiance = 12
[[medium]]
type = "grid"
file = "smoke_####.vdb"
frame = 1
sigma_t = 10
)");
  const std::string file = folder.file("sequence.toml");
  const SceneSource source(file);
  CHECK(source.frames(0) == std::pair(1LL, 12LL));
  CHECK(source.frame(0) == 1);
  const scene::Overrides values{{"medium.0.frame", "12"}, {"medium.0.sigma_t", "5"}, {"light.0.irradiance", "3"}};
  CHECK(source.with(values)->hash == scene::load_scene(file, values).hash);
  CHECK_THAT(message_of([&] { source.with({{"medium.0.frame", "7"}}); }), Contains("smoke_0007.vdb"));
  CHECK(!SceneSource(scenes + "common/cloud.toml").frames(0));
}

TEST_CASE("Serve: values that a scene may not have are refused in one line", "[experiments][serve]") {
  const SceneSource source(scenes + "common/lamp_in_patches.toml");
  for (const scene::Overrides& values : {scene::Overrides{{"medium.0.file", "\"/etc/passwd\""}},
                                         {{"light.0.file", "1"}},
                                         {{"light.9.position", "[0, 0, 0]"}},
                                         {{"medium.0.albedo", "2"}},
                                         {{"camera.vertical_fov", "-1"}},
                                         {{"camera.look_at", "[0, 4.5, 4]"}},
                                         {{"surface.0.type", "1"}},
                                         {{"light.*.position", "[0, 0, 0]"}},
                                         {{"camera.position", "[0, 0]"}}})
    CHECK(!message_of([&] { source.with(values); }).empty());
}

TEST_CASE("Serve: the text of a scene reads as the scene that is seen", "[experiments][serve]") {
  TemporaryFolder folder;
  const std::string file = scenes + "common/cloud.toml";
  const SceneSource source(file);
  const scene::Overrides values{{"camera.position", "[1, 1, 5.5]"}, {"medium.0.sigma_t", "[10, 11.5, 12]"}};
  folder.write("copy.toml", source.text(values));
  CHECK(scene::load_scene(folder.file("copy.toml")).hash == source.with(values)->hash);
}

}  // namespace serve_scene_test
