// Frames of smoke as Gaussians: who they are from frame to frame, frames without smoke.
#include <catch2/catch.hpp>

#include "scene/convert/gaussian_fit.h"
#include "scene/convert/gaussian_samples.h"
#include "tests/scene/convert/fitted_grids.h"

namespace fitted_sequence_test {

using namespace airlight;
using namespace airlight::scene;
using namespace airlight::test;

TEST_CASE("Gaussians keep who they are from frame to frame", "[gaussian_fit][convert]") {
  FitOptions o = options(80);
  const GaussianFit first = fit_gaussians(smoke(24), o);
  for (const bool resent : {false, true}) {
    o.resent = resent;
    GaussianFit fit = first;
    for (int frame = 1; frame < 4; ++frame) {
      const GaussianFit next = next_fit(smoke(24, 0.3 * frame), fit, o);
      CAPTURE(resent, frame, next.errors.squared_ratio, next.inserted, next.teleported);
      CHECK(next.warm);
      CHECK(next.first_ratio == first.errors.squared_ratio);
      CHECK(next.deleted == 3);
      CHECK(next.ids.size() == fit.ids.size() - 3 + std::size_t(next.inserted));
      if (!resent) CHECK(next.teleported == 0);
      CHECK(next.next_id == fit.next_id + next.inserted + next.teleported);
      std::vector<int> ids = next.ids;
      std::sort(ids.begin(), ids.end());
      CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
      // Gaussians that are in both frames have hardly moved.
      int kept = 0;
      for (std::size_t i = 0; i < next.ids.size(); ++i) {
        const auto before = std::find(fit.ids.begin(), fit.ids.end(), next.ids[i]);
        if (before == fit.ids.end()) continue;
        ++kept;
        const Gaussian& then = fit.sum.gaussians[std::size_t(before - fit.ids.begin())];
        CHECK((then.center - next.sum.gaussians[i].center).norm() < 0.5 * fit_unit(smoke(24)));
      }
      CHECK(kept >= int(fit.ids.size()) - 3 - next.teleported);
      check_bounds(smoke(24, 0.3 * frame), next);
      fit = next;
    }
  }
}

TEST_CASE("an empty frame within a sequence", "[gaussian_fit][convert]") {
  const FitOptions o = options(40);
  const GaussianFit nothing = fit_gaussians(empty_grid(16, 16, 16), o);
  const GaussianFit first = next_fit(smoke(16), nothing, o);
  CHECK_FALSE(first.warm);
  CHECK(first.first_ratio == first.errors.squared_ratio);
  const GaussianFit gap = next_fit(empty_grid(16, 16, 16), first, o);
  CHECK(gap.sum.gaussians.empty());
  CHECK(gap.errors.squared_ratio == 0);
  CHECK(gap.first_ratio == first.first_ratio);
  CHECK(gap.next_id == first.next_id);
  const GaussianFit again = next_fit(smoke(16, 0.1), first, o);
  CHECK(again.warm);
  CHECK(again.errors.squared_ratio < 2 * first.errors.squared_ratio);
}

namespace {

// Two Gaussians as a frame before has left them, far from each other.
GaussianFit two_of(const VoxelGrid& grid, const Gaussian& one, const Gaussian& other) {
  GaussianFit fit;
  fit.sum.cutoff = fit_cutoff;
  for (const Gaussian& g : {one, other})
    fit.sum.gaussians.push_back({sample_to_world(grid, g.center), g.width * grid.voxel_size, g.amplitude});
  fit.ids = {0, 1};
  fit.next_id = 2;
  fit.first_ratio = 1;
  return fit;
}

// The next frame as it begins: nothing is deleted but `deleted`, nothing is moved.
FitOptions begun(int deleted) {
  FitOptions o = options(2);
  o.widths = {0.001, 1};
  o.deleted = deleted;
  o.later_rounds = 0;
  o.polish = false;
  return o;
}

}  // namespace

TEST_CASE("the next frame begins with the Gaussians of the frame before, whatever its greatest density",
          "[gaussian_fit][convert]") {
  VoxelGrid grid = empty_grid(24, 24, 24);
  const GaussianFit before = two_of(grid, {Point3(6, 6, 6), 1.3, 0.9}, {Point3(17, 16, 15), 2, 1.7});
  for (const float scale : {1.0f, 4.0f, 1e5f}) {
    grid.values = gaussian_samples(before.sum, grid);
    grid.values[0] = 2 * scale;
    FitOptions o = begun(0);
    o.amplitudes.lo = 1e-9;
    const GaussianFit next = next_fit(grid, before, o);
    REQUIRE(next.ids == before.ids);
    for (std::size_t i = 0; i < 2; ++i) {
      CAPTURE(scale, i);
      CHECK(next.sum.gaussians[i].amplitude == Approx(before.sum.gaussians[i].amplitude).epsilon(1e-12));
      CHECK(next.sum.gaussians[i].width == Approx(before.sum.gaussians[i].width).epsilon(1e-12));
      CHECK((next.sum.gaussians[i].center - before.sum.gaussians[i].center).norm() < 1e-12);
    }
  }
}

// A Gaussian that is left out adds the sum of its squared samples to the objective: the one with less of it is less significant.
TEST_CASE("the Gaussian that is deleted is the one whose samples have the least sum of squares",
          "[gaussian_fit][convert]") {
  VoxelGrid grid = empty_grid(24, 24, 24);
  // The first has more of amplitude times width (1.3 to 1.17), of its square times the square of the width, and less with the cube.
  for (const auto& [wide, high] : {std::pair(1.95, 0.6), std::pair(2.6, 0.4)}) {
    const GaussianFit before = two_of(grid, {Point3(6, 6, 6), 1.3, 1}, {Point3(17, 16, 15), wide, high});
    double squares[2] = {0, 0};
    for (std::size_t i = 0; i < 2; ++i)
      for (const float value : gaussian_samples({{before.sum.gaussians[i]}, 0, fit_cutoff}, grid))
        squares[i] += double(value) * double(value);
    CAPTURE(wide, squares[0], squares[1]);
    grid.values = gaussian_samples(before.sum, grid);
    const GaussianFit next = next_fit(grid, before, begun(1));
    CHECK(next.deleted == 1);
    CHECK(next.ids == std::vector<int>{squares[0] < squares[1] ? 1 : 0});
  }
}

}  // namespace fitted_sequence_test
