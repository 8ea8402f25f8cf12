// Extinction and scattering at points of a camera ray, lit as in today's game engines: the medium's own
// shadow comes from maps of the lights (reference/light_map) or is left out. Froxels and the
// half-resolution march sample it. Light is scattered once.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "reference/light_map/light_map.h"
#include "reference/ray_marcher/layer.h"
#include "scene/base/settings.h"
#include "scene/renderer.h"

namespace airlight::lit_media {

struct Options {
  bool self_shadow =
      true;  // media dim light on its way, by a map of each light; else they do not, the default of most engines
  light_map::Options map;
  int environment_directions = 64;  // directional lights that stand for each environment
};

// Lists and reads the settings self_shadow, environment_directions, map_size, ...
void bind(scene::SettingBinder&, Options&);

// Reasons why these options cannot be used with the scene.
std::vector<std::string> unsupported(const scene::Scene&, const Options&);

// Plan of a scene before maps are made, on the CPU and on the device alike.
struct Plan {
  std::shared_ptr<const scene::Scene> scene;
  Options options;
  std::vector<ray_marcher::Layer> layers;
  // Lights that shine from one direction; an environment is replaced by directional lights. With self_shadow there are none from
  // infinitely far away where endless fog swallows them.
  std::vector<scene::Light> lights;
  bool scatters = false;  // may a point scatter light at all?
  double nearest = 0;     // light comes from so far away at least [m]
};
// `before`: of the frame before, whose layers are shared where they still hold; may be null.
Plan make_plan(std::shared_ptr<const scene::Scene>, const Options&, const Plan* before = nullptr);
// Do these media and lights stand for that scene's, too, so that maps and what else is made of them serve it?
bool fits(const Plan&, const scene::Scene&);
// Does a point or a surface ask for what media leave of a light? And the memory of the maps that then are made.
bool needs_maps(const Plan&);
double map_bytes(const Plan&);

// Work done.
struct Counters {
  long long points = 0;          // where the density of a medium was asked for
  long long look_ups = 0;        // in maps of lights
  long long occlusion_rays = 0;  // tested against surfaces
  void operator+=(const Counters&);
};

// Results at points along a ray, and the arrays that they are made with. Each thread has its own and keeps it between rays.
struct Samples {
  std::vector<Rgb> extinction;  // [1/m]
  std::vector<Rgb> source;      // scattered towards the viewer by a unit of length [W/m^3/sr]

  std::vector<double> x, y, z;
  std::vector<std::vector<double>> density;  // by layer
  std::vector<float> varied;                 // of one layer
  std::vector<float> depth[3];
  std::vector<Rgb> per_density;  // by layer: source of a unit of density, of one light before media dim it
};

class LitMedia {
 public:
  // `before`: of the frame before, with the same options; layers of media and maps of lights are shared where they still hold. May be null.
  // Throws Error where the lights' maps do not fit into memory. Its bits do not depend on the threads.
  LitMedia(std::shared_ptr<const scene::Scene>, const Options&, const scene::Execution&,
           const LitMedia* before = nullptr);
  // Without maps, for extinctions alone.
  explicit LitMedia(Plan);

  // At ascending distances t [m] on a ray; direction unit. Light nearer than 0.01 m counts as if it were so far away; where
  // media are smaller than a metre, light nearer than a hundredth of the smallest diagonal (mean free path of endless fog).
  void along(const Ray&, const std::vector<double>& t, Samples&, Counters&) const;

  // The extinction alone.
  void extinction_along(const Ray&, const std::vector<double>& t, Samples&) const;

  // Transmittance of the media on the way of light l to x.
  Rgb transmittance_to_light(std::size_t l, const Point3& x) const;

  const Plan& plan() const { return plan_; }
  const std::vector<scene::Light>& lights() const { return plan_.lights; }
  bool scatters() const { return plan_.scatters; }
  // Ends of what media hold of the ray, in steps of any length; empty where it meets none.
  Interval extent(const Ray&, Interval t) const;
  const std::vector<ray_marcher::Layer>& layers() const { return plan_.layers; }
  double map_seconds() const { return map_seconds_; }
  int maps_made() const { return maps_made_; }  // those shared with the frame before left out
  std::size_t map_bytes() const;

 private:
  void add_extinction(const Ray&, const std::vector<double>& t, Samples&, Counters&) const;
  void add_densities(const Ray&, const std::vector<double>& t, Samples&, Counters&) const;
  void add_light(std::size_t l, const Ray&, std::size_t begin, std::size_t end, Samples&, Counters&) const;

  Plan plan_;
  bool by_kernels_;
  light_map::Densities densities_;
  std::vector<std::shared_ptr<const light_map::LightMap>> maps_;  // none without self_shadow
  double map_seconds_ = 0;
  int maps_made_ = 0;
};

}  // namespace airlight::lit_media
