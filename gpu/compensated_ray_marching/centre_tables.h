// The processor's tables for sources at the centres, uploaded for shaders in double precision: centre_tables.glsl,
// triple_product.glsl.
#pragma once
#include "gpu/compensated_ray_marching/interface.h"
#include "methods/compensated_ray_marching/source_radiance.h"

namespace airlight::gpu::compensated_ray_marching {

class CentreTables {
 public:
  // `objects`: with tables for shadows of objects. For `directional`, products are sums over directions.
  CentreTables(Context&, int order, airlight::compensated_ray_marching::Transmittance, double cutoff, bool objects);
  const Definitions& definitions() const { return definitions_; }
  void bind(Program&) const;  // centre_tables.glsl
  void bind_terms() const;    // triple_product.glsl

 private:
  int order_;
  Definitions definitions_;
  std::unique_ptr<Buffer> tables_, terms_;
};

// sqrt(4 pi / (2l+1)): a zonal coefficient times it and y_lm(axis) is a coefficient of the function about the axis.
double about_axis_factor(int l);

}  // namespace airlight::gpu::compensated_ray_marching
