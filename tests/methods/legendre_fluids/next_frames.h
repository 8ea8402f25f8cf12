// Frames of smoke in two boxes over a floor, each of which differs from the first in one thing: for tests of Prepared::next.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "scene/media/legendre_box.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

namespace legendre_next_frames {

using namespace airlight;
using namespace airlight::legendre_fluids::testing;
using scene::Scene;

constexpr int sky_directions = 3;
inline const test::Given given{{"environment_directions", std::to_string(sky_directions)}, {"shadow_steps", "16"}};

inline const Box high_box{Point3(-0.5, 1.2, -0.5), Point3(0.5, 2, 0.7)};

// Another density in the box of a medium; `dip` draws it below 0 in some places.
inline void become(scene::Medium& medium, unsigned seed, double dip = 0) {
  const scene::LegendreBox& box = *std::get<scene::LegendrePointer>(medium.field);
  Eigen::VectorXd c = random_density(box.shape(), seed)->coefficients();
  c[0] -= dip;
  medium.field = std::make_shared<const scene::LegendreBox>(box.box(), box.shape(), c);
}

// Two lamps infinitely far away and a sky of one colour, over a floor, with a ball before one lamp.
inline Scene smoke_over_floor() {
  const Vec3 from_above(-0.48, 0.6, 0.64);
  Scene scene = *lit_scene(smoke(random_density({4, 3, 5}, 1), 1.5), from_above, oblique_view, 14, 11);
  scene.media.push_back(smoke(random_density({3, 4, 3}, 2, 1, high_box), 0.7, 0.9));
  scene.lights.push_back(scene::DirectionalLight{Vec3(0.6, 0.8, 0), Rgb(0.5, 0.4, 0.3)});
  scene::EnvironmentLight sky;
  sky.scale = Rgb(0.1, 0.15, 0.2);
  scene.lights.push_back(sky);
  scene::Plane floor;
  floor.point = Point3(0, -1.3, 0);
  floor.normal = Vec3::UnitY();
  scene.surfaces.push_back({"floor", floor, scene::Lambert{Rgb::Constant(0.5)}});
  scene.surfaces.push_back({"ball", scene::Sphere{Point3(1.1, 1.4, 0), 0.4}, scene::Lambert{Rgb::Constant(0.5)}});
  finish(scene);
  return scene;
}

struct Change {
  const char* name;
  std::function<void(Scene&)> make;
  int columns_made;   // of two media towards two lamps and sky_directions
  bool keeps;         // all that is on a device
  bool same = false;  // one picture
};

inline const int all_lights = 2 + sky_directions;
inline const Change changes[] = {
    {"nothing", [](Scene&) {}, 0, true, true},
    {"camera", [](Scene& s) { s.camera.position += Vec3(0.05, 0.02, 0); }, 0, true},
    {"a dimmed lamp", [](Scene& s) { std::get<scene::DirectionalLight>(s.lights[1]).irradiance *= 0.5; }, 0, true},
    {"a dark lamp", [](Scene& s) { std::get<scene::DirectionalLight>(s.lights[0]).irradiance *= 0; }, 0, true},
    {"a turned lamp", [](Scene& s) { std::get<scene::DirectionalLight>(s.lights[1]).to_light = Vec3(0, 0.8, 0.6); }, 2,
     true},
    {"a dimmed sky", [](Scene& s) { std::get<scene::EnvironmentLight>(s.lights[2]).scale *= 0.5; }, 0, true},
    {"another density", [](Scene& s) { become(s.media[1], 7); }, all_lights, false},
    {"both densities", [](Scene& s) { become(s.media[0], 8), become(s.media[1], 9); }, 2 * all_lights, false},
    {"a density that is read again",
     [](Scene& s) {
       const scene::LegendreBox& box = *std::get<scene::LegendrePointer>(s.media[0].field);
       s.media[0].field = std::make_shared<const scene::LegendreBox>(box);
     },
     0, true, true},
    {"a density below 0", [](Scene& s) { become(s.media[0], 8, 2); }, all_lights, false},
    {"denser", [](Scene& s) { s.media[0].sigma_t *= 1.5; }, all_lights, true},
    {"another albedo", [](Scene& s) { s.media[0].albedo *= 0.5; }, 0, true},
    {"another region",
     [](Scene& s) {
       s.media[0].region = Box{Point3(-0.7, -1, -1), Point3(1, 1, 0.9)};
     },
     all_lights, false},
    {"one medium less", [](Scene& s) { s.media.pop_back(); }, 0, false},
    {"no medium", [](Scene& s) { s.media.clear(); }, 0, false},
    {"one medium more",
     [](Scene& s) {
       s.media.push_back(smoke(random_density({3, 3, 3}, 5, 1, high_box), 0.4));
     },
     all_lights, false},
    {"a floor that sinks", [](Scene& s) { std::get<scene::Plane>(s.surfaces[0].shape).point[1] -= 0.1; }, 0, false},
    {"no ball", [](Scene& s) { s.surfaces.pop_back(); }, 0, false},
    {"no surfaces", [](Scene& s) { s.surfaces.clear(); }, 0, false},
};

// Smoke of two albedos in one box above a floor, lit by two lamps: what the paper's systems can draw.
inline Scene smoke_for_systems() {
  Scene scene = *with_albedo_field(
      lit_scene(smoke(random_density({4, 3, 4}, 1), 1), Vec3(-0.48, 0.6, 0.64), oblique_view, 14, 11), {4, 3, 4}, 2);
  scene.lights.push_back(scene::DirectionalLight{Vec3(0.6, 0.8, 0), Rgb(0.5, 0.4, 0.3)});
  scene::Plane floor;
  floor.point = Point3(0, -1.3, 0);
  floor.normal = Vec3::UnitY();
  scene.surfaces.push_back({"floor", floor, scene::Lambert{Rgb::Constant(0.5)}});
  finish(scene);
  return scene;
}

struct PaperChange {
  const char* name;
  std::function<void(Scene&)> make;
  int systems_made;  // of two lamps
  bool same = false;
};
inline const PaperChange paper_changes[] = {
    {"nothing", [](Scene&) {}, 0, true},
    {"camera", [](Scene& s) { s.camera.position += Vec3(0.05, 0.02, 0); }, 0},
    {"a camera that turns",
     [](Scene& s) {
       const scene::Camera before = s.camera;
       s.camera = scene::look_at(Point3(-2, 2, 4), Point3::Zero(), Vec3::UnitY());
       s.camera.kind = before.kind;
       s.camera.height = before.height;
     },
     0},
    {"a dimmed lamp", [](Scene& s) { std::get<scene::DirectionalLight>(s.lights[1]).irradiance *= 0.5; }, 0},
    {"a turned lamp", [](Scene& s) { std::get<scene::DirectionalLight>(s.lights[1]).to_light = Vec3(0, 0.8, 0.6); }, 1},
    {"one lamp less", [](Scene& s) { s.lights.pop_back(); }, 0},
    {"another density", [](Scene& s) { become(s.media[1], 7); }, 2},
    {"a density below 0", [](Scene& s) { become(s.media[0], 8, 1); }, 2},
    {"denser", [](Scene& s) { s.media[0].sigma_t *= 1.5, s.media[1].sigma_t *= 1.5; }, 2},
    {"coloured", [](Scene& s) { s.media[0].sigma_t = s.media[1].sigma_t = Rgb(0.5, 1, 1); }, 2},
    {"another albedo", [](Scene& s) { s.media[0].albedo *= 0.5; }, 2},
    {"one density", [](Scene& s) { s.media.pop_back(); }, 2},
    {"no medium", [](Scene& s) { s.media.clear(); }, 0},
    {"a floor that sinks", [](Scene& s) { std::get<scene::Plane>(s.surfaces[0].shape).point[1] -= 0.1; }, 0},
    {"no floor", [](Scene& s) { s.surfaces.clear(); }, 0},
};

template <class Change>
std::shared_ptr<const Scene> changed(const Scene& from, const Change& change) {
  auto scene = std::make_shared<Scene>(from);
  change.make(*scene);
  finish(*scene);
  return scene;
}

}  // namespace legendre_next_frames
