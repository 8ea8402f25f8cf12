// Conversion of the values of a scene file.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "scene/base/error.h"
#include "scene/media/voxel_grid.h"
#include "scene/scene.h"
#include "tests/scene/load/message.h"

namespace values_test {

using namespace airlight;
using namespace airlight::scene;
using test::camera;

namespace {

const std::string root = AIRLIGHT_SOURCE_DIR;

Scene load(const std::string& text) { return parse_scene(camera + text, "s.toml", root + "/experiments/scenes"); }

const std::string cube =
    "[[medium]]\ntype = 'grid'\nsize = [2, 3, 1]\nvoxel_size = 0.5\norigin = [1, 2, 3]\nvalues = [1, 2, 3, 4, 5, 6]\n";

const VoxelGrid& grid_of(const Scene& scene) {
  return *std::get<std::shared_ptr<const VoxelGrid>>(scene.media.at(0).field);
}

// Where the loader puts sample (i, j, k), from the definition in voxel_grid.h.
Point3 place(const VoxelGrid& grid, int i, int j, int k) {
  const Vec3 index = (grid.origin_index + Eigen::Vector3i(i, j, k)).cast<double>();
  return grid.rotation * (grid.voxel_size * index) + grid.translation;
}

}  // namespace

TEST_CASE("an inline grid lies where it says", "[load]") {
  const Scene scene = load(cube);
  const VoxelGrid& grid = grid_of(scene);
  CHECK(grid.size == Eigen::Vector3i(2, 3, 1));
  CHECK(grid.at(1, 2, 0) == 6);
  CHECK(grid.at(0, 1, 0) == 3);
  CHECK_FALSE(grid.clamp_border);
  CHECK(place(grid, 1, 2, 0) == Point3(1.5, 3, 3));
}

TEST_CASE("a transform is scale, then rotation, then translation", "[load]") {
  // A quarter turn about +y takes +x to -z and +z to +x.
  const Scene scene = load(cube +
                           "transform = { rotation = { axis = [0, 3, 0], angle = 1.5707963267948966 }, scale = 2, "
                           "translation = [10, 0, 0] }\n");
  const VoxelGrid& grid = grid_of(scene);
  CHECK(grid.voxel_size == 1);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 2; ++i) {
      const Point3 before = Point3(1, 2, 3) + 0.5 * Point3(i, j, 0);
      CHECK((place(grid, i, j, 0) - Point3(10 + 2 * before[2], 2 * before[1], -2 * before[0])).norm() < 1e-14);
    }
}

TEST_CASE("Euler angles turn about x, then y, then z", "[load]") {
  // A quarter about x takes +y to +z; then a quarter about z takes nothing of z: +y ends at +z, +x at +y.
  const std::string quarter = "1.5707963267948966";
  const Scene scene = load("[[light]]\ntype = 'environment'\nsh = [[1, 1, 1]]\nrotation = { euler = [" + quarter +
                           ", 0, " + quarter + "] }\n");
  // The rotation turns the map in the world: its inverse takes directions of the world to the map.
  const Mat3& to_map = std::get<EnvironmentLight>(scene.lights.at(0)).to_map;
  CHECK((to_map * Vec3::UnitZ() - Vec3::UnitY()).norm() < 1e-15);
  CHECK((to_map * Vec3::UnitY() - Vec3::UnitX()).norm() < 1e-15);
}

TEST_CASE("defaults are those of the documentation", "[load]") {
  const Scene scene = load("[[medium]]\ntype = 'homogeneous'\n[[surface]]\ntype = 'plane'\npoint = [0, -1, 0]\n");
  CHECK(scene.name == "s");
  CHECK(scene.width == 160);
  CHECK(scene.height == 120);
  CHECK(scene.camera.vertical_fov == 0.7);
  CHECK(scene.camera.kind == Camera::Kind::perspective);
  CHECK((scene.ambient_in_scatter == 0).all());
  const Medium& medium = scene.media[0];
  CHECK((medium.sigma_t == 1).all());
  CHECK((medium.albedo == 1).all());
  CHECK(std::holds_alternative<Isotropic>(medium.phase));
  CHECK(std::holds_alternative<Unbounded>(medium.region));
  CHECK(std::get<Homogeneous>(medium.field).density == 1);
  CHECK(std::get<Plane>(scene.surfaces[0].shape).normal == Vec3(0, 1, 0));
  CHECK((std::get<Lambert>(scene.surfaces[0].material).albedo == 0.5).all());
  CHECK(scene.geometry);
  CHECK_FALSE(load("").geometry);
}

