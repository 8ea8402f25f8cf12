// The device of the tests, or a test that says why it is skipped.
#pragma once
#include <catch2/catch.hpp>

#include "gpu/context.h"
#include "gpu/shader_source.h"
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

using gpu::injected_error;

}  // namespace airlight::gpu::test

// A test case that needs a device, whose body has it as `context`; skipped, with the line that ctest knows, where there is none.
#define DEVICE_TEST_CASE(...) DEVICE_TEST_CASE_OF(INTERNAL_CATCH_UNIQUE_NAME(body_on_device_), __VA_ARGS__)
#define DEVICE_TEST_CASE_OF(body, ...)                                                   \
  static void body(airlight::gpu::Context&);                                             \
  TEST_CASE(__VA_ARGS__) {                                                               \
    if (airlight::gpu::Context* context = airlight::gpu::test::device()) body(*context); \
  }                                                                                      \
  static void body([[maybe_unused]] airlight::gpu::Context& context)
