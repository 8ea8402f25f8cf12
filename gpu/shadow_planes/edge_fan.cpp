#include "gpu/shadow_planes/edge_fan.h"

#include "methods/shadow_planes/edge_fan.h"

namespace airlight::gpu::shadow_planes {

using airlight::shadow_planes::EdgeFan;

FanOnDevice::FanOnDevice(Context& context, int most_edges)
    : context_(context),
      sectors_(context, "edges of sectors", 4 * std::size_t(EdgeFan::total_sectors() + 1)),
      lists_(context, "edges by sector", 8 * std::size_t(EdgeFan::total_sectors()) + 16 * std::size_t(most_edges),
             Contents::undefined),
      count_(&program(context, "fan", edges_per_group, 1, {{"FILL", "0"}})),
      begin_(&program(context, "fan_starts", 128)),
      list_(&program(context, "fan", edges_per_group, 1, {{"FILL", "1"}})) {}

void FanOnDevice::fill(const scene::Camera& camera, const Point3& light, const LightEdges& edges) {
  const Use use(context_);
  const airlight::shadow_planes::FanAxes axes = airlight::shadow_planes::fan_axes(camera, light);
  x_ = axes.x;
  y_ = axes.y;
  edges.bind();
  sectors_.bind(at::sectors);
  bind(*count_);
  edges.dispatch(*count_);
  begin_->dispatch((EdgeFan::total_sectors() + sectors_per_group - 1) / sectors_per_group * 128);
  bind(*list_);
  edges.dispatch(*list_);
}

void FanOnDevice::bind(LinkedProgram& program) const {
  lists_.bind(at::lists);
  program.set_double("fan_x", x_);
  program.set_double("fan_y", y_);
}

}  // namespace airlight::gpu::shadow_planes
