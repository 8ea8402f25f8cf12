// Frames of a garden in patchy fog, each of which differs from the first in one thing: for tests of Prepared::next.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/methods/fogshop/sky.h"

namespace fogshop_next_frames {

using namespace airlight;
using scene::Scene;
using Pairs = std::map<std::string, std::string>;
using Names = std::vector<std::string>;

inline scene::PointLight lamp(const Point3& position, double power) {
  return {position, Rgb(power, power, 0.8 * power), 0};
}

// Patches of fog over a floor and a tent, under a sky, with two lamps.
inline Scene garden() {
  Scene scene;
  scene.name = "garden";
  scene.width = 16;
  scene.height = 12;
  scene.camera.position = Point3(0, 1.5, 5);
  scene.lights = {lamp({0.6, 1.4, 0.3}, 6), lamp({-0.8, 1.1, -0.6}, 4), fogshop::test::sky_light()};
  scene::GaussianSum fog;
  for (int i = 0; i < 30; ++i)
    fog.gaussians.push_back({Point3(std::sin(2.0 * i), 0.6 + 0.4 * std::cos(3.0 * i), std::sin(5.0 * i)), 0.5, 0.12});
  scene::Medium medium;
  medium.field = fog;
  medium.albedo = Rgb::Constant(0.9);
  scene.media.push_back(medium);
  scene::TriangleMesh tent;
  tent.vertices = {Point3(-0.4, 0, 0), Point3(0.4, 0, 0), Point3(0, 0.7, 0), Point3(0, 0, 0.5)};
  tent.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  scene.surfaces.push_back({"floor", scene::Plane{}, scene::Lambert{Rgb::Constant(0.5)}});
  scene.surfaces.push_back({"tent", tent, scene::Lambert{Rgb(0.6, 0.5, 0.4)}});
  finish(scene);
  return scene;
}

inline scene::GaussianSum& fog_of(Scene& scene) { return std::get<scene::GaussianSum>(scene.media[0].field); }

struct Change {
  const char* name;
  std::function<void(Scene&)> make;
  Names made;     // stages of the CPU that are prepared anew, for settings `everything`
  int maps_made;  // of two lamps
  bool same_picture = false;
};

inline const Names all_of_fog{"gaussians", "light maps", "tree of average depths", "sky volume"};
inline const Change changes[] = {
    {"camera", [](Scene& s) { s.camera.position[0] += 0.1; }, {}, 0},
    {"one lamp moved",
     [](Scene& s) {
       s.lights[1] = scene::moved(s.lights[1], {0.1, 0, 0});
     },
     {"gaussians", "light maps"},
     1},
    {"a dimmed lamp", [](Scene& s) { std::get<scene::PointLight>(s.lights[0]).intensity *= 0.5; }, {"gaussians"}, 0},
    {"lamps the other way round", [](Scene& s) { std::swap(s.lights[0], s.lights[1]); }, {"gaussians"}, 0, true},
    {"one lamp more",
     [](Scene& s) {
       s.lights.push_back(lamp({0, 2, 1}, 3));
     },
     {"gaussians", "light maps"},
     1},
    {"one lamp less", [](Scene& s) { s.lights.erase(s.lights.begin()); }, {"gaussians"}, 0},
    {"a turned sky",
     [](Scene& s) { s.lights[2] = scene::turned(s.lights[2], 0.4); },
     {"gaussians", "harmonics of the environment", "sky volume"},
     0},
    {"moved Gaussians",
     [](Scene& s) {
       for (auto& g : fog_of(s).gaussians) g.center[0] += 0.05;
     },
     all_of_fog, 2},
    {"one Gaussian moved", [](Scene& s) { fog_of(s).gaussians[3].center[1] += 0.05; }, all_of_fog, 2},
    {"a Gaussian more",
     [](Scene& s) {
       fog_of(s).gaussians.push_back({Point3(0.2, 0.5, 1), 0.4, 0.2});
     },
     all_of_fog, 2},
    {"Gaussians removed", [](Scene& s) { fog_of(s).gaussians.resize(26); }, all_of_fog, 2},
    {"denser Gaussians", [](Scene& s) { s.media[0].sigma_t *= 1.2; }, all_of_fog, 2},
};

inline const Pairs everything{{"environment_airlight", "volume"},
                              {"sky_cells", "6"},
                              {"sky_directions", "16"},
                              {"prt", "true"},
                              {"prt_rays", "32"},
                              {"reflectance", "npsf"}};

// The scene one frame later, finished.
inline std::shared_ptr<const Scene> changed(const Scene& from, const Change& change) {
  auto to = std::make_shared<Scene>(from);
  change.make(*to);
  finish(*to);
  return to;
}

}  // namespace fogshop_next_frames
