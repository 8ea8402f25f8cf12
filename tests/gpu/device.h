// The device of the tests, or a test that says why it is skipped.
#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "gpu/context.h"
#include "scene/base/error.h"

namespace airlight::gpu::test {

// Null where there is no OpenGL 4.5 device at all, after the line that ctest knows as "skipped".
inline Context* device() {
  try {
    return &Context::get();
  } catch (const Unavailable& reason) {
    WARN("test skipped: no device: " << reason.what());
    return nullptr;
  }
}

// Relative error that AIRLIGHT_GPU_ULPS puts into exp, log, sqrt, sin and cos; 0 without it. For bounds close to rounding.
inline double injected_error() {
  const char* ulps = std::getenv("AIRLIGHT_GPU_ULPS");
  return ulps ? std::atof(ulps) * std::exp2(-23) : 0;
}

}  // namespace airlight::gpu::test
