// Frames of smoke as Gaussians: who they are from frame to frame, frames without smoke.
#include <catch2/catch.hpp>

#include "scene/convert/gaussian_fit.h"
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
      // Whoever is in both frames has hardly moved.
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

}  // namespace fitted_sequence_test