TEST_CASE("a table of Gaussians in a file is the same as in the scene", "[load]") {
  const Scene file = load("[[medium]]\ntype = 'gaussians'\nfile = 'blobs.csv'\n");
  const Scene here = load(R"([[medium]]
type = 'gaussians'
gaussians = [
  { center = [-1, 0, 0], width = 0.5, amplitude = 1 },
  { width = 0.75, amplitude = 0.8, center = [0, 0.25, 0] },
  { center = [1.5, 0, 0.5], width = 4e-1, amplitude = 1.2 },
]
)");
  CHECK(std::get<GaussianSum>(file.media[0].field).gaussians.size() == 3);
  CHECK(file.hash == here.hash);
}

TEST_CASE("each value of a scene is in its hash", "[load]") {
  const std::string text = cube + R"(
sigma_t = 2
phase = { type = 'hg', g = 0.1 }
region = { type = 'slab', lo = 0, hi = 1 }
[[light]]
type = 'spot'
position = [0, 1, 0]
axis = [0, -1, 0]
outer_angle = 0.5
intensity = 1
[[surface]]
type = 'height_field'
size = [2, 2]
spacing = [1, 1]
heights = [0, 0, 0, 1]
material = { type = 'phong', diffuse = 0.3, specular = 0.3, exponent = 5 }
)";
  const auto hash = [&](const Overrides& overrides) {
    return parse_scene(camera + text, "s.toml", "", overrides).hash;
  };
  const std::string first = hash({});
  const std::vector<std::pair<std::string, std::string>> changes = {
      {"film.width", "161"},
      {"film.height", "121"},
      {"ambient_in_scatter", "0.5"},
      {"camera.position", "[0, 0, 6]"},
      {"camera.look_at", "[0, 0.1, 0]"},
      {"camera.up", "[0.1, 1, 0]"},
      {"camera.vertical_fov", "0.71"},
      {"light.0.position", "[0, 2, 0]"},
      {"light.0.axis", "[0, -1, 1]"},
      {"light.0.outer_angle", "0.6"},
      {"light.0.inner_angle", "0.4"},
      {"light.0.intensity", "2"},
      {"light.0.radius", "0.1"},
      {"medium.0.values.3", "9"},
      {"medium.0.voxel_size", "0.6"},
      {"medium.0.origin", "[1, 2, 4]"},
      {"medium.0.clamp_border", "true"},
      {"medium.0.size", "[3, 2, 1]"},
      {"medium.0.sigma_t", "[2, 2, 2.5]"},
      {"medium.0.albedo", "0.5"},
      {"medium.0.phase.g", "0.2"},
      {"medium.0.region.hi", "2"},
      {"medium.0.region.normal", "[1, 1, 0]"},
      {"medium.0.transform", "{ scale = 2 }"},
      {"surface.0.heights.0", "0.5"},
      {"surface.0.material.exponent", "6"},
      {"surface.0.material.diffuse", "0.31"},
      {"surface.0.material.specular", "0.31"},
  };
  std::vector<std::string> hashes = {first};
  for (const auto& change : changes) {
    const std::string changed = hash({change});
    INFO(change.first);
    CHECK(std::find(hashes.begin(), hashes.end(), changed) == hashes.end());
    hashes.push_back(changed);
  }
  CHECK(hash({{"name", "'other'"}}) == first);
  CHECK(hash({{"medium.0.name", "'other'"}, {"surface.0.name", "'x'"}, {"medium.0.sigma_t", "[2.0, 2, 2]"}}) == first);
}

// Any text is a scene or an error of one line; nothing else may happen. Mutations of a real scene reach deeper than
// random bytes. Fixed seed: 3000 texts, the same in every run.
TEST_CASE("damaged scene texts are scenes or errors", "[load]") {
  const std::string text = camera + cube + "phase = { type = 'hg', g = 0.1 }\n[[light]]\ntype = 'point'\n" +
                           "position = [0, 1, 0]\nintensity = [1, 2.5, 3e0]\n";
  const std::string spare = "[]{}=\"'.,#\n\\-+e0159 \t_inftruenan\xc3\xa9";
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = text;
    for (std::size_t edits = 1 + below(3); edits > 0; --edits) {
      const std::size_t at = below(damaged.size());
      switch (below(4)) {
        case 0:
          damaged[at] = spare[below(spare.size())];
          break;
        case 1:
          damaged.insert(at, 1, spare[below(spare.size())]);
          break;
        case 2:
          damaged.erase(at, 1 + below(8));
          break;
        default:
          damaged.insert(at, damaged.substr(below(damaged.size()), 1 + below(30)));
          break;
      }
    }
    try {
      parse_scene(damaged, "s.toml", root);
    } catch (const Error& e) {
      ++refused;
      const std::string what = e.what();
      if (what.find('\n') != std::string::npos || what.size() > 500 || what.rfind("s.toml:", 0) != 0) {
        CAPTURE(damaged, what);
        CHECK(false);
      }
    }
  }
  CHECK(refused > 1500);
}

}  // namespace values_test
