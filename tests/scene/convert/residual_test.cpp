#include "scene/convert/residual.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "scene/base/content_key.h"
#include "scene/base/error.h"
#include "scene/convert/gaussian_samples.h"
#include "scene/convert/perfect_hash.h"
#include "scene/convert/residual_file.h"
#include "scene/math/random.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace airlight::scene {
namespace {

using Eigen::Vector3i;

// Smoke: two soft blobs with ripples, 0 in the corners.
VoxelGrid smoke(const Vector3i& size) {
  VoxelGrid grid;
  grid.size = size;
  grid.origin_index = {-3, 1, 7};
  grid.voxel_size = 1.0 / size.maxCoeff();
  grid.rotation = Eigen::AngleAxisd(0.3, Vec3(1, 2, 2).normalized()).toRotationMatrix();
  grid.translation = {0.5, -0.25, 2};
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) {
        const Vec3 p = (Vec3(x, y, z) + Vec3::Constant(0.5)) / size.maxCoeff();
        const double blob = std::exp(-12 * (p - Vec3(0.4, 0.5, 0.5)).squaredNorm());
        grid.values.push_back(float(std::max(0.0, blob * (1 + 0.3 * std::sin(20 * p[0] + 9 * p[1])) - 0.2)));
      }
  return grid;
}

VoxelGrid constant(const Vector3i& size, float value) {
  VoxelGrid grid = smoke(size);
  std::fill(grid.values.begin(), grid.values.end(), value);
  return grid;
}

// One in the middle of the grid.
GaussianSum one_for(const VoxelGrid& grid, double width_in_voxels) {
  GaussianSum sum;
  sum.cutoff = 3;
  const Point3 middle = sample_to_world(grid, 0.5 * (grid.size - Vector3i::Ones()).cast<double>());
  sum.gaussians = {{middle, width_in_voxels * grid.voxel_size, 0.8}};
  return sum;
}

double greatest_difference(const VoxelGrid& a, const VoxelGrid& b) {
  REQUIRE(a.values.size() == b.values.size());
  double most = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) most = std::max(most, std::abs(double(a.values[i]) - b.values[i]));
  return most;
}

std::string refusal(const std::string& bytes) {
  const std::string what = test::message_of([&] { residual_from_bytes(bytes); });
  CHECK(what.size() < 200);
  return what;
}

// With the checksum that it ought to have.
std::string sealed(std::string bytes) {
  bytes.resize(bytes.size() - 32);
  return bytes + content_key(bytes);
}

}  // namespace

TEST_CASE("Gaussians and residual give the grid back to half a level", "[residual]") {
  for (const Vector3i& size : {Vector3i(24, 20, 17), Vector3i(1, 1, 1), Vector3i(2, 3, 5), Vector3i(1, 9, 1)}) {
    const VoxelGrid grid = smoke(size);
    const GaussianSum sum = one_for(grid, 4);
    for (const int threshold : {0, 1, 2, 20}) {
      const Residual residual = residual_of(grid, sum, {threshold, {}});
      const double bound = residual.step * (threshold + 0.5) * (1 + 1e-6) + 1e-6;
      CHECK(greatest_difference(decoded(sum, residual), grid) <= bound);
      CHECK(residual.threshold == threshold);
    }
  }
}

TEST_CASE("an exact residual gives the original back bit for bit", "[residual]") {
  VoxelGrid grid = smoke({16, 16, 16});
  const GaussianSum sum = one_for(grid, 5);
  VoxelGrid layout = grid;
  layout.values.clear();
  grid.values = gaussian_samples(sum, layout);
  for (std::size_t i = 0; i < grid.values.size(); ++i) grid.values[i] += 0.25f * float(i % 5);  // levels of 0.25
  const Residual residual = residual_of(grid, sum, {0, 0.25});
  CHECK(residual.step == 0.25);
  const VoxelGrid back = decoded(sum, residual);
  CHECK(back.values == grid.values);
  CHECK(back.size == grid.size);
  CHECK(back.origin_index == grid.origin_index);
  CHECK(back.rotation == grid.rotation);
  CHECK(back.voxel_size == grid.voxel_size);
  CHECK(back.translation == grid.translation);
}

// Rows 18 to 20 of the stress list.
TEST_CASE("a threshold leaves out the levels up to it", "[residual]") {
  QuantisationOptions options;
  options.step = 0.5;
  options.threshold = 3;
  const ResidualLevels levels = quantised({8, 1, 1}, {80, 1.5, -1.5, 2, -2, 1.74, 1.76, 0.2}, options);
  CHECK(levels.step == 0.5);
  CHECK(levels.values == std::vector<std::int8_t>{127, 0, 0, 4, -4, 0, 4, 0});
}

