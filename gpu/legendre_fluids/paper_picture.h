// The variant `paper` of the renderer on the device: methods/legendre_fluids/paper_picture.h, the same settings and layers.
#pragma once
#include <memory>

#include "gpu/legendre_fluids/legendre_fluids.h"
#include "methods/legendre_fluids/light_options.h"
#include "scene/renderer.h"

namespace airlight::gpu::legendre_fluids {

// A picture whose density may become that of a flow (draw_flow).
class TakesDensity {
 public:
  virtual ~TakesDensity() = default;
  // `medium`: among those that extinguish.
  virtual bool take(std::size_t medium, const DensityOnDevice&) = 0;
};

// Why shaders cannot do what the CPU's variant can; empty if they can.
std::vector<std::string> unsupported_paper(const scene::Scene&, const airlight::legendre_fluids::PaperOptions&);

// Null where no medium extinguishes but something can be seen: then variant `ray` draws the same picture. Throws Error where a system does
// not converge.
std::unique_ptr<scene::Prepared> prepare_paper(std::shared_ptr<const scene::Scene>,
                                               const airlight::legendre_fluids::PaperOptions&,
                                               const scene::Settings& given);

}  // namespace airlight::gpu::legendre_fluids
