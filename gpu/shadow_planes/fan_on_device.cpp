#include "gpu/shadow_planes/fan_on_device.h"

#include "gpu/program.h"
#include "methods/shadow_planes/edge_fan.h"

namespace airlight::gpu {

using shadow_planes::EdgeFan;

FanOnDevice::FanOnDevice(Context& context)
    : context_(context),
      counts_(context, "edges of sectors", 4 * std::size_t(EdgeFan::total_sectors())),
      starts_(context, "lists of sectors", 4 * (std::size_t(EdgeFan::total_sectors()) + 1)) {}

void FanOnDevice::fill(const scene::Camera& camera, const Point3& light, const LightEdges& edges) {
  const Use use(context_);
  const shadow_planes::FanAxes axes = shadow_planes::fan_axes(camera, light);
  x_ = axes.x;
  y_ = axes.y;
  const std::size_t bytes = 16 * std::size_t(edges.count);
  if (!lists_ || lists_->bytes() < bytes) lists_ = std::make_unique<Buffer>(context_, "edges by sector", bytes);
  counts_.upload(std::vector<int>(EdgeFan::total_sectors()));
  edges.edges->bind(0);
  counts_.bind(1);
  const auto sort = [&](const char* fill) {
    Program& p = context_.program("shadow_planes/fan.comp", {{"LOCAL_SIZE_X", "64"}, {"FILL", fill}});
    bind(p);
    p.set("edge_count", edges.count);
    p.dispatch(edges.count);
  };
  sort("0");
  Program& p = context_.program("shadow_planes/fan_starts.comp", {{"LOCAL_SIZE_X", "128"}});
  p.set("total_sectors", EdgeFan::total_sectors());
  p.dispatch(1);
  sort("1");
}

void FanOnDevice::bind(LinkedProgram& program) const {
  starts_.bind(3);
  lists_->bind(4);
  program.set_double("fan_x", x_);
  program.set_double("fan_y", y_);
}

}  // namespace airlight::gpu
