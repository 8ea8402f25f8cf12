// Columns of the smoke from the nodes of a grid towards the directions that light comes from, on the device: those of environments come from
// the processor, once; those of directional lights are found where they move.
#pragma once
#include <memory>
#include <vector>

#include "gpu/compensated_ray_marching/marched_smoke.h"
#include "methods/compensated_ray_marching/lit_grid.h"

namespace airlight::gpu::compensated_ray_marching {

class SmokeColumns {
 public:
  // All of these outlive this; `middle`: that of the density. No columns before aim(). Throws Unavailable where the device has no room.
  SmokeColumns(Context&, const scene::Scene&, const airlight::compensated_ray_marching::LitGrid&, const SmokeDensity&,
               const Point3& middle);

  // Where light comes from, now. The processor looks which nodes surfaces hide from a directional light that moved: a bit of each goes up.
  // Whether any moved, came or went.
  bool aim(const airlight::compensated_ray_marching::IncomingLight&, const scene::Execution&);

  const Buffer& values() const { return *values_; }  // [direction][node, m]; 1e37: blocked
  const Buffer& nodes() const { return *nodes_; }    // their cells
  int count() const { return int(grid_.nodes().size()); }

 private:
  void find(std::size_t direction, const Vec3& to_light, const scene::Execution&);
  std::vector<std::uint32_t> hidden_from(const Vec3& to_light, const scene::Execution&) const;

  Context& context_;
  const scene::Scene& scene_;
  const airlight::compensated_ray_marching::LitGrid& grid_;
  const SmokeDensity& density_;
  Point3 middle_;
  Program& program_;
  std::vector<Vec3> towards_;  // directional lights that there is room for, 0 where none has been
  std::size_t lights_ = 0;     // now
  std::unique_ptr<Buffer> nodes_, node_of_cell_, values_, hidden_;
};

// The uniforms corner, cell_edge, cells_along: of the nodes, relative to `middle`.
void set_grid(Program&, const airlight::compensated_ray_marching::NodeGrid&, const Point3& middle);

}  // namespace airlight::gpu::compensated_ray_marching
