// The scenes of Zhou et al. 2007 that scripts make: the committed files are what the scripts give, and the counts are
// those that the paper prints.
#include <catch2/catch.hpp>
#include <filesystem>

#include "experiments/authoring/write_scene.h"
#include "scene/scene.h"
#include "tests/temporary_folder.h"

namespace authored_scenes_test {

using namespace airlight;
using namespace airlight::experiments::authoring;

namespace {

const std::string folder = AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/";

std::size_t vertices(const scene::Scene& scene) {
  std::size_t count = 0;
  for (const auto& surface : scene.surfaces)
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape)) count += mesh->vertices.size();
  return count;
}

std::size_t gaussians(const scene::Scene& scene) {
  std::size_t count = 0;
  for (const auto& medium : scene.media)
    if (const auto* sum = std::get_if<scene::GaussianSum>(&medium.field)) count += sum->gaussians.size();
  return count;
}

std::size_t lights_of(const scene::Scene& scene, const std::string& kind) {
  return std::size_t(std::count_if(scene.lights.begin(), scene.lights.end(),
                                   [&](const scene::Light& light) { return scene::light_name(light) == kind; }));
}

}  // namespace

TEST_CASE("scripts give the committed scenes bit by bit", "[authoring][scenes]") {
  int scripts = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".jsonl") continue;
    ++scripts;
    const std::filesystem::path out = std::filesystem::path(entry.path()).replace_extension(".toml");
    CAPTURE(out);
    const SceneFiles files = scene_files(run_script(entry.path().string(), [] {}), entry.path().string(), out.string());
    CHECK(files.toml == read_bytes(out.string()));
    for (const auto& table : files.tables) CHECK(table.csv == read_bytes((out.parent_path() / table.name).string()));
  }
  CHECK(scripts >= 8);
}

TEST_CASE("Table 1 has the printed numbers of vertices, Gaussians and lights", "[authoring][scenes]") {
  struct Row {
    const char* name;
    std::size_t vertices, gaussians, lights;
    const char* kind;
  };
  for (const Row& row : {Row{"gargoyle", 78'054, 34, 3, "point"}, Row{"box", 8'901, 3'008, 1, "point"},
                         Row{"terrain", 65'047, 292, 1, "environment"}, Row{"city", 77'226, 353, 1, "environment"},
                         Row{"motorcycle", 44'430, 1'223, 1, "environment"}}) {
    CAPTURE(row.name);
    const auto scene = scene::load_scene(folder + "table1/" + row.name + ".toml");
    CHECK(vertices(scene) == row.vertices);
    CHECK(gaussians(scene) == row.gaussians);
    CHECK(scene.lights.size() == row.lights);
    CHECK(lights_of(scene, row.kind) == row.lights);
    CHECK(scene.width == 800);
    CHECK(scene.height == 600);
  }
}

TEST_CASE("airbrushed fog of the scenes is on the right side of their surfaces", "[authoring][scenes]") {
  const auto elephant = scene::load_scene(folder + "airbrushed/elephant.toml");
  const scene::Geometry mesh({elephant.surfaces[0]});
  REQUIRE(gaussians(elephant) == 800);
  for (const auto& g : std::get<scene::GaussianSum>(elephant.media[0].field).gaussians) {
    CHECK(g.center[1] > -0.5);                                                            // above the ground
    CHECK(mesh.all_hits({g.center, Vec3(0.3, 0.5, -0.8).normalized()}).size() % 2 == 0);  // not in the elephant
  }
  // Nothing in the box passes its walls: what leaves does so by the open front.
  const auto box = scene::load_scene(folder + "table1/box.toml");
  for (const auto& g : std::get<scene::GaussianSum>(box.media[0].field).gaussians) {
    if (g.center[2] > 1.3) continue;
    CHECK(Box{Point3(-1.3, 0, -1.3), Point3(1.3, 2.1, 1.3)}.contains(g.center));
  }
}

}  // namespace authored_scenes_test
