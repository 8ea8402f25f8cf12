#include "scene/math/random.h"

#include <catch2/catch.hpp>
#include <set>

namespace random_test {

using namespace airlight;

TEST_CASE("uniforms stay strictly inside (0, 1)", "[random]") {
  CHECK(uniform53(0, 0) == 0x1p-53);
  CHECK(uniform53(~0u, ~0u) == 1 - 0x1p-53);
  CHECK(uniform32(0) == 0x1p-33);
  CHECK(uniform32(~0u) == 1 - 0x1p-33);
}

TEST_CASE("a sample's blocks are those of the stated counter and key", "[random]") {
  const std::uint64_t sample = (std::uint64_t(1) << 40) + 5;
  const SampleRandom random(7, 2, 0xffffffffu, sample);
  const std::uint32_t vertex = 0x1234567;
  const RandomBlock block = random.block(vertex, Purpose::connection, 0xabcdef);
  const PhiloxCounter counter = {0x7u << 28 | std::uint32_t(Purpose::connection) << 24 | 0xabcdef, 5, 1u << 8,
                                 0xffffffffu};
  CHECK(block.words == philox4x32_10(counter, {7, 2 + (0x123456u << 8)}));
}

// Distinct (pixel, sample, vertex, purpose, index) have distinct counters or keys, at the ends of every range; as
// Philox is a bijection of the counter for each key, equal blocks under one key would mean equal counters.
TEST_CASE("no two dimensions share their numbers", "[random]") {
  std::set<std::array<std::uint32_t, 4>> seen;
  int made = 0;
  for (const std::uint64_t sample :
       {std::uint64_t(0), std::uint64_t(1), (std::uint64_t(1) << 40) - 1, std::uint64_t(1) << 40})
    for (const std::uint32_t pixel : {0u, 1u, 0xfffffffeu, 0xffffffffu})
      for (const std::uint32_t vertex : {0u, 1u, 15u, 16u, (1u << 28) - 1})
        for (const Purpose purpose : {Purpose::camera, Purpose::flight, Purpose::transmittance})
          for (const std::uint32_t index : {0u, 1u, (1u << 24) - 1}) {
            seen.insert(SampleRandom(1, 0, pixel, sample).block(vertex, purpose, index).words);
            ++made;
          }
  CHECK(int(seen.size()) == made);
}

// Mean and variance of 2^20 uniforms: their standard errors are sqrt(1/12/n) and sqrt(1/180/n). Four figures at 4.5
// standard errors: a false alarm has probability 3e-5, and the seed is fixed.
TEST_CASE("uniforms have the mean and variance of uniforms", "[random]") {
  const int n = 1 << 18;
  double fine = 0, fine2 = 0, coarse = 0, coarse2 = 0;
  for (int i = 0; i < n; ++i) {
    const RandomBlock block = SampleRandom(3, 1, 9, i).block(2, Purpose::scatter);
    const RandomBlock other = SampleRandom(3, 1, 9, i).block(2, Purpose::light);
    for (int k = 0; k < 2; ++k) {
      fine += block.fine(k) - 0.5;
      fine2 += std::pow(block.fine(k) - 0.5, 2) - 1.0 / 12;
    }
    for (int k = 0; k < 4; ++k) {
      coarse += other.coarse(k) - 0.5;
      coarse2 += std::pow(other.coarse(k) - 0.5, 2) - 1.0 / 12;
    }
  }
  CHECK(std::abs(fine) / std::sqrt(2 * n / 12.0) < 4.5);
  CHECK(std::abs(coarse) / std::sqrt(4 * n / 12.0) < 4.5);
  CHECK(std::abs(fine2) / std::sqrt(2 * n / 180.0) < 4.5);
  CHECK(std::abs(coarse2) / std::sqrt(4 * n / 180.0) < 4.5);
}

}  // namespace random_test
