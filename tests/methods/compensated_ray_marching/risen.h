// Smoke of the next frame.
#pragma once
#include "scene/media/gaussian_sum.h"

namespace airlight::test {

// Smoke that has risen and grown by shares of `step`.
inline scene::GaussianSum risen(scene::GaussianSum sum, double step) {
  for (scene::Gaussian& g : sum.gaussians) {
    g.center += Vec3(0.3, 1, -0.2) * step * (0.5 + g.width);
    g.width *= 1 + step;
  }
  return sum;
}

}  // namespace airlight::test
