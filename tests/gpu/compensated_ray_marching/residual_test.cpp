// Residuals decoded on the device: the same levels as on the processor, bit for bit, and the same between them to rounding.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/compensated_ray_marching/residual_store.h"
#include "scene/convert/hashed_sequence.h"
#include "scene/math/random.h"
#include "tests/gpu/device.h"

namespace residual_test {

using namespace airlight;
using namespace airlight::gpu;
using namespace airlight::gpu::compensated_ray_marching;
using Eigen::Vector3i;
using Membership = ResidualOnDevice::Membership;

namespace {

// Levels from -127 to 127, that share of them not 0.
std::vector<std::int8_t> random_levels(const Vector3i& size, double share, std::uint32_t set) {
  std::vector<std::int8_t> levels(std::size_t(size.prod()));
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const PhiloxCounter w = philox4x32_10({std::uint32_t(i), set, 0, 0}, {31, 1});
    if (uniform32(w[0]) < share) levels[i] = std::int8_t(int(w[1] % 255) - 127);
  }
  return levels;
}

int level_at(const Vector3i& size, const std::vector<std::int8_t>& levels, const Vector3i& p) {
  if ((p.array() < 0).any() || (p.array() >= size.array()).any()) return 0;
  return levels[std::size_t(p[0] + size[0] * (p[1] + size[1] * p[2]))];
}

// How many samples in and around the frame are another level than the one stored.
int wrong_levels(Context& context, const ResidualOnDevice& residual, const Vector3i& size,
                 const std::vector<std::int8_t>& levels) {
  const Vector3i first(-3, -2, -9), box = size + Vector3i(7, 5, 19);
  const std::vector<int> got = levels_on_device(context, residual, first, box);
  REQUIRE(got.size() == std::size_t(box.prod()));
  int wrong = 0;
  for (int i = 0; i < box.prod(); ++i)
    wrong += got[std::size_t(i)] !=
             level_at(size, levels, first + Vector3i(i % box[0], i / box[0] % box[1], i / box[0] / box[1]));
  return wrong;
}

// The largest difference to the processor between samples, in levels.
double worst_between(Context& context, const ResidualOnDevice& residual, const Vector3i& size,
                     const scene::ApronBricks& bricks) {
  std::vector<Eigen::Vector4f> points;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const PhiloxCounter w = philox4x32_10({i, 0, 0, 0}, {32, 1});
    Eigen::Vector4f p = Eigen::Vector4f::Zero();
    for (int a = 0; a < 3; ++a) p[a] = float(-2 + (size[a] + 3) * uniform32(w[std::size_t(a)]));
    if (i % 4 == 0) p = p.array().round();
    points.push_back(p);
  }
  const std::vector<float> got = levels_between_on_device(context, residual, points);
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    worst = std::max(worst, std::abs(got[i] - level_between(bricks, points[i].head<3>().cast<double>())));
  return worst;
}

}  // namespace

DEVICE_TEST_CASE("grids, bricks and hashes decode on the device to the processor's levels", "[gpu][residual]") {
  const Use use(context);
  std::uint32_t set = 0;
  for (const Vector3i& size : {Vector3i(1, 1, 1), Vector3i(8, 8, 8), Vector3i(7, 15, 16), Vector3i(33, 9, 20)})
    for (const double share : {0.0, 0.002, 0.15, 1.0}) {
      const auto levels = random_levels(size, share, ++set);
      const auto bricks = scene::apron_bricks_of(size, levels);
      const auto hash = scene::perfect_hash(size, scene::hashed_voxels(size, levels));
      INFO(size.transpose() << ", share " << share);
      const ResidualOnDevice kinds[] = {{context, size, levels},
                                        {context, size, bricks},
                                        {context, size, hash, Membership::tags},
                                        {context, size, hash, Membership::domain}};
      for (const ResidualOnDevice& residual : kinds) {
        CHECK(wrong_levels(context, residual, size, levels) == 0);
        // Products and sums of numbers up to 254 along three axes, of a place that is rounded to 2^-23 of up to 64.
        CHECK(worst_between(context, residual, size, bricks) <= 3 * 254 * 64 * std::exp2(-23));
      }
    }
}

DEVICE_TEST_CASE("a frame of a sequence decodes on the device, tags wider than 24 bits", "[gpu][residual]") {
  const Use use(context);
  const Vector3i size(90, 90, 90);  // 270^3 > 2^24
  std::vector<std::vector<std::int8_t>> frames;
  for (std::uint32_t f = 0; f < 27; ++f) frames.push_back(random_levels(size, f == 13 ? 0 : 0.001, 200 + f));
  const auto sequence = scene::hashed_sequence(size, frames);
  REQUIRE(sequence.tables.size() == 1);
  for (const int frame : {0, 13, 14, 26})
    for (const Membership membership : {Membership::tags, Membership::domain}) {
      const ResidualOnDevice residual(context, size, sequence.tables[0], membership,
                                      scene::HashedSequence::tile(size, frame));
      CHECK(wrong_levels(context, residual, size, frames[std::size_t(frame)]) == 0);
    }
}

}  // namespace residual_test
