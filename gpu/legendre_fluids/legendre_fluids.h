// Legendre fluids in compute shaders: the variants of methods/legendre_fluids, with its settings. `galerkin` is in single precision, the
// paper's variants are in double precision. The coefficients stay on the device from step to step; what is asked of a flow brings them down
// once.
#pragma once
#include <optional>

#include "gpu/buffer.h"
#include "scene/flow/flow.h"

namespace airlight::gpu::legendre_fluids {

// Where a flow's density lies on the device: a field of coefficients [x][y][z], as many along each axis. Until the next step.
struct DensityOnDevice {
  const Buffer& state;
  std::size_t field;
  int coefficients;
  Box box;
};
// The density of Flow::medium on the device. Nothing for a flow of another solver, in two dimensions, or
// without that density.
std::optional<DensityOnDevice> density_on_device(const scene::Flow&, int density = 0);

class LegendreFluids final : public scene::Solver {
 public:
  std::string name() const override { return "legendre_fluids_gpu"; }
  std::string about() const override;
  std::string device() const override { return Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::FlowProblem&, const scene::Settings&) const override;
  int steps_per_frame(const scene::FlowProblem&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Flow> start_supported(std::shared_ptr<const scene::FlowProblem>, const scene::Settings&,
                                               const scene::Execution&) const override;
};

}  // namespace airlight::gpu::legendre_fluids
