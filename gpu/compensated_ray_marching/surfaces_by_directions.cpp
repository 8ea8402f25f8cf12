#include "gpu/compensated_ray_marching/surfaces_by_directions.h"

#include <cmath>

#include "gpu/view_uniforms.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

constexpr int direction_lanes = 64;  // invocations of a work group

std::vector<float> towards(const std::vector<airlight::compensated_ray_marching::Ordinate>& directions) {
  std::vector<float> values;
  for (const auto& d : directions)
    for (const double v : {d.direction[0], d.direction[1], d.direction[2], 0.0}) values.push_back(float(v));
  return values;
}

}  // namespace

SurfacesByDirections::SurfacesByDirections(Context& context, const SmokeDensity* density, const Point3& middle,
                                           const std::vector<airlight::compensated_ray_marching::Ordinate>& directions)
    : density_(density),
      middle_(middle),
      directions_(int(directions.size())),
      program_(program(context, "surfaces_by_directions", direction_lanes, 1,
                       density ? density->definitions() : Definitions{{"GAUSSIANS", "1"}})),
      towards_(context, "directions", towards(directions)) {}

void SurfacesByDirections::light(const scene::View& view, const SurfacesOnDevice& surfaces, const Rgb& sigma_t,
                                 const Buffer& light, const Buffer& spheres, int count, const Buffer& primitives,
                                 const Buffer& lit) const {
  Program& p = program_;
  if (density_) {
    density_->bind(p);
  } else {
    towards_.bind(at::density);  // of which nothing is read
    p.set("gaussian_count", 0);
    p.set("region_kind", 0);
  }
  light.bind(at::light_bands);
  spheres.bind(at::spheres);
  towards_.bind(at::towards_light);
  primitives.bind(at::primitives);
  lit.bind(at::lit);
  surfaces.bind();
  set_view(p, view);
  p.set("sphere_count", count);
  p.set("triangle_count", surfaces.triangles());
  p.set("directions", directions_);
  p.set("spacing", std::sqrt(4 * pi / directions_));
  p.set_double("middle", middle_);
  p.set("sigma_t", sigma_t);
  p.set("widths2", density_ ? density_->widths2() : 0.0);
  p.set("loop_count", 3);
  p.dispatch(direction_lanes * view.width, view.height);
}

}  // namespace airlight::gpu::compensated_ray_marching
