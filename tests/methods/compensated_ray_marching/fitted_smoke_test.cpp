// Fitted smoke in the published variant ends where its voxels and its region end.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/convert/residual.h"
#include "scene/media/fitted.h"
#include "tests/methods/compensated_ray_marching/puffs.h"

namespace fitted_smoke_test {

using namespace airlight;
using namespace airlight::test;

namespace {

const compensated_ray_marching::CompensatedRayMarching method;

// A box of samples that cuts all puffs, with a residual of either sign.
std::shared_ptr<scene::Fitted> cut_fit() {
  scene::VoxelGrid grid;
  grid.size = {9, 8, 7};
  grid.voxel_size = 0.12;
  grid.translation = {-0.5, -0.4, -0.3};
  grid.values = scene::decoded(grid, puffs(), {}).values;
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    grid.values[i] = float(std::max(0.0, grid.values[i] + 0.3 * std::sin(0.7 * double(i))));
  auto fitted = std::make_shared<scene::Fitted>();
  fitted->gaussians = puffs();
  fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(grid, puffs(), {}));
  fitted->grid = scene::decoded(puffs(), *fitted->residual);
  return fitted;
}

const std::vector<scene::Region> regions = {scene::Unbounded{}, Box{{-1, -1, -0.2}, {0.3, 0.1, 1}},
                                            scene::Sphere{{0.1, 0, 0}, 0.35},
                                            scene::Slab{Vec3(1, 2, 0).normalized(), -0.2, 0.15}};

}  // namespace

// The Gaussians reach beyond the samples, where nothing takes their tails away. The grid's variant, which marches through the decoded voxels,
// is another way to the same density; in thin smoke under an even light what is scattered once is the albedo times what is taken away.
TEST_CASE("compensated march: fitted smoke of paper ends with its samples and its region",
          "[compensated_ray_marching]") {
  const auto fitted = cut_fit();
  auto without = std::make_shared<scene::Fitted>(*fitted);
  without->residual = nullptr;
  without->grid = scene::decoded(fitted->grid, fitted->gaussians, {});
  for (const scene::Region& region : regions)
    for (const std::string residual : {"true", "false"}) {
      CAPTURE(region_name(region), residual);
      const auto scene = in_white(puffs(), 0.02);
      scene->media[0].field = scene::FittedPointer(fitted);
      scene->media[0].region = region;
      finish(*scene);
      const Given of_paper{{"variant", "paper"}, {"multiple", "none"}, {"residual", residual}};
      const Given of_grid{{"multiple", "none"}, {"residual", residual}, {"cells", "24"}};
      const scene::Film a = picture(method, scene, of_paper), b = picture(method, scene, of_grid);
      CHECK(greatest_difference(a, b, "transmittance") < 1e-6);
      double most = 0;
      for (std::size_t i = 0; i < a.layer("airlight").size(); ++i) {
        const double lost = 1 - double(b.layer("transmittance")[i]);
        most = std::max(most, lost);
        CHECK(std::abs(a.layer("airlight")[i] - 0.8 * lost) <= 0.03 * lost + 1e-6);
      }
      CHECK(most > 1e-3);
      if (residual == "true") continue;
      const auto alone = std::make_shared<scene::Scene>(*scene);
      alone->media[0].field = scene::FittedPointer(without);
      finish(*alone);
      CHECK(a.layer("mean") == picture(method, alone, of_paper).layer("mean"));
      CHECK(b.layer("mean") == picture(method, alone, of_grid).layer("mean"));
    }
}

TEST_CASE("compensated march: Gaussians of paper beyond the region throw no shadow", "[compensated_ray_marching]") {
  scene::VoxelGrid grid;
  grid.size = {12, 30, 12};
  grid.voxel_size = 0.1;
  grid.translation = {-0.55, -0.55, -0.55};
  const auto of = [&](const scene::GaussianSum& sum) {
    auto fitted = std::make_shared<scene::Fitted>();
    fitted->gaussians = sum;
    fitted->grid = scene::decoded(grid, sum, {});
    return scene::FittedPointer(fitted);
  };
  scene::GaussianSum low;
  low.cutoff = 3;
  low.gaussians = {{{0, 0, 0}, 0.2, 1}, {{0.1, 0.1, 0}, 0.1, 1}};
  scene::GaussianSum both = low;
  both.gaussians.push_back({{0, 1.5, 0}, 0.25, 30});
  const auto scene = in_white(low, 4);
  scene->media[0].field = of(low);
  finish(*scene);
  const auto cut = std::make_shared<scene::Scene>(*scene), uncut = std::make_shared<scene::Scene>(*scene);
  cut->media[0].field = uncut->media[0].field = of(both);
  cut->media[0].region = scene::Slab{Vec3::UnitY(), -5, 0.7};
  finish(*cut);
  finish(*uncut);
  const Given once{{"variant", "paper"}, {"multiple", "none"}, {"slices", "2000"}};
  const scene::Film alone = picture(method, scene, once);
  CHECK(relative_l2(picture(method, cut, once), alone) < 2e-3);
  CHECK(relative_l2(picture(method, uncut, once), alone) > 0.02);
}

}  // namespace fitted_smoke_test
