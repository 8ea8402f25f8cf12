// Frames of smoke and patches of fog over a floor, each of which differs from the first in one thing: for tests of Prepared::next of the
// renderers that march through lit media.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/media/voxel_grid.h"
#include "tests/pictures.h"

namespace lit_media_next_frames {

using namespace airlight;
using scene::Scene;
using SharedScene = std::shared_ptr<const Scene>;

inline std::shared_ptr<scene::VoxelGrid> smoke() {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = Eigen::Vector3i(6, 5, 4);
  grid->voxel_size = 0.25;
  grid->translation = Vec3(-0.6, 0.2, -0.4);
  for (int i = 0; i < 6 * 5 * 4; ++i) grid->values.push_back(float(i % 7 == 0 ? 0 : 0.5 + 0.5 * std::sin(1.7 * i)));
  return grid;
}

inline Scene yard() {
  Scene scene;
  scene.name = "yard";
  scene.width = 16;
  scene.height = 12;
  scene.camera.position = Point3(0, 0.8, 4);
  scene.lights = {scene::PointLight{Point3(0.9, 1.6, 0.4), Rgb(6, 5, 4), 0},
                  scene::DirectionalLight{Vec3(-1, 2, 1).normalized(), Rgb(2, 2, 3)}};
  scene::Medium voxels, patches;
  voxels.field = scene::GridPointer(smoke());
  voxels.sigma_t = Rgb::Constant(2);
  voxels.albedo = Rgb::Constant(0.9);
  scene::GaussianSum sum;
  for (int i = 0; i < 5; ++i) sum.gaussians.push_back({Point3(0.4 * i - 0.8, 0.3, std::sin(2.0 * i)), 0.4, 0.5});
  patches.field = sum;
  scene.media = {voxels, patches};
  scene.surfaces.push_back({"floor", scene::Plane{}, scene::Lambert{Rgb::Constant(0.5)}});
  scene.surfaces.push_back({"ball", scene::Sphere{Point3(0.3, 0.3, 0.8), 0.3}, scene::Lambert{Rgb(0.6, 0.5, 0.4)}});
  finish(scene);
  return scene;
}

inline scene::GaussianSum& patches_of(Scene& scene) { return std::get<scene::GaussianSum>(scene.media[1].field); }

// The smoke as another grid.
template <class Make>
void with_grid(Scene& scene, const Make& make) {
  auto grid = std::make_shared<scene::VoxelGrid>(*std::get<scene::GridPointer>(scene.media[0].field));
  make(*grid);
  scene.media[0].field = scene::GridPointer(grid);
}

struct Change {
  const char* name;
  std::function<void(Scene&)> make;
  int maps_made;  // of two lights
};

inline const Change changes[] = {
    {"camera", [](Scene& s) { s.camera.position[0] += 0.1; }, 0},
    {"a moved lamp",
     [](Scene& s) {
       s.lights[0] = scene::moved(s.lights[0], {0.1, 0, 0});
     },
     1},
    {"a dimmed lamp", [](Scene& s) { std::get<scene::PointLight>(s.lights[0]).intensity *= 0.5; }, 0},
    {"a turned sun",
     [](Scene& s) { std::get<scene::DirectionalLight>(s.lights[1]).to_light = Vec3(-1, 2, 0.8).normalized(); }, 1},
    {"one light less", [](Scene& s) { s.lights.pop_back(); }, 0},
    {"moved smoke", [](Scene& s) { with_grid(s, [](auto& grid) { grid.translation[0] += 0.05; }); }, 2},
    {"other smoke",
     [](Scene& s) {
       with_grid(s, [](auto& grid) {
         for (float& v : grid.values) v *= 1.1f;
       });
     },
     2},
    {"smaller smoke",
     [](Scene& s) {
       with_grid(s, [](auto& grid) {
         grid.size[2] = 3;
         grid.values.resize(90);
       });
     },
     2},
    {"moved patches",
     [](Scene& s) {
       for (auto& g : patches_of(s).gaussians) g.center[0] += 0.05;
     },
     2},
    {"a patch more",
     [](Scene& s) {
       patches_of(s).gaussians.push_back({Point3(0, 0.9, 0.2), 0.3, 0.4});
     },
     2},
    {"patches removed", [](Scene& s) { patches_of(s).gaussians.resize(3); }, 2},
    {"denser patches", [](Scene& s) { s.media[1].sigma_t *= 1.2; }, 2},
    {"a medium less", [](Scene& s) { s.media.pop_back(); }, 2},
    {"another floor", [](Scene& s) { s.surfaces[0].material = scene::Lambert{Rgb::Constant(0.7)}; }, 0},
};

// The scene one frame later, finished.
inline SharedScene changed(const Scene& from, const Change& change) {
  auto to = std::make_shared<Scene>(from);
  change.make(*to);
  finish(*to);
  return to;
}

struct Case {
  const char* renderer;
  test::Given given;
};
inline const Case cases[] = {
    {"froxel_fog", {{"tile", "4"}, {"slices", "12"}, {"map_size", "24"}}},
    {"froxel_fog", {{"preset", "hdrp"}, {"tile", "4"}}},
    {"half_resolution_march", {{"steps", "8"}, {"map_size", "24"}, {"map_encoding", "fourier"}}},
    {"half_resolution_march", {{"steps", "8"}, {"self_shadow", "none"}}},
    {"ray_marcher", {{"steps", "8"}, {"shadow", "map"}, {"map_size", "24"}, {"map_encoding", "avsm"}}},
    {"ray_marcher", {{"steps", "8"}, {"shadow_steps", "4"}}},
};

// Nothing where a picture takes no maps.
inline std::optional<double> maps_made(const scene::Rendering& rendering) {
  const auto found = rendering.counters.find("light_maps_made");
  return found == rendering.counters.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace lit_media_next_frames
