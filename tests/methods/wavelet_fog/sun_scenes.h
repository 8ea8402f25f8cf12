// Scenes for the layer of the sun: one sun over one map, cameras inside and outside, with houses in its way.
#pragma once
#include "scene/media/spline_map.h"
#include "tests/pictures.h"

namespace airlight::test {

// A lamp in the sky over one map; nothing else.
struct SunCase {
  const char* name;
  const char* map;
  scene::HeightProfile profile;
  Point3 eye, at;
  Vec3 to_sun;
  Rgb sigma_t, albedo;
  scene::PhaseFunction phase;
  double most;          // relative L2 error against the quadrature, of maps with an entry every quarter of a cell
  const char* samples;  // of the path tracer
  bool houses = false;
  scene::Region region = scene::Slab{Vec3::UnitY(), -100, 100};
};

inline const scene::Layers sunny_valley{{0, 3, 8}, {1, 0.8, 0}};
inline const Point3 eye_inside(2, 1.2, -3), eye_at_rim(-12, 2, -22), eye_outside(-60, 9, -45), eye_above(10, 40, -20);
inline const SunCase sun_cases[] = {
    {"low sun, inside",
     "patchy",
     sunny_valley,
     eye_inside,
     {3, 1.5, 8},
     {0.6, 0.12, 0.3},
     {.1, .15, .2},
     {.9, .8, .6},
     scene::Isotropic{},
     1e-5,
     "512"},
    {"low sun, outside, forward",
     "smooth",
     sunny_valley,
     eye_outside,
     {0, 2, 0},
     {0.7, 0.2, 0.6},
     {.05, .04, .03},
     {1, .9, .5},
     scene::HenyeyGreenstein{0.6},
     2e-6,
     "576"},
    {"high sun, outside",
     "hard",
     sunny_valley,
     eye_outside,
     {0, 2, 0},
     {0.2, 0.9, -0.3},
     {.1, .1, .1},
     {.7, .7, .7},
     scene::Rayleigh{},
     5e-5,
     "704"},
    {"exponential, inside, backward",
     "patchy",
     scene::ExponentialFall{1, 2},
     eye_inside,
     {20, 3, 6},
     {0.5, 0.4, 0.1},
     {.2, .15, .1},
     {.8, .9, 1},
     scene::HenyeyGreenstein{-0.3},
     4e-5,
     "768"},
    {"exponential, from above, low sun",
     "smooth",
     scene::ExponentialFall{-1, 4},
     eye_above,
     {0, 0, 0},
     {-0.9, 0.15, 0.4},
     {.1, .05, .02},
     {1, 1, 1},
     scene::HenyeyGreenstein{0.4},
     2e-5,
     "256"},
    {"no profile, inside, low sun",
     "smooth",
     scene::SameAtAllHeights{},
     eye_inside,
     {30, 4, 20},
     {0.5, 0.1, 0.8},
     {.02, .03, .04},
     {.9, .5, .2},
     scene::Isotropic{},
     2e-6,
     "256"},
    {"no profile, slab, sun at the zenith",
     "patchy",
     scene::SameAtAllHeights{},
     eye_at_rim,
     {3, 1.5, 8},
     {0, 1, 0},
     {.1, .1, .2},
     {.9, .9, .9},
     scene::HenyeyGreenstein{0.2},
     1e-7,
     "256",
     false,
     scene::Slab{Vec3::UnitY(), -2, 6}},
    {"thick, high sun, in a ball",
     "hard",
     sunny_valley,
     eye_at_rim,
     {3, 1.5, 8},
     {0.3, 0.8, 0.2},
     {1, .5, .3},
     {.9, .8, .7},
     scene::HenyeyGreenstein{0.5},
     6e-4,
     "416",
     false,
     scene::Sphere{{2, 1, 3}, 14}},
    {"houses, low sun, inside",
     "patchy",
     sunny_valley,
     {-14, 3, -12},
     {4, 0, 6},
     {-0.6, 0.35, -0.4},
     {.1, .1, .1},
     {.9, .9, .9},
     scene::HenyeyGreenstein{0.5},
     5e-6,
     "2048",
     true},
    {"houses, against the sun, outside",
     "smooth",
     scene::ExponentialFall{0, 3},
     {-27, 12, -29},
     {4, 0, 6},
     {0.6, 0.4, 0.5},
     {.04, .05, .06},
     {.9, .8, .9},
     scene::HenyeyGreenstein{0.7},
     8e-4,
     "1280",
     true},
};

inline std::shared_ptr<scene::Scene> sun_scene(const SunCase& c, int width, int height) {
  const auto scene = scene_named(std::string("wavelet_fog/") + c.map, width, height);
  const double fov = scene->camera.vertical_fov;
  scene->camera = scene::look_at(c.eye, c.at, Vec3::UnitY());
  scene->camera.vertical_fov = fov;
  scene->ambient_in_scatter = Rgb::Zero();
  scene->lights = {scene::DirectionalLight{c.to_sun.normalized(), Rgb(4, 3, 2)}};
  scene::Medium& medium = scene->media[0];
  auto fog = std::make_shared<scene::Fogmap>(*std::get<scene::FogmapPointer>(medium.field));
  fog->profile = c.profile;
  medium.field = scene::FogmapPointer(fog);
  medium.region = c.region;
  medium.sigma_t = c.sigma_t;
  medium.albedo = c.albedo;
  medium.phase = c.phase;
  if (c.houses) scene->surfaces = scene_named("wavelet_fog/valley", width, height)->surfaces;
  for (scene::Surface& surface : scene->surfaces) surface.material = scene::Lambert{Rgb::Zero()};  // airlight alone
  finish(*scene);
  return scene;
}

}  // namespace airlight::test
