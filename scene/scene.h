// A scene to render, an immutable value: one camera, lights, media, surfaces.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/backdrop.h"
#include "scene/camera.h"
#include "scene/geometry/geometry.h"
#include "scene/light/light.h"
#include "scene/media/medium.h"

namespace airlight::scene {

struct Scene {
  std::string name;  // from the file, or the file's stem
  Camera camera;
  int width = 160;  // film, pixels
  int height = 120;
  std::vector<Light> lights;
  std::vector<Medium> media;
  std::vector<Surface> surfaces;
  std::shared_ptr<const Geometry> geometry;                // null without surfaces
  std::vector<std::shared_ptr<const Backdrop>> backdrops;  // pictures with depth, particles: seen by this camera alone
  Rgb ambient_in_scatter =
      Rgb::Zero();           // [W/m^2/sr]: radiance that the fog sends everywhere, scaled by 1 - transmittance
  std::string hash;          // 32 hex digits of the content: equal hash, equal picture
  std::string matter_hash;   // of the media and surfaces alone
  std::string light_hash;    // of the lights alone
  std::string surface_hash;  // of the surfaces alone
};

// Changes before reading: "film.width" -> "64", "medium.0.sigma_t" -> "[1, 2, 4]"; the value is TOML text.
using Overrides = std::map<std::string, std::string>;

// Reads a scene file (scene/README.md). Throws Error: file:line:column, what was found, what was expected, nearest
// valid key.
Scene load_scene(const std::string& path, const Overrides& = {});

// Reads a scene from text. Relative asset names are resolved against `folder`.
Scene parse_scene(const std::string& toml, const std::string& name, const std::string& folder, const Overrides& = {});

// Fills geometry and hash of a scene made in code.
void finish(Scene&);

// Do these scenes have the same surfaces? Scenes that share their surfaces share their geometry or, where both were finished, their hash.
inline bool same_surfaces(const Scene& a, const Scene& b) {
  return a.surfaces.size() == b.surfaces.size() &&
         (a.geometry == b.geometry || (!a.surface_hash.empty() && a.surface_hash == b.surface_hash));
}

// The end of a ray: a surface hit, a light ball, a backdrop, or nothing (t infinite).
struct RayEnd {
  double t = infinity;
  std::optional<Hit> hit;   // set when a surface is first
  bool on_ball = false;     // the ray ends on a light's ball
  std::optional<Rgb> seen;  // what a backdrop sends from there [W/m^2/sr]; at t = infinity it stands for environments
};
RayEnd ray_end(const Scene&, const Ray&);
// The end of a ray of the scene's own camera. Backdrops end such a ray too, where nothing is nearer.
RayEnd camera_end(const Scene&, const Ray&);

}  // namespace airlight::scene
