// Angles in shaders.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/program.h"
#include "tests/gpu/device.h"
#include "tests/gpu/shader_folder.h"

namespace angle_test {

using namespace airlight;

// GLSL's own may have the absolute error of a sine, and none of its digits for a small angle.
DEVICE_TEST_CASE("tangents of small angles on the device", "[gpu]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(R"(layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/angle.glsl"
layout(std430, binding = 0) buffer Values { float values[]; };
void main() { values[gl_GlobalInvocationID.x] = tangent(values[gl_GlobalInvocationID.x]); }
)");
  gpu::Program program(context, "test.comp", {});
  std::vector<float> angles;
  for (float x = 1e-30f; x < 0.47f; x *= 1.01f) angles.insert(angles.end(), {x, -x});
  const gpu::Buffer values(context, "angles", angles);
  values.bind(0);
  program.dispatch(int(angles.size()));
  const std::vector<float> got = values.download<float>();
  double worst = 0;
  for (std::size_t i = 0; i < got.size(); ++i)
    worst = std::max(worst, std::abs(got[i] / std::tan(double(angles[i])) - 1));
  CHECK(worst < 2.5e-7);
}

}  // namespace angle_test
