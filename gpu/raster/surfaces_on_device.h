// The surfaces of a scene, and the balls of its lights, in storage buffers: uploaded once, drawn from any view.
#pragma once
#include <vector>

#include "gpu/buffer.h"
#include "scene/scene.h"

namespace airlight::gpu {

// A surface without triangles; the layout of raster/solids.glsl.
struct Solid {
  double point[3];  // of the plane, or the centre [m]
  double radius;    // [m]
  double normal[3];
  int kind;     // 0: plane, 1: sphere, 2: a light's ball
  int surface;  // index; -2: a ball
};

class SurfacesOnDevice {
 public:
  // Throws Unavailable if a buffer passes the device's limits (about 5 million vertices or 8 million triangles in
  // 128 MiB). Balls are left out where `with_balls` is false: no light casts the shadow of a ball.
  SurfacesOnDevice(Context&, const scene::Scene&, bool with_balls);

  // The balls of the same lights, moved. False where they are not as many as before: then nothing is changed.
  bool move_balls(const scene::Scene&);

  // Binds 10 (vertices), 11 (triangles), 12 (solids).
  void bind() const;

  // Surfaces in their order, neighbours of one kind together: of coinciding ones the first wins, as on the CPU.
  struct Run {
    bool mesh;
    int first, count;  // triangles or solids
  };
  const std::vector<Run>& runs() const { return runs_; }
  const std::vector<Solid>& solids() const { return solids_; }
  int triangles() const { return triangle_count_; }
  int vertices() const { return vertex_count_; }

  // A distance from `position` [m] within which everything finite lies, > 0.
  double extent(const Point3& position) const;

 private:
  struct Arrays;
  static Arrays arrays(const scene::Scene&, bool with_balls);
  SurfacesOnDevice(Context&, const Arrays&);

  std::vector<Run> runs_;
  std::vector<Solid> solids_;
  int triangle_count_, vertex_count_;
  Box bounds_, bounds_without_balls_;
  Buffer vertices_, triangles_, solid_buffer_;
};

}  // namespace airlight::gpu
