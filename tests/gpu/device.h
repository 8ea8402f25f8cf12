// The device of the tests, or a test that says why it is skipped.
#pragma once
#include <catch2/catch.hpp>

#include "gpu/context.h"
#include "scene/error.h"

namespace airlight::gpu::test {

// Null where there is no OpenGL 4.5 device at all, after the line that ctest knows as "skipped".
inline Context* device() {
  try {
    return &Context::get();
  } catch (const Unavailable& reason) {
    WARN("test skipped: " << reason.what());
    return nullptr;
  }
}

}  // namespace airlight::gpu::test
