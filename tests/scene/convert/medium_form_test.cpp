#include "scene/convert/medium_form.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/base/content_store.h"
#include "scene/base/error.h"
#include "scene/media/voxel_grid.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace medium_form_test {

using namespace airlight;
using namespace airlight::scene;
using Pairs = std::map<std::string, std::string>;

namespace {

const Box box{Point3(-1, 0, 2), Point3(1, 1.5, 3)};

Scene scene_of(DensityField field, Region region) {
  Scene scene;
  scene.media.push_back(
      {"smoke", std::move(field), std::move(region), Rgb(1, 2, 3), Rgb(0.9, 0.8, 0.7), HenyeyGreenstein{0.4}});
  finish(scene);
  return scene;
}

ConvertedScene converted(const Scene& scene, const Pairs& to, const Execution& execution = {}) {
  return convert_media(scene, read_conversion(to, "test"), execution, "test");
}

GaussianSum puffs() {
  GaussianSum sum;
  sum.cutoff = 3;
  sum.gaussians = {
      {Point3(-0.4, 0.7, 2.5), 0.15, 1.0}, {Point3(0.1, 0.8, 2.4), 0.2, 0.6}, {Point3(0.5, 0.6, 2.6), 0.12, 0.9}};
  return sum;
}

}  // namespace

TEST_CASE("an even box is the same in every form that can hold it", "[convert]") {
  const Scene even = scene_of(Homogeneous{0.7}, box);
  for (const Pairs& to : {Pairs{{"to", "grid"}, {"voxels", "8"}}, Pairs{{"to", "legendre"}, {"order", "2"}},
                          Pairs{{"to", "homogeneous"}}}) {
    CAPTURE(to.at("to"));
    const ConvertedScene other = converted(even, to);
    REQUIRE(other.media.size() == 1);
    CHECK(other.media[0].density_error < 1e-6);
    CHECK(other.media[0].mass_ratio == Approx(1).epsilon(1e-6));
    // Everything but the density stays.
    const Medium &before = even.media[0], &after = other.scene.media[0];
    CHECK((after.sigma_t == before.sigma_t).all());
    CHECK((after.albedo == before.albedo).all());
    CHECK(phase_name(after.phase) == phase_name(before.phase));
    CHECK(other.scene.hash != even.hash);
    const Ray across{Point3(-3, 0.7, 2.4), Vec3::UnitX()};
    CHECK(density_integral(after, across, {0, 10}) == Approx(density_integral(before, across, {0, 10})).epsilon(1e-6));
  }
}

TEST_CASE("Gaussians are found again by as many Gaussians", "[convert]") {
  const ConvertedScene fitted = converted(scene_of(puffs(), Unbounded{}), {{"to", "gaussians"}, {"count", "3"}});
  CHECK(fitted.media[0].numbers == 15);
  CHECK(fitted.media[0].density_error < 0.02);
  CHECK(fitted.media[0].mass_ratio == Approx(1).epsilon(0.02));
}

TEST_CASE("errors of every form fall with the numbers that it has", "[convert]") {
  const Scene smoke = scene_of(puffs(), Unbounded{});
  struct Case {
    const char *to, *key, *few, *many;
    double factor;  // by which the error must fall, at least
  };
  for (const Case& c : {Case{"grid", "voxels", "16", "32", 3},  // order 2
                        {"gaussians", "count", "1", "3", 10},
                        {"legendre", "order", "8", "28", 5},
                        {"fogmap", "cells", "4", "32", 1.05}}) {  // height stays lost
    CAPTURE(c.to);
    const auto error = [&](const char* n) {
      return converted(smoke, {{"to", c.to}, {c.key, n}}).media[0].density_error;
    };
    CHECK(error(c.few) > c.factor * error(c.many));
  }
}

