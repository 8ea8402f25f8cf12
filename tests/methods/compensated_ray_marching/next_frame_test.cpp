// Frames after frames: another light, other smoke, a map that turns, against frames that are prepared anew.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "methods/compensated_ray_marching/warm_start.h"
#include "scene/media/fitted.h"
#include "tests/methods/compensated_ray_marching/puffs.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"
#include "tests/pictures.h"

namespace next_frame_test {

using namespace airlight;
using namespace airlight::test;
using compensated_ray_marching::CompensatedRayMarching;

namespace {

const CompensatedRayMarching method;
const Given paper{{"variant", "paper"}};

}  // namespace

TEST_CASE("compensated march: the next frame's light as if prepared anew", "[compensated_ray_marching]") {
  for (const Given& given : {Given{{"cells", "16"}, {"tolerance", "1e-6"}},
                             Given{{"variant", "paper"}, {"iterations", "100"}, {"tolerance", "1e-10"}}}) {
    const auto before = scene_of(puffs(), 4, 0.9, uneven(2)), after = scene_of(puffs(), 4, 0.9, uneven(0.3));
    const scene::Settings settings{method.settings(), given};
    const auto prepared = method.prepare(before, settings, {1, {}});
    const auto times = prepared->next(after, {1, {}});
    REQUIRE(times);
    const scene::Film warm = prepared->render(view_of(*after), {1, {}}).film, cold = picture(method, after, given);
    CAPTURE(given);
    CHECK(greatest_difference(warm, cold, "mean") < 3e-6);
    CHECK(greatest_difference(warm, picture(method, before, given), "airlight") > 0.01);
    auto sun = scene_of(puffs(), 4, 0.9, uneven());
    sun->lights.push_back(scene::DirectionalLight{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)});
    finish(*sun);
    if (given.count("variant")) continue;
    CHECK(greatest_difference(next_frame(*prepared, sun).film, picture(method, sun, given), "mean") < 1e-5);
  }
}

TEST_CASE("compensated march: where only the camera moved, the light is kept", "[compensated_ray_marching]") {
  for (const Given& given : {Given{{"cells", "8"}}, Given{{"variant", "paper"}, {"iterations", "50"}}}) {
    const auto before = scene_of(puffs(), 4, 0.9, uneven());
    auto after = std::make_shared<scene::Scene>(*before);
    after->camera.position[0] += 0.1;
    finish(*after);
    const auto prepared = method.prepare(before, {method.settings(), given}, {1, {}});
    const auto times = prepared->next(after, {1, {}});
    REQUIRE(times);
    CHECK(times->empty());
    CHECK(prepared->render(view_of(*after), {1, {}}).film.layers == picture(method, after, given).layers);
  }
}

TEST_CASE("compensated march: other smoke as if prepared anew, from the last frame's solution in fewer iterations",
          "[compensated_ray_marching]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  scene::GaussianSum cloud;
  cloud.cutoff = 3;
  for (int i = 0; i < 20; ++i)
    cloud.gaussians.push_back({{share(random) - 0.5, share(random) - 0.5, share(random) - 0.5},
                               0.15 + 0.15 * share(random),
                               0.2 + 0.5 * share(random)});
  const auto at = [&](double step, double sigma_t) { return scene_of(risen(cloud, step), sigma_t, 0.9, uneven()); };
  const struct {
    Given given;
    bool same, fewer;  // what is asked
  } kinds[] = {{{{"cells", "8"}, {"levels", "4"}, {"order", "2"}, {"tolerance", "1e-4"}, {"slices", "48"}}, true, true},
               {{{"variant", "paper"}, {"order", "2"}, {"iterations", "5000"}, {"tolerance", "1e-9"}, {"slices", "48"}},
                true,
                false},
               {{{"variant", "paper"}, {"order", "2"}, {"iterations", "5000"}, {"tolerance", "0.03"}, {"slices", "48"}},
                false,
                true}};
  for (const auto& [given, same, fewer] : kinds) {
    CAPTURE(given);
    const auto prepared = method.prepare(at(0, 4), {method.settings(), given}, {1, {}});
    // Smoke that moves, smoke whose attributes change, and smoke that was away for a frame.
    for (const auto& scene : {at(0.02, 4.1), at(0.02, 0), at(0.03, 4.1)}) {
      const scene::Rendering warm = next_frame(*prepared, scene);
      const scene::Rendering cold =
          method.prepare(scene, {method.settings(), given}, {1, {}})->render(view_of(*scene), {1, {}});
      if (same) CHECK(relative_l2(warm.film, cold.film, "mean") < 3e-4);
      if (!fewer || scene->media[0].sigma_t[0] == 0) continue;
      CHECK(warm.counters.at("iterations") > 0);
      CHECK(warm.counters.at("iterations") < cold.counters.at("iterations"));
    }
  }
  // Without a solution there is nothing to begin with.
  const auto once = method.prepare(at(0, 4), {method.settings(), {{"multiple", "none"}}}, {1, {}});
  CHECK_FALSE(once->next(at(0.02, 4), {1, {}}));
}

