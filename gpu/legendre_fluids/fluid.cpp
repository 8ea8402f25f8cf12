#include "gpu/legendre_fluids/fluid.h"

#include <algorithm>

namespace airlight::gpu::legendre_fluids {

bool pushes(const Acting& acting) {
  const auto acts = [](const Vec3& v) { return !v.isZero(0); };
  return std::any_of(acting.pushes.begin(), acting.pushes.end(), acts) ||
         std::any_of(acting.weights.begin(), acting.weights.end(), acts);
}

FluidOnDevice::FluidOnDevice(Context& context, Fluid& fluid) : context_(context) {
  for (std::size_t i = 0; i < fluid.carried().size(); ++i)
    if (fluid.carried()[i]->size() > 0) carried_.push_back(i);
}

}  // namespace airlight::gpu::legendre_fluids