TEST_CASE("a fogmap keeps columns of fog that is the same at all heights", "[convert]") {
  auto grid = std::make_shared<VoxelGrid>();
  grid->size = Eigen::Vector3i(12, 6, 8);
  grid->voxel_size = 0.1;
  grid->clamp_border = true;
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 12; ++i) grid->values.push_back(float(1 + std::sin(0.5 * i) * std::cos(0.4 * k)));
  const ConvertedScene fog = converted(scene_of(GridPointer(grid), Unbounded{}), {{"to", "fogmap"}, {"cells", "48"}});
  CHECK(fog.media[0].density_error < 0.1);  // the edge of a linear spline, a cell wide
  CHECK(fog.media[0].mass_ratio == Approx(1).epsilon(0.02));
  const Medium& after = fog.scene.media[0];
  CHECK(std::holds_alternative<Slab>(after.region));
}

TEST_CASE("Gaussians are cut as they were fitted, or go on", "[convert]") {
  for (const bool cut : {true, false}) {
    const ConvertedScene fitted = converted(scene_of(puffs(), Unbounded{}),
                                            {{"to", "gaussians"}, {"count", "3"}, {"cut", cut ? "true" : "false"}});
    CHECK(std::get<GaussianSum>(fitted.scene.media[0].field).cutoff == (cut ? 3 : infinity));
  }
}

TEST_CASE("a far lamp shines as the sun that it stands for", "[convert]") {
  Scene sunny = scene_of(Homogeneous{0.7}, box);
  const DirectionalLight sun{Vec3(2, 2, 1).normalized(), Rgb(12, 11, 10)};
  sunny.lights = {sun};
  finish(sunny);
  const Scene lamp = converted(sunny, {{"to", "homogeneous"}, {"lamps", "true"}}).scene;
  REQUIRE(std::holds_alternative<PointLight>(lamp.lights.at(0)));
  for (const Point3& x : {box.lo, box.hi, Point3(1, 0, 2)}) {
    const Incident there = incident(lamp.lights[0], x);
    CHECK((there.to_light - sun.to_light).norm() < 1 / far_lamp);
    CHECK((there.irradiance / sun.irradiance - 1).abs().maxCoeff() < 2 / far_lamp);
  }
  CHECK(std::holds_alternative<DirectionalLight>(converted(sunny, {{"to", "homogeneous"}}).scene.lights.at(0)));
}

TEST_CASE("a fit is kept in the store, with the time that it took", "[convert]") {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  Execution execution;
  execution.store = &store;
  const Scene smoke = scene_of(puffs(), Unbounded{});
  const Pairs to{{"to", "gaussians"}, {"count", "2"}};
  const ConvertedScene first = converted(smoke, to, execution), again = converted(smoke, to, execution);
  CHECK(again.media[0].seconds == first.media[0].seconds);
  CHECK(again.scene.hash == first.scene.hash);
  CHECK(converted(smoke, to).scene.hash == first.scene.hash);
  CHECK(converted(smoke, {{"to", "gaussians"}, {"count", "3"}}, execution).scene.hash != first.scene.hash);
}

TEST_CASE("conversions that make no sense are refused in one line", "[convert]") {
  using Catch::Contains;
  CHECK_THROWS_WITH(read_conversion({{"to", "grid"}, {"count", "5"}}, "x.toml:3:1"),
                    Contains("x.toml:3:1") && Contains("count"));
  CHECK_THROWS_WITH(read_conversion({{"to", "gausians"}}, "x"), Contains("gaussians"));
  CHECK_THROWS_WITH(read_conversion({{"to", "legendre"}, {"order", "0"}}, "x"), Contains("order"));
  CHECK_THROWS_WITH(converted(scene_of(Homogeneous{1}, Unbounded{}), {{"to", "homogeneous"}}),
                    Contains("'smoke' has no end"));
  GaussianSum none;
  CHECK_THROWS_WITH(converted(scene_of(none, Unbounded{}), {{"to", "grid"}}), Contains("'smoke' is empty"));
}

}  // namespace medium_form_test