TEST_CASE("constant density, no residual, a dense one, one voxel and two", "[residual]") {
  const VoxelGrid full = constant({12, 12, 12}, 1.5f);
  for (const GaussianSum& sum : {one_for(full, 4), GaussianSum{}}) {
    const Residual r = residual_of(full, sum, {});
    CHECK(greatest_difference(decoded(sum, r), full) <= r.step / 2 + 1e-6);
  }
  const GaussianSum none;
  const Residual dense = residual_of(full, none, {});
  CHECK(dense.bricks.kept() == 8);
  CHECK(decoded(none, dense).values == full.values);

  const VoxelGrid empty = constant({12, 12, 12}, 0);
  const Residual zero = residual_of(empty, none, {});
  CHECK(zero.step == 0);
  CHECK(zero.bricks.kept() == 0);
  CHECK(decoded(none, zero).values == empty.values);
  CHECK(hashed_voxels(empty.size, levels_of(zero.bricks)).empty());

  for (const int count : {1, 2}) {
    VoxelGrid few = empty;
    for (int i = 0; i < count; ++i) few.values[std::size_t(700 + 501 * i)] = 3;
    const Residual r = residual_of(few, none, {});
    CHECK(hashed_voxels(few.size, levels_of(r.bricks)).size() == std::size_t(count));
    CHECK(decoded(none, r).values == few.values);
  }

  VoxelGrid nothing = smoke({1, 1, 1});
  nothing.size.setZero();
  nothing.values.clear();
  const Residual r = residual_from_bytes(residual_bytes(residual_of(nothing, none, {})));
  CHECK(decoded(none, r).values.empty());
}

TEST_CASE("negative sums are clamped, denormal Gaussians count as none", "[residual]") {
  // A negative residual larger than its levels can hold: the density stays at 0.
  VoxelGrid grid = smoke({8, 8, 8});
  std::fill(grid.values.begin(), grid.values.end(), 0.0f);
  GaussianSum sum = one_for(grid, 4);
  const Residual small = residual_of(grid, sum, {0, 1e-3});
  const VoxelGrid back = decoded(sum, small);
  CHECK(*std::min_element(back.values.begin(), back.values.end()) >= 0);
  CHECK(levels_of(small.bricks)[4 + 8 * (4 + 8 * 4)] == -127);

  // Row 28: where the sum is denormal it is 0, coded and decoded.
  sum.cutoff = infinity;
  sum.gaussians[0].amplitude = 1e-39;
  const VoxelGrid tiny = decoded(sum, residual_of(grid, sum, {}));
  CHECK(*std::max_element(tiny.values.begin(), tiny.values.end()) == 0);
}

TEST_CASE("empty samples can be kept empty, whatever the threshold", "[residual]") {
  const VoxelGrid grid = smoke({20, 20, 20});
  for (const double width : {3.0, 6.0, 12.0}) {
    const GaussianSum sum = one_for(grid, width);
    for (const int threshold : {0, 2, 20}) {
      const Residual plain = residual_of(grid, sum, {threshold, {}, false});
      const Residual kept = residual_of(grid, sum, {threshold, {}, true});
      CHECK(kept.step == plain.step);
      const VoxelGrid a = decoded(sum, plain), b = decoded(sum, kept);
      int empty = 0, left = 0, filled = 0, differ = 0;
      for (std::size_t i = 0; i < grid.values.size(); ++i)
        if (grid.values[i] == 0)
          empty += b.values[i] == 0, left += a.values[i] > 0, filled += b.values[i] > 0;
        else
          differ += a.values[i] != b.values[i];
      CHECK(empty > 1000);
      CHECK(left > 10);
      CHECK(filled == 0);
      CHECK(differ == 0);
    }
  }
}

TEST_CASE("what cannot be quantised is refused with its place", "[residual]") {
  std::vector<double> values(24, 0.5);
  values[1 + 2 * (2 + 3 * 3)] = std::nan("");
  CHECK_THROWS_WITH(quantised({2, 3, 4}, values, {}), "residual nan at sample (1, 2, 3), expected a finite number");
  values[0] = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(quantised({2, 3, 4}, values, {}), "residual inf at sample (0, 0, 0), expected a finite number");
  CHECK_THROWS_WITH(quantised({2, 3, 5}, values, {}), "a residual of 24 values, expected 2 x 3 x 5");
  CHECK_THROWS_WITH(quantised({1, 1, 1}, {0}, {127, {}}), "threshold = 127, expected 0 to 126 levels");
  CHECK_THROWS_WITH(quantised({1, 1, 1}, {0}, {0, 0.0}), "step = 0, expected a density above 0");
}

TEST_CASE("bricks hold the levels they were cut from", "[residual]") {
  for (const Vector3i& size : {Vector3i(1, 1, 1), Vector3i(8, 8, 8), Vector3i(9, 17, 3), Vector3i(30, 1, 25)})
    for (const int edge : {1, 4, 8}) {
      std::vector<std::int8_t> levels(std::size_t(size.prod()));
      for (std::size_t i = 0; i < levels.size(); ++i) {
        const std::uint32_t w = philox4x32_10({std::uint32_t(i), std::uint32_t(edge), 0, 0}, {5, 1})[0];
        if (w % 16 == 0) levels[i] = std::int8_t(int(w >> 8) % 128 - 64);
      }
      const ResidualBricks bricks = bricks_of(size, levels, edge);
      CHECK(levels_of(bricks) == levels);
      CHECK(bricks.level({-1, 0, 0}) == 0);
      CHECK(bricks.level({0, size[1], 0}) == 0);
      CHECK(bricks.bytes() == 4 * bricks.index.size() + bricks.kept() * std::size_t(edge * edge * edge));
    }
}

