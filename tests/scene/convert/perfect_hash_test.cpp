#include "scene/convert/perfect_hash.h"

#include <catch2/catch.hpp>
#include <set>

#include "scene/base/error.h"
#include "scene/convert/hashed_sequence.h"
#include "scene/math/random.h"

namespace airlight::scene {
namespace {

using Eigen::Vector3i;
using Offsets = HashOptions::Offsets;

std::uint32_t word(std::uint32_t i, std::uint32_t set) { return philox4x32_10({i, set, 0, 0}, {77, 1})[0]; }

// Each position of the domain with the probability given, values 1 to 127 with either sign.
std::vector<HashedVoxel> random_voxels(const Vector3i& extent, double share, std::uint32_t set) {
  std::vector<std::int8_t> levels(std::size_t(extent.prod()));
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::uint32_t w = word(std::uint32_t(i), set);
    if (uniform32(w) < share) levels[i] = std::int8_t(1 + w % 127) * (w & 1024 ? 1 : -1);
  }
  return hashed_voxels(extent, levels);
}

}  // namespace

TEST_CASE("hashes of random sets are perfect, whatever their density and shape", "[residual]") {
  const Vector3i extents[] = {{1, 1, 1}, {7, 1, 1}, {2, 3, 5}, {16, 16, 16}, {40, 7, 23}, {1, 300, 2}, {31, 31, 31}};
  std::uint32_t set = 0;
  for (const Vector3i& extent : extents)
    for (const double share : {0.001, 0.02, 0.15, 0.5, 0.9, 1.0})
      for (const Offsets offsets : {Offsets::thirds, Offsets::root_thirds, Offsets::sixths}) {
        const auto voxels = random_voxels(extent, share, ++set);
        INFO(extent.transpose() << ", share " << share << ", offsets " << int(offsets));
        const PerfectHash hash = perfect_hash(extent, voxels, {offsets, set});
        CHECK(imperfection(hash, voxels) == "");
        CHECK(std::size_t(hash.m) * hash.m * hash.m >= voxels.size());
        CHECK(perfect_hash(extent, voxels, {offsets, set}).offsets == hash.offsets);
      }
}

TEST_CASE("hashes of none, one, two and all, and domains larger than m r", "[residual]") {
  const PerfectHash none = perfect_hash({64, 64, 64}, {});
  CHECK(none.m == 0);
  CHECK(none.bytes_with_tags() == 0);
  CHECK(none.bytes_with_domain() == 0);
  CHECK(none.value_by_tag({3, 4, 5}) == 0);
  CHECK(none.value_by_domain({3, 4, 5}) == 0);
  CHECK(imperfection(none, {}) == "");

  // One in 384^3 does not take 384^3 offsets.
  const PerfectHash one = perfect_hash({384, 384, 384}, {{{383, 0, 200}, -5}});
  CHECK(one.m == 1);
  CHECK(one.r == 10);
  CHECK(one.value_by_tag({383, 0, 200}) == -5);
  CHECK(one.value_by_domain({383, 0, 200}) == -5);
  CHECK(one.value_by_tag({373, 0, 200}) == 0);
  CHECK(one.value_by_domain({373, 0, 200}) == 0);
  for (const Vector3i& outside : {Vector3i(384, 0, 0), Vector3i(-1, 2, 2), Vector3i(383, 0, 200 + 384)}) {
    CHECK(one.value_by_tag(outside) == 0);
    CHECK(one.value_by_domain(outside) == 0);
  }

  // Two that m = 2 and r = 11 would take for each other.
  const std::vector<HashedVoxel> two = {{{0, 0, 0}, 1}, {{22, 0, 0}, 2}};
  const PerfectHash pair = perfect_hash({64, 2, 2}, two);
  CHECK(imperfection(pair, two) == "");
  CHECK(pair.r > 11);
  CHECK(22 % pair.r != 0);

  // 300 voxels along a line of 100000: m r = 7 * 17 is far less.
  std::vector<HashedVoxel> line;
  std::set<int> taken;
  for (std::uint32_t i = 0; line.size() < 300; ++i)
    if (const int x = int(word(i, 999) % 100000); taken.insert(x).second) line.push_back({{x, 0, 0}, 7});
  const PerfectHash sparse = perfect_hash({100000, 1, 1}, line);
  CHECK(imperfection(sparse, line) == "");

  const auto all = random_voxels({32, 32, 32}, 2, 5);
  REQUIRE(all.size() == 32768);
  const PerfectHash dense = perfect_hash({32, 32, 32}, all);
  CHECK(dense.m == 32);
  CHECK(imperfection(dense, all) == "");
}

