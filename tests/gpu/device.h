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

// A test case that needs a device, whose body has it as `context`; skipped, with the line that ctest knows, where there is none.
#define DEVICE_TEST_CASE(...) DEVICE_TEST_CASE_OF(INTERNAL_CATCH_UNIQUE_NAME(body_on_device_), __VA_ARGS__)
#define DEVICE_TEST_CASE_OF(body, ...)                                                   \
  static void body(airlight::gpu::Context&);                                             \
  TEST_CASE(__VA_ARGS__) {                                                               \
    if (airlight::gpu::Context* context = airlight::gpu::test::device()) body(*context); \
  }                                                                                      \
  static void body([[maybe_unused]] airlight::gpu::Context& context)
