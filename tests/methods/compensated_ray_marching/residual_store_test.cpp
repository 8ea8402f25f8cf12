// Stores of a residual: the same between samples, at borders and beyond them, whatever it lies in.
#include "methods/compensated_ray_marching/residual_store.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/math/random.h"

namespace residual_store_test {

using namespace airlight;
using namespace airlight::compensated_ray_marching;

namespace {

// A residual on a rotated grid; `empty`: parts of the grid have no level at all.
scene::Residual rough(const Eigen::Vector3i& size, bool clamped, bool empty = false) {
  scene::Residual residual;
  residual.layout.size = size;
  residual.layout.origin_index = {3, -2, 1};
  residual.layout.voxel_size = 0.2;
  residual.layout.rotation = Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  residual.layout.translation = {-1, -0.4, -0.8};
  residual.layout.clamp_border = clamped;
  std::vector<double> values;
  for (int i = 0; i < size.prod(); ++i) values.push_back(empty || i % size[0] > 13 ? 0 : std::cos(0.37 * i * i));
  const scene::ResidualLevels levels = scene::quantised(size, values, {20, 0.01});
  residual.step = levels.step;
  residual.bricks = scene::bricks_of(size, levels.values);
  return residual;
}

}  // namespace

TEST_CASE("stores of a residual: the same everywhere", "[compensated_ray_marching][residual]") {
  for (const Eigen::Vector3i& size : {Eigen::Vector3i(1, 1, 1), {2, 3, 5}, {1, 9, 1}, {31, 16, 17}})
    for (const bool clamped : {false, true}) {
      const scene::Residual residual = rough(size, clamped);
      const StoredResidual grid(residual, ResidualStore::grid), bricks(residual, ResidualStore::bricks),
          hash(residual, ResidualStore::hash), any(residual, ResidualStore::automatic);
      CHECK(bricks.bricks());
      CHECK(hash.hash());
      CHECK(grid.levels() == bricks.levels());
      CHECK(hash.levels() == bricks.levels());
      if (clamped) CHECK(grid.levels()[0] == levels_of(residual.bricks)[0]);
      int seen = 0;
      for (std::uint32_t i = 0; i < 4000; ++i) {
        const PhiloxCounter w = philox4x32_10({i, 0, 0, 0}, {2008, 3});
        Point3 sample;
        for (int a = 0; a < 3; ++a) {
          sample[a] = (size[a] + 3) * uniform32(w[std::size_t(a)]) - 2;
          if (i % 4 == 0) sample[a] = std::round(2 * sample[a]) / 2;  // samples, borders, between them
        }
        const Point3 x = sample_to_world(residual.layout, sample);
        const double value = bricks.at(x);
        CAPTURE(size.transpose(), clamped, sample.transpose());
        REQUIRE(hash.at(x) == Approx(value).epsilon(1e-13).margin(1e-14));
        // Error of levels of up to 127 steps, each rounded to a float.
        REQUIRE(std::abs(grid.at(x) - value) <= 127 * residual.step * std::exp2(-24));
        REQUIRE(any.at(x) == grid.at(x));
        seen += value != 0;
      }
      CHECK(seen > 50);
      CHECK(bricks.at(sample_to_world(residual.layout, Point3(-1.5, 0, 0))) == 0);
    }
}

TEST_CASE("stores of a residual: without any level", "[compensated_ray_marching][residual]") {
  const scene::Residual residual = rough({4, 5, 6}, true, true);
  for (const ResidualStore store : {ResidualStore::grid, ResidualStore::bricks, ResidualStore::hash})
    for (const double s : {-0.5, 0.0, 1.3, 3.0})
      CHECK(StoredResidual(residual, store).at(sample_to_world(residual.layout, Point3(s, s, s))) == 0);
}

}  // namespace residual_store_test