TEST_CASE("the checker of hashes sees what is wrong", "[residual]") {
  const auto voxels = random_voxels({12, 12, 12}, 0.3, 3);
  const PerfectHash good = perfect_hash({12, 12, 12}, voxels);
  REQUIRE(imperfection(good, voxels) == "");
  const std::size_t slot = good.slot(voxels[5].position);
  PerfectHash bad = good;
  bad.values[slot] = std::int8_t(bad.values[slot] ^ 1);
  CHECK(imperfection(bad, voxels) != "");
  bad = good;
  bad.tags[slot] ^= 1;
  CHECK(imperfection(bad, voxels) != "");
  bad = good;
  bad.domain[3] ^= 1;
  CHECK(imperfection(bad, voxels) != "");
  bad = good;
  bad.offsets[good.offset_slot(voxels[5].position)] ^= 1;
  CHECK(imperfection(bad, voxels) != "");
  bad = good;
  ++bad.voxels;
  CHECK(imperfection(bad, voxels) != "");
}

TEST_CASE("what is no set of voxels is refused", "[residual]") {
  CHECK_THROWS_WITH(perfect_hash({4, 4, 4}, {{{4, 0, 0}, 1}}), "voxel (4, 0, 0) outside the domain of 4 x 4 x 4");
  CHECK_THROWS_WITH(perfect_hash({4, 4, 4}, {{{0, -1, 0}, 1}}), "voxel (0, -1, 0) outside the domain of 4 x 4 x 4");
  CHECK_THROWS_WITH(perfect_hash({4, 4, 4}, {{{1, 2, 3}, 0}}), "voxel (1, 2, 3) has the value 0, expected another");
  CHECK_THROWS_WITH(perfect_hash({4, 4, 4}, {{{1, 2, 3}, 1}, {{1, 2, 3}, 2}}), "voxel (1, 2, 3) is given twice");
  CHECK_THROWS_AS(perfect_hash({2048, 2048, 1024}, {}), Error);
  CHECK_THROWS_AS(perfect_hash({-1, 2, 2}, {}), Error);
}

TEST_CASE("sizes of hashes are counted as they are stored", "[residual]") {
  // 40632 of 64^3: the row "400, 0" of the table, 279 k with tags and 183 k with domain bits.
  std::vector<HashedVoxel> voxels;
  std::set<std::uint32_t> taken;
  for (std::uint32_t i = 0; voxels.size() < 40632; ++i)
    if (const std::uint32_t at = word(i, 4) % 262144; taken.insert(at).second)
      voxels.push_back({{int(at % 64), int(at / 64 % 64), int(at / 4096)}, 1});
  const PerfectHash hash = perfect_hash({64, 64, 64}, voxels);
  CHECK(hash.m == 35);
  CHECK(hash.r == 33);
  CHECK(hash.retries == 0);
  CHECK(hash.bytes_with_tags() == 4 * 42875 + 3 * 35937);
  CHECK(hash.bytes_with_domain() == 42875 + 3 * 35937 + 32768);
  CHECK(imperfection(hash, voxels) == "");
}

TEST_CASE("a sequence lies in one hash for 27 frames", "[residual]") {
  const Vector3i size(6, 5, 7);
  std::vector<std::vector<std::int8_t>> frames;
  for (std::uint32_t f = 0; f < 30; ++f) {
    frames.emplace_back(std::size_t(size.prod()));
    if (f != 11)  // an empty frame among others
      for (const HashedVoxel& v : random_voxels(size, 0.2, 100 + f))
        frames.back()[std::size_t(v.position[0] + size[0] * (v.position[1] + size[1] * v.position[2]))] = v.value;
  }
  const HashedSequence sequence = hashed_sequence(size, frames);
  REQUIRE(sequence.tables.size() == 2);
  CHECK(sequence.tables[0].extent == Vector3i(18, 15, 21));
  int wrong = 0;
  for (int f = 0; f < 30; ++f)
    for (int z = -1; z <= size[2]; ++z)
      for (int y = -1; y <= size[1]; ++y)
        for (int x = -1; x <= size[0]; ++x) {
          const bool in = x >= 0 && y >= 0 && z >= 0 && x < size[0] && y < size[1] && z < size[2];
          const int expected = in ? frames[std::size_t(f)][std::size_t(x + size[0] * (y + size[1] * z))] : 0;
          wrong += sequence.value(f, {x, y, z}) != expected;
        }
  CHECK(wrong == 0);
  CHECK(hashed_sequence(size, {}).tables.empty());
}

}  // namespace airlight::scene