TEST_CASE("compensated march: a solution at other centres is a weighted mean, at other nodes trilinear",
          "[compensated_ray_marching]") {
  namespace crm = compensated_ray_marching;
  crm::Solution last;
  last.centres = puffs().gaussians;
  last.of_channel[1] = Eigen::Array3d(2, 5, -1);
  CHECK(crm::at_centres(last, 1, puffs().gaussians) == Eigen::Vector3d(2, 5, -1));
  const scene::Gaussian there{{0.1, 0.3, -0.1}, 0.2, 1}, far{{1e4, 0, 0}, 0.2, 1};
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const scene::Gaussian& g = last.centres[k];
    const double weight = g.amplitude * std::exp(-(there.center - g.center).squaredNorm() / (g.width * g.width));
    sum += weight * last.of_channel[1](Eigen::Index(k), 0);
    weights += weight;
  }
  const Eigen::VectorXd values = crm::at_centres(last, 1, {there, far});
  CHECK(std::abs(values[0] - sum / weights) < 1e-14);
  CHECK(values[1] == 0);
  CHECK(crm::at_centres(last, 0, {there}).size() == 0);

  crm::Solution at_grid;
  at_grid.nodes = crm::node_grid({{0, 0, 0}, {1, 2, 1}}, 8);
  const auto linear = [](const Point3& x) { return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2]; };
  at_grid.of_channel[0].resize(at_grid.nodes.cells.nodes(), 1);
  for (Eigen::Index i = 0; i < at_grid.nodes.cells.nodes(); ++i)
    at_grid.of_channel[0](i, 0) = linear(at_grid.nodes.node(i));
  const crm::NodeGrid other = crm::node_grid({{0.3, 0.4, 0.3}, {0.8, 3, 0.8}}, 9);
  const Eigen::ArrayXXd moved = crm::at_nodes(at_grid, 0, other, 1);
  REQUIRE(moved.rows() == other.cells.nodes());
  const Box known{at_grid.nodes.node(0), at_grid.nodes.node(at_grid.nodes.cells.nodes() - 1)};
  int within = 0, beyond = 0;
  for (Eigen::Index i = 0; i < moved.rows(); ++i) {
    const Point3 x = other.node(i);
    const bool in = (x.array() >= known.lo.array()).all() && (x.array() <= known.hi.array()).all();
    if (in) CHECK(std::abs(moved(i, 0) - linear(x)) < 1e-12);
    within += in;
    beyond += (x.array() > known.hi.array() + at_grid.nodes.cells.cell.array()).any() && moved(i, 0) == 0;
  }
  CHECK(within > 10);
  CHECK(beyond > 10);
  CHECK(crm::at_nodes(at_grid, 0, at_grid.nodes, 1).isApprox(at_grid.of_channel[0]));
  // A field that is equal but for its place takes its values along.
  std::vector<scene::Gaussian> along = puffs().gaussians;
  for (scene::Gaussian& g : along) g.center += Vec3(0.3, 0.1, 0);
  CHECK(crm::at_centres(last, 1, along) == Eigen::Vector3d(2, 5, -1));
  CHECK(
      crm::at_nodes(at_grid, 0, crm::node_grid({{0.3, 0.1, 0}, {1.3, 2.1, 1}}, 8), 1).isApprox(at_grid.of_channel[0]));
  CHECK(crm::at_nodes(at_grid, 0, other, 4).size() == 0);
}

TEST_CASE("compensated march: under a map that turns, the next frame's light as if prepared anew",
          "[compensated_ray_marching]") {
  const auto map = rough_map(64, 32);
  const auto at = [&](double turn) { return scene_of(puffs(), 4, 0.9, rough_sky(turn, map)); };
  for (const Given& given :
       {Given{{"cells", "8"}, {"tolerance", "1e-6"}}, Given{{"variant", "paper"}, {"multiple", "none"}}}) {
    const auto before = at(0);
    const auto prepared = method.prepare(before, {method.settings(), given}, {1, {}});
    for (const auto& scene : {at(0.4), at(2), scene_of(puffs(), 4, 0.9, rough_sky(2, rough_map(32, 16, 3))), before}) {
      const scene::Film warm = next_frame(*prepared, scene).film, cold = picture(method, scene, given);
      CAPTURE(given);
      CHECK(relative_l2(warm, cold) < 3e-6);
      if (scene != before) CHECK(relative_l2(warm, picture(method, before, given)) > 0.01);
    }
  }
}

}  // namespace next_frame_test
