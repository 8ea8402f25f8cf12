// Textures of voxels: what goes in comes out, and how each failure is told.
#include "gpu/texture_3d.h"

#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "tests/gpu/device.h"

namespace texture_3d_test {

using namespace airlight;
using namespace airlight::gpu;

namespace {

std::vector<float> numbers(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = 1e-3f * float(i * 7919 % 65521) - 20;  // all digits are used
  values.back() = 1e-40f;  // no half, no denormal lost
  return values;
}

}  // namespace

DEVICE_TEST_CASE("a texture gives back the bits it was given", "[gpu]") {
  Texture3D one(context, "one", {13, 5, 7});
  const std::vector<float> values = numbers(13 * 5 * 7);
  one.upload(values);
  CHECK(one.bytes() == values.size() * 4);
  CHECK(one.download() == values);
  // Slice by slice the same, and x is fastest.
  Texture3D sliced(context, "sliced", {13, 5, 7});
  sliced.upload(
      [&](int z, std::vector<float>& slice) { slice.assign(values.begin() + z * 65, values.begin() + (z + 1) * 65); });
  CHECK(sliced.download() == values);
  Texture3D four(context, "four", {3, 4, 5}, Texture3D::Format::rgba32f);
  const std::vector<float> colours = numbers(3 * 4 * 5 * 4);
  four.upload(colours);
  CHECK(four.download() == colours);
}

DEVICE_TEST_CASE("a texture that is too large, or has no room, is refused in one line", "[gpu]") {
  const int most = context.limits().texture_size_3d;
  CHECK(most >= 2048);  // OpenGL 4.5
  CHECK_THROWS_AS(Texture3D(context, "long", {most + 1, 1, 1}), Unavailable);
  CHECK_THROWS_WITH(Texture3D(context, "long", {1, 1, most + 1}),
                    Catch::Contains("texture 'long' needs 1 x 1 x ") && Catch::Contains("offers at most"));
  CHECK_NOTHROW(Texture3D(context, "long", {most, 1, 1}));
  CHECK_THROWS_WITH(Texture3D(context, "empty", {0, 1, 1}), Catch::Contains("expected 1 or more"));
  // 128 GiB on the smallest device, 64 TiB on others.
  CHECK_THROWS_AS(Texture3D(context, "giant", {most, most, most}, Texture3D::Format::rgba32f), Unavailable);
  CHECK_THROWS_WITH(Texture3D(context, "giant", {most, most, most}, Texture3D::Format::rgba32f),
                    Catch::Contains("'giant'") && Catch::Contains("MiB") && Catch::Contains("is out of memory"));
  CHECK_NOTHROW(context.check("nothing is left of it"));
  Texture3D small(context, "small", {2, 2, 2});
  CHECK_THROWS_WITH(small.upload(std::vector<float>(9)), Catch::Contains("holds 32 bytes, 36 were given"));
}

}  // namespace texture_3d_test