TEST_CASE("bricks with an apron interpolate as the grid does", "[residual]") {
  const Vector3i size(19, 8, 15);
  VoxelGrid grid;
  grid.size = size;
  std::vector<std::int8_t> levels(std::size_t(size.prod()));
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = std::int8_t(i * 37 % 5 == 0 ? i % 120 : 0);
  for (const std::int8_t level : levels) grid.values.push_back(level);
  const ApronBricks bricks = apron_bricks_of(size, levels);
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const PhiloxCounter w = philox4x32_10({i, 0, 0, 0}, {9, 1});
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = -2 + (size[a] + 3) * uniform32(w[std::size_t(a)]);
    if (i % 3 == 0) p = p.array().round();
    CHECK(level_between(bricks, p) == Approx(density_at_sample(grid, p)).margin(1e-12));
  }
  CHECK(apron_bricks_of({0, 0, 0}, {}).index.empty());
  CHECK(level_between(apron_bricks_of({0, 0, 0}, {}), {0, 0, 0}) == 0);
}

TEST_CASE("residual files come back as they were", "[residual]") {
  const TemporaryFolder folder;
  VoxelGrid grid = smoke({21, 16, 9});
  grid.clamp_border = true;
  const GaussianSum sum = one_for(grid, 3);
  const Residual r = residual_of(grid, sum, {2, {}});
  write_residual(folder.file("r.residual"), r);
  const Residual back = read_residual(folder.file("r.residual"));
  CHECK(residual_bytes(back) == residual_bytes(r));
  CHECK(back.layout.clamp_border);
  CHECK(back.layout.rotation == grid.rotation);
  CHECK(back.layout.origin_index == grid.origin_index);
  CHECK(back.cutoff == 3);
  CHECK(back.threshold == 2);
  CHECK(back.step == r.step);
  CHECK(levels_of(back.bricks) == levels_of(r.bricks));
  CHECK(decoded(sum, back).values == decoded(sum, r).values);
  GaussianSum other = sum;
  other.gaussians[0].amplitude *= 1 + 1e-15;
  CHECK_THROWS_WITH(decoded(other, back), "the residual is of other Gaussians");
  other = sum;
  other.cutoff = infinity;
  CHECK_THROWS_WITH(decoded(other, back), "the residual is of other Gaussians");
}

TEST_CASE("damaged residual files are refused in one line", "[residual]") {
  const VoxelGrid grid = smoke({9, 8, 8});
  const std::string good = residual_bytes(residual_of(grid, one_for(grid, 3), {}));
  REQUIRE(refusal(good) == "");
  for (std::size_t length = 0; length < good.size(); ++length) CHECK(refusal(good.substr(0, length)) != "");
  CHECK(refusal(good + "x") != "");
  for (std::size_t i = 0; i < good.size(); ++i)
    for (const int bit : {0, 5, 7}) {
      std::string bad = good;
      bad[i] = char(bad[i] ^ 1 << bit);
      CHECK(refusal(bad) != "");
    }
  CHECK_THAT(refusal("airlight residual 2\n" + good.substr(20)), Catch::Contains("does not begin with"));
}

TEST_CASE("sealed residual files with impossible numbers are refused before anything is made of them", "[residual]") {
  const VoxelGrid grid = smoke({9, 8, 8});
  const std::string good = residual_bytes(residual_of(grid, one_for(grid, 3), {}));
  const auto with = [&](std::size_t at, auto value) {
    std::string bad = good;
    std::memcpy(bad.data() + 20 + at, &value, sizeof value);
    return refusal(sealed(bad));
  };
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  REQUIRE(with(0, std::int32_t(9)) == "");
  for (const std::int32_t size : {0, -1, 65, 1 << 30, std::numeric_limits<std::int32_t>::min(), 2147483647})
    CHECK(with(0, size) != "");
  CHECK(with(0, std::uint64_t(0x7fffffff7fffffff)) != "");
  CHECK(with(24, std::int32_t(2)) != "");    // clamp_border
  CHECK(with(28, std::int32_t(127)) != "");  // threshold
  CHECK(with(32, nan) != "");                // rotation
  CHECK(with(32, 2.0) != "");                // no rotation
  CHECK(with(104, nan) != "");               // voxel size
  CHECK(with(104, 0.0) != "");
  CHECK(with(112, inf) != "");  // translation
  CHECK(with(136, nan) != "");  // cutoff
  CHECK(with(136, -3.0) != "");
  CHECK(with(144, nan) != "");  // step
  CHECK(with(144, 1e21) != "");
  CHECK(with(152, 'G') != "");     // key
  CHECK(with(184, '\xff') != "");  // three bricks follow where there are two
  CHECK(with(190, '\x80') == "not a residual that can be read: it has a level of -128, expected -127 to 127");
}

}  // namespace airlight::scene
