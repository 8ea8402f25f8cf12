// The march of Zhou et al. 2008 on the device, for vectors: along one ray, in slices that are given.
#pragma once
#include <vector>

#include "experiments/verify/smoke_on_device.h"
#include "experiments/verify/smoke_vector.h"
#include "gpu/compensated_ray_marching/centre_tables.h"
#include "gpu/view_uniforms.h"
#include "methods/compensated_ray_marching/compensated_march.h"

namespace airlight::experiments::verification {

// The march of the device along the ray in the middle of a view, over ranges that are given or found.
template <class BindSource>
crm::Marched march_on_device(const on::SmokeDensity& density, const Rgb& sigma_t, const scene::View& view,
                             const Point3& middle, const gpu::Buffer& ranges, crm::SliceWeight weight,
                             BindSource&& bind_source) {
  gpu::Context& context = gpu::Context::get();
  const gpu::Buffer airlight(context, "airlight", 12), column(context, "column", 4);
  on::Definitions definitions = density.definitions();
  definitions["SCATTERS"] = "1";
  gpu::Program& march = on::program(context, "march", 8, 8, definitions);
  const int count = int(ranges.download<float>()[2]);
  ranges.bind(on::at::ranges);
  airlight.bind(on::at::airlight_layer);
  column.bind(on::at::column);
  gpu::set_camera(march, view, middle);
  density.bind(march);
  bind_source(march);
  march.set("sigma_t", sigma_t);
  march.set("weight", int(weight));
  for (int first = 0; first < count; first += density.slices()) {
    march.set("first_slice", first);
    march.dispatch(1, 1);
  }
  const double depth = column.download<float>()[0];
  return {Rgb::Constant(airlight.download<float>()[0]), (-depth * sigma_t).exp()};
}

// Marches on the device with `variant = paper`, through Gaussians with sources of 16 harmonics at their centres.
class CentreMarch {
 public:
  explicit CentreMarch(const crm::MarchedSmoke& smoke)
      : medium_(medium_of(smoke)),
        field_(medium_, paper_options(4)),
        middle_(smoke.gaussians.gaussians[0].center),
        density_(context_, field_, middle_, true),
        tables_(context_, 4, crm::Transmittance::series, 3, false),
        count_(smoke.source.size()),
        centres_(context_, "centres", numbers_of(smoke.gaussians.gaussians)),
        single_(context_, "single", bands_of(smoke)),
        again_(context_, "again", 8 * 3 * 4 * count_),
        sources_(context_, "sources", 16 * count_) {}
  // From the ray's origin on. The camera is orthographic: it looks at all centres from one direction, as the oracle's rays do.
  crm::Marched slices(const Ray& ray, const crm::Slices& slices, crm::SliceWeight weight) const {
    const scene::View view = view_along(ray, 1);
    gpu::Program& towards = on::program(context_, "centre_towards", 64, 1, tables_.definitions());
    tables_.bind(towards);
    centres_.bind(on::at::centres);
    single_.bind(on::at::single_bands);
    again_.bind(on::at::again);
    sources_.bind(on::at::centre_sources);
    towards.set("gaussian_count", int(count_));
    towards.set("perspective_", false);
    towards.set_double("eye", view.camera.position);
    towards.set_double("forward", view.camera.forward);
    towards.dispatch(int(count_));
    const float slope = float(std::abs(ray.direction.dot(slices.axis)));
    const gpu::Buffer ranges(context_, "ranges",
                             std::vector<float>{0, float(slices.thickness / slope), float(slices.count), slope});
    return march_on_device(density_, medium_.sigma_t, view, middle_, ranges, weight, [&](gpu::Program& march) {
      sources_.bind(on::at::centre_sources);
      march.set("least_source_density", field_.least_density());
    });
  }

 private:
  static std::vector<double> bands_of(const crm::MarchedSmoke& smoke) {  // [channel][band][centre]
    std::vector<double> bands;
    for (int c = 0; c < 3; ++c)
      for (std::size_t b = 0; b < 16; ++b)
        for (const std::vector<Rgb>& source : smoke.source) bands.push_back(source[b][c]);
    return bands;
  }
  static scene::Medium medium_of(const crm::MarchedSmoke& smoke) {
    scene::Medium medium;
    medium.field = smoke.gaussians;
    medium.sigma_t = smoke.extinction;
    return medium;
  }

  gpu::Context& context_ = gpu::Context::get();
  scene::Medium medium_;
  crm::SmokeField field_;
  Point3 middle_;
  on::SmokeDensity density_;
  on::CentreTables tables_;
  std::size_t count_;
  gpu::Buffer centres_, single_, again_, sources_;
};

}  // namespace airlight::experiments::verification
