// One walk of the path tracer: what its two kinds (path.cpp and walk_to_surface.cpp) have in common.
#pragma once
#include "reference/path_tracer/counters.h"
#include "reference/path_tracer/path_sample.h"
#include "reference/path_tracer/world.h"

namespace airlight::path_tracer {

// A vertex from which light is gathered: in a medium, or on a surface.
struct Vertex {
  Point3 x;
  Vec3 w;  // direction of the walk that arrived here, away from the eye
  int medium = -1;
  const scene::Hit* hit = nullptr;
};

// One walk; see path.h. `throughput` is what radiance arriving at the current vertex is worth; `density[c]` is how
// likely channel c would have made the path so far, relative to the mean over the channels. A walk that forces a
// collision before a surface splits: a copy of it goes on from the collision, itself goes on to the surface.
class Walk {
 public:
  Walk(const World& world, const SampleRandom& random, PathSample& sample, Counters& counters)
      : world_(world),
        media_(world.media()),
        lights_(world.lights()),
        random_(random),
        sample_(sample),
        counters_(counters) {}

  void run(const CameraRay&);
  // Paths::lit_surface and scattered_to_surface; in walk_to_surface.cpp.
  void run_to_surface(const CameraRay&);

 private:
  // Transmittance of a whole segment, and the one that weights may use (1 where it would be noise).
  Rgb transmittance(const Ray& ray, double t, std::uint32_t branch) {
    if (world_.options().column_transmittance) return media_.transmittance(ray, t, counters_);
    return media_.ratio_transmittance(ray, t, random_, dimension(), branch, counters_);
  }
  bool exact() const { return world_.options().column_transmittance; }

  // Phase function or reflectance times cosine, towards a direction, and the density with which the walk would draw it.
  Rgb scatter_value(const Vertex&, const Vec3& out) const;
  double scatter_pdf(const Vertex&, const Vec3& out) const;
  Point3 origin(const Vertex& v, const Vec3& out) const {
    return v.hit ? world_.scene().geometry->offset_origin(v.x, v.hit->normal, out) : v.x;
  }

  double connection_pdf(int light, const Ray&, Interval hull, double t) const;
  void gather(const Vertex&, const Rgb& analog_pdf);
  void gather_delta(const Vertex&, const Pick&, const Rgb& analog_pdf);
  void gather_environment(const Vertex&, const Pick&, double u1, double u2);
  void connect(const Ray&, Interval hull, const Rgb& throughput, const Pick&, double direction_pdf, const Rgb& gain,
               bool from_camera, int reflections, double u);
  void connect_from(const Vertex&);
  void escape(const Ray&);
  void escape_unscattered(const scene::RayEnd&);
  bool survive(double u);

  // The segments of a walk, each ended by a vertex; false: the walk ends there.
  void follow(const scene::RayEnd&);
  inline scene::RayEnd aim();
  Flight flight_on(const Ray&, const scene::RayEnd&, Interval hull) const;
  std::optional<Collision> fly(double tmax) const;
  inline bool pass(const scene::RayEnd&);
  bool pass_forced(const scene::RayEnd&);
  inline bool collide(const Collision&);
  inline bool reflect(const scene::RayEnd&);
  inline Vertex next_vertex();
  inline bool leave(const Vertex&);

  // After so many reflections more?
  bool may_scatter(int reflections = 0) const {
    const Options& o = world_.options();
    return (o.max_order < 0 || m_ < o.max_order) && (o.max_events < 0 || m_ + s_ + reflections < o.max_events);
  }
  bool may_reflect() const { return world_.options().max_events < 0 || m_ + s_ < world_.options().max_events; }
  // The random numbers of this vertex; branches of a walk have their own.
  std::uint32_t dimension() const { return branch_ << branch_shift | vertex_; }
  RandomBlock block(Purpose purpose, std::uint32_t index = 0) const {
    return random_.block(dimension(), purpose, index);
  }
  static constexpr int branch_shift = 24;

  const World& world_;
  const Media& media_;
  const Lights& lights_;
  const SampleRandom& random_;
  PathSample& sample_;
  Counters& counters_;

  Rgb throughput_ = Rgb::Ones();
  Rgb density_ = Rgb::Ones();
  double scale_ = 1;  // of throughput: what forced collisions alone have made of it
  int hero_ = 0;
  int m_ = 0, s_ = 0;                // scatterings, reflections so far
  std::uint32_t vertex_ = 0;         // 0: the eye; below 2^branch_shift
  std::uint32_t branch_ = 0;         // 0: the walk itself
  Ray ray_;                          // current segment
  Interval hull_;                    // where media are on it
  const Flight* flight_ = &analog_;  // how it is passed: the camera ray's, own_ or analog_
  Flight own_;
  static const Flight analog_;
  double direction_pdf_ = 1;  // density with which its direction was drawn [1/sr]; 1 from the eye
};

}  // namespace airlight::path_tracer
