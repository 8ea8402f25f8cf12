// The paper's picture of one light: a stencil, and planes drawn back to front (Biri et al. 2006, section 5.1, stages 2
// to 5, and 5.2 for media in regions).
#pragma once
#include <array>
#include <optional>

#include "methods/shadow_planes/edge_fan.h"
#include "methods/shadow_planes/pixel.h"
#include "methods/shadow_planes/plane_order.h"
#include "methods/shadow_planes/vertex_airlight.h"
#include "scene/base/stopwatch.h"

namespace airlight::shadow_planes {

bool all_end(const std::vector<scene::Medium>&);  // their regions are finite

// How far from the light [m] planes are meshed before the strip without end. Media that end need no more: `region`
// alone, or all; else past everything of finite size, and the farther the more levels there are, so that they all
// shrink.
double mesh_reach(const scene::Scene&, const scene::Region*, const Point3& light, const Point3& camera, int levels);

class PaperStages {
 public:
  // Does the work of one picture: keys of planes, vertices. `lights` are the lights that the media scatter; `shadows`
  // by light, empty: nothing casts shadows. Keeps references to all arguments but the camera. Throws Error, naming the
  // scene and the settings, if keys and vertices would take more than 1.5 GB.
  PaperStages(const scene::Scene&, const std::vector<scene::Light>& lights, const Options&,
              const std::vector<AirlightTerm>&, const std::vector<ShadowVolumes>& shadows, const scene::Camera&,
              int threads);

  // Adds the airlight of a light to pixels. `fan`: null if nothing casts shadows; `count`: of surfaces between
  // light and camera; of a ray's own origin where there is none.
  void draw(std::size_t light, const EdgeFan* fan, std::optional<int> count, std::vector<Pixel>&, Counts&,
            StageSeconds&) const;

  const StageSeconds& seconds() const { return seconds_; }  // of the constructor
  std::size_t vertices() const;
  std::size_t planes() const { return planes_; }

 private:
  // One airlight term as one light shows it.
  struct Part {
    const PaperMedium* medium;              // null: it fills all space, or its regions are exact
    std::optional<MediaBoundary> boundary;  // of the medium
    std::vector<double> triangle_key;       // order of its triangles
    bool planes_end = false;                // planes count only between the first entry into media and the last exit
    std::vector<char> left_out;             // edges whose planes cannot cut the medium's box
    std::optional<VertexAirlight> at_vertices;  // else by pixel
  };
  struct Work;
  void check_memory() const;  // throws Error before more is allocated than anybody has
  void draw_ends(std::size_t light, std::size_t term, const std::vector<Pixel>&, Work&, Counts&) const;
  void draw_planes(std::size_t light, std::size_t term, const std::vector<Pixel>&, Work&, Counts&) const;
  Rgb to_end(std::size_t light, std::size_t term, const Pixel&, Interval domain, Counts&) const;
  void add(Rgb& sum, const Rgb& value) const;

  const scene::Scene& scene_;
  const std::vector<scene::Light>& lights_;
  const Options& options_;
  const std::vector<AirlightTerm>& airlight_terms_;
  const std::vector<ShadowVolumes>& shadows_;
  std::vector<PlaneOrder> orders_;        // by light
  std::vector<std::vector<Part>> parts_;  // by light, air
  StageSeconds seconds_;
  std::size_t planes_ = 0;
};

}  // namespace airlight::shadow_planes
