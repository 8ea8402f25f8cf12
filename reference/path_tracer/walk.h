// The state of a path, and the steps that it takes: what the two kinds of path (path.cpp and path_to_surface.cpp) share.
#pragma once
#include <optional>

#include "reference/path_tracer/counters.h"
#include "reference/path_tracer/path_sample.h"
#include "reference/path_tracer/world.h"

namespace airlight::path_tracer {

// Where a path stands: everything that changes along it.
struct Path {
  // The current one, which starts at the current vertex: the camera's, or the next that the loop found.
  const Segment* segment = nullptr;
  double direction_pdf = 1;  // density with which its direction was drawn [1/sr]; 1 from the eye

  Rgb throughput = Rgb::Ones();  // what radiance that arrives at the current vertex is worth
  Rgb density = Rgb::Ones();     // how likely each channel would have made the path, relative to their mean
  double forced = 1;             // factor of the throughput that forced collisions alone have made
  int hero = 0;                  // the channel whose extinction the path follows
  int scatterings = 0, reflections = 0;

  std::uint32_t vertex = 0;  // 0: the eye; below 2^branch_shift
  std::uint32_t branch = 0;  // 0: the path itself
  static constexpr int branch_shift = 24;
  // Names the random numbers of the current vertex; branches of a path have their own.
  std::uint32_t dimension() const { return branch << branch_shift | vertex; }
};

// The vertex at which a segment ends: in a medium, or on a surface.
struct Vertex {
  Point3 x;
  Vec3 w;                           // direction of the path that arrived here, away from the eye
  int medium = -1;                  // index into the tracked media
  const scene::Hit* hit = nullptr;  // in the path's segment
  // In a medium: density, over solid angle and distance, with which the walk of each channel made this vertex out of the
  // one before.
  Rgb analog_pdf = Rgb::Zero();
};

// A ray on which the light of a close lamp is scattered once: see connection.cpp.
struct Connection {
  Ray ray;
  Interval hull;         // where media are on it
  Rgb throughput;        // with the phase function or reflectance towards it
  Rgb gain;              // of collisions, were it the path's segment (Flight)
  double direction_pdf;  // density with which the path would draw its direction [1/sr]; 1 from the eye
  int reflections;       // of the path, with that at the start of the ray
};

// The steps of a path through a world. It holds no state of the path: that is passed.
class Walk {
 public:
  Walk(const World& world, const SampleRandom& random, PathSample& sample, Counters& counters)
      : world_(world),
        options_(world.options()),
        media_(world.media()),
        lights_(world.lights()),
        random_(random),
        sample_(sample),
        counters_(counters) {}

  void run(const CameraRay&) const;             // path.cpp
  void run_to_surface(const CameraRay&) const;  // Paths::lit_surface and scattered_to_surface; path_to_surface.cpp

 private:
  // path.cpp: the main loop, and its steps in order.
  void follow(Path&, std::optional<Collision>) const;
  void aim(Path&, const Ray&, Segment&) const;
  Flight flight_on(const Path&, const Ray&, const scene::RayEnd&, Interval hull) const;
  std::optional<Collision> fly(const Path&) const;
  inline bool attenuate(Path&) const;
  void split(Path&, std::optional<Collision>&) const;
  Vertex next_vertex(Path&, const Point3&) const;
  inline bool collide(Path&, const Collision&, Vertex&) const;
  inline bool meet_surface(Path&, Vertex&) const;
  inline bool survive(Path&, double u) const;
  Vec3 draw_direction(Path&, const Vertex&, const RandomBlock&) const;

  void escape_unscattered(const Path&) const;  // path_to_surface.cpp

  // next_event.cpp: next-event estimation at a vertex, and what is combined with it where a path leaves the scene.
  void next_event(const Path&, const Vertex&) const;
  void next_event_delta(const Path&, const Vertex&, const Pick&) const;
  void next_event_environment(const Path&, const Vertex&, const Pick&, double u1, double u2) const;
  void escape(const Path&, const Rgb& throughput) const;

  // connection.cpp: light that is scattered once on a second ray from a vertex.
  void connect_from_eye(const Path&, double u_pick) const;
  void connect_from(const Path&, const Vertex&) const;
  void connect(const Path&, const Connection&, const Pick&, double direction_pdf, double u) const;
  double connection_pdf(const Path&, int light, double t) const;

  // Phase function or reflectance times cosine, and the density with which a path draws the direction.
  Rgb scatter_value(const Vertex&, const Vec3& out) const;
  double scatter_pdf(const Vertex&, const Vec3& out) const;
  Vec3 sample_scatter(const Vertex&, double u_lobe, double u, double turns) const;

  // Transmittance on [0, t]; ratio tracking keeps the random numbers of the segments of a vertex apart by `branch`.
  Rgb transmittance(const Path& path, const Ray& ray, double t, std::uint32_t branch) const {
    if (exact()) return media_.transmittance(ray, t, counters_);
    return media_.ratio_transmittance(ray, t, random_, path.dimension(), branch, counters_);
  }
  // May weights use transmittances? Not where these are noise.
  bool exact() const { return options_.column_transmittance; }

  // May the path scatter, or be reflected, once more, after so many reflections?
  bool may_scatter(const Path& path, int reflections = 0) const {
    return (options_.max_order < 0 || path.scatterings < options_.max_order) && may_go_on(path, reflections);
  }
  bool may_go_on(const Path& path, int reflections = 0) const {
    return options_.max_events < 0 || path.scatterings + path.reflections + reflections < options_.max_events;
  }
  // Is the end of the segment of no account, whatever is there?
  bool ends_unseen(const Path& path) const {
    return path.segment->end.on_ball || (path.scatterings == 0 && options_.paths == Options::Paths::scattered);
  }

  const scene::Material& material(const Vertex& v) const { return world_.scene().surfaces[v.hit->surface].material; }
  const scene::Medium& medium(int index) const { return *media_.tracked()[index].medium; }
  Point3 origin(const Vertex& v, const Vec3& out) const {
    return v.hit ? world_.scene().geometry->offset_origin(v.x, v.hit->normal, out) : v.x;
  }
  RandomBlock block(const Path& path, Purpose purpose, std::uint32_t index = 0) const {
    return random_.block(path.dimension(), purpose, index);
  }

  const World& world_;
  const Options& options_;
  const Media& media_;
  const Lights& lights_;
  const SampleRandom& random_;
  PathSample& sample_;
  Counters& counters_;
};

}  // namespace airlight::path_tracer
