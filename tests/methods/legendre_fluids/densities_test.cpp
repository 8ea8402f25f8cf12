// The density of a flow as a medium, several of them, an albedo that moves, and a wind that changes.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/exact_flows/exact_flows.h"
#include "reference/stable_fluids/stable_fluids.h"
#include "scene/media/legendre_box.h"
#include "tests/methods/legendre_fluids/flows.h"

namespace densities_test {

using namespace airlight;
using namespace airlight::legendre_fluids::testing;
using Catch::Contains;
using Kind = scene::Side::Kind;

namespace {

const scene::LegendreBox& box_of(const scene::DensityField& field) { return *std::get<scene::LegendrePointer>(field); }

// Two blobs in a swirl, of two densities.
FlowProblem two_blobs(int dimensions) {
  FlowProblem problem = box(dimensions);
  const double z = dimensions == 2 ? 0 : 0.5;
  problem.velocity = scene::Swirl{1};
  problem.blobs.push_back({Point3(0.35, 0.5, z), 0.3, 1, 0});
  problem.densities.push_back({"red", 0.25, {{Point3(0.65, 0.5, z), 0.3, 2, 0}}, {}, nullptr});
  return problem;
}

}  // namespace

TEST_CASE("legendre fluids: a medium is the polynomial itself, not below 0", "[legendre_fluids]") {
  for (const int d : {2, 3}) {
    FlowProblem problem = two_blobs(d);
    problem.box.lo += Vec3(0, 1, 0), problem.box.hi += Vec3(0, 1, 0), problem.blobs[0].center[1] += 1;
    const auto flow = start(problem, {{"n", "7"}, {"cells", "16"}});
    run(*flow, 10, 0.05);
    const scene::DensityField medium = flow->medium();
    const scene::LegendreBox& field = box_of(medium);
    CHECK(field.shape() == scene::TensorShape{7, 7, d == 3 ? 7 : 1});
    CHECK(field.negative());
    for (const double x : {0.05, 0.31, 0.77})
      for (const double y : {1.2, 1.64}) {
        const Point3 at(x, y, d == 3 ? 0.3 : 0.02);
        CHECK(scene::density(field, at) == Approx(std::max(0.0, flow->density(at))).margin(1e-14));
      }
    // In two dimensions one cell deep, as frames are.
    if (d == 3)
      CHECK(field.box().size().isApprox(problem.box.size()));
    else
      CHECK((field.box().lo[2] == Approx(-1.0 / 32) && field.box().hi[2] == Approx(1.0 / 32)));
  }
  const FlowProblem problem = two_blobs(2);
  CHECK(std::holds_alternative<scene::GridPointer>(start(problem, {{"n", "33"}})->medium()));
  CHECK(box_of(start(box(3), {{"n", "3"}})->medium()).greatest() == 0);
}

TEST_CASE("legendre fluids: each of several densities moves as it does alone", "[legendre_fluids]") {
  const FlowProblem problem = two_blobs(2);
  const Given settings{{"n", "9"}, {"filter_carried", "0.5"}};
  const auto both = start(problem, settings);
  run(*both, 20, 0.02);
  for (int which : {0, 1}) {
    const auto alone = start(scene::with_density(problem, which), settings);
    run(*alone, 20, 0.02);
    const Eigen::VectorXd difference =
        box_of(both->medium(which)).coefficients() - box_of(alone->medium()).coefficients();
    CHECK(difference.norm() < 1e-13 * box_of(alone->medium()).coefficients().norm());
    CHECK(scene::with_density(problem, which).hash != problem.hash);
  }
  CHECK(both->frame().densities.at("red").size() == both->frame().density.size());
  CHECK(both->frame().densities.at("red") != both->frame().density);
  const auto again = start(problem, settings);
  again->restore(both->state());
  run(*again, 3, 0.02), run(*both, 3, 0.02);
  CHECK(again->state() == both->state());
  CHECK(scene::density_name(problem, 0) == "density");
  CHECK(scene::density_name(problem, 1) == "red");
  CHECK_THROWS_WITH(start<stable_fluids::StableFluids>(problem, {}), Contains("several densities"));
  CHECK_THROWS_WITH(start<exact_flows::ExactFlows>(problem, {}), Contains("several densities"));
}

TEST_CASE("legendre fluids: sources and sides bring the density that they name, and all of them weigh",
          "[legendre_fluids]") {
  FlowProblem problem = box(2, Vec3(2, 1, 1));
  problem.velocity = scene::Wind{Vec3(1, 0, 0)};
  for (scene::Side& side : problem.sides[0]) side.kind = Kind::open;
  problem.densities.push_back({"red", 0, {}, {}, nullptr});
  problem.densities.push_back({"blue", 0, {}, {}, nullptr});
  problem.sides[0][0].density = 0.5, problem.sides[0][0].of = 1;
  scene::Source source;
  source.region = Box{Point3(0.5, 0, -1), Point3(1.5, 1, 1)};
  source.density_rate = 1;
  source.of = 2;
  problem.sources.push_back(source);
  auto flow = start(problem, {{"n", "8"}});
  run(*flow, 60, 0.1);
  CHECK(flow->totals().mass == 0);
  const Point3 last(1.95, 0.5, 0);
  CHECK(scene::density(box_of(flow->medium(1)), last) == Approx(0.5).epsilon(1e-3));
  CHECK(scene::density(box_of(flow->medium(2)), last) ==
        Approx(1).epsilon(0.03));  // a second in the source, whose edges are soft

  problem = box(2);
  problem.gravity = Vec3(0, -9.81, 0);
  problem.weight = 0.1;
  problem.densities.push_back({"red", 0, {{Point3(0.5, 0.7, 0), 0.2, 1, 0}}, {}, nullptr});
  flow = start(problem, {{"n", "8"}});
  run(*flow, 10, 0.02);
  CHECK(flow->velocity(Point3(0.5, 0.7, 0))[1] < -0.02);
}

TEST_CASE("legendre fluids: an albedo that moves keeps the sum, and a share that is the same everywhere",
          "[legendre_fluids]") {
  const Given settings{{"n", "10"}, {"mixing", "albedo"}};
  FlowProblem problem = two_blobs(2);
  const auto flow = start(problem, settings);
  run(*flow, 20, 0.02);
  FlowProblem sum = scene::with_density(problem, 0);
  sum.blobs.push_back(problem.densities[0].blobs[0]);
  sum.density = problem.densities[0].density;
  const auto together = start(sum, {{"n", "10"}});
  run(*together, 20, 0.02);
  const Eigen::VectorXd both = box_of(flow->medium(0)).coefficients() + box_of(flow->medium(1)).coefficients();
  CHECK((both - box_of(together->medium()).coefficients()).norm() < 1e-13 * both.norm());
  const auto again = start(problem, settings);
  again->restore(flow->state());
  CHECK(box_of(again->medium(1)).coefficients() == box_of(flow->medium(1)).coefficients());

  // A quarter of one kind everywhere stays one.
  problem.densities[0].density = 0;
  problem.densities[0].blobs = problem.blobs;
  problem.densities[0].blobs[0].density = 3;
  const auto quarter = start(problem, settings), apart = start(problem, {{"n", "10"}});
  run(*quarter, 20, 0.02), run(*apart, 20, 0.02);
  for (const int which : {0, 1})
    CHECK((box_of(quarter->medium(which)).coefficients() - box_of(apart->medium(which)).coefficients()).norm() <
          1e-12 * box_of(apart->medium(which)).coefficients().norm());

  CHECK_THAT(objections(box(2), settings).at(0), Contains("mixing = albedo with 1 densities, expected 2"));
  problem.diffusivity = 1;
  CHECK_THAT(objections(problem, settings).at(0), Contains("mixing = albedo with diffusivity"));
  problem.diffusivity = 0;
  problem.sources.push_back({});
  problem.sources[0].density_rate = 1;
  CHECK_THAT(objections(problem, settings).at(0), Contains("mixing = albedo with sources"));
}

TEST_CASE("legendre fluids: a wind that changes carries a blob as far as its integral", "[legendre_fluids]") {
  FlowProblem problem = box(2, Vec3(4, 1, 1));
  scene::Wind wind{Vec3(0.5, 0, 0), Vec3(1, 0, 0), 0.25};
  problem.velocity = wind;
  for (scene::Side& side : problem.sides[0]) side.kind = Kind::open;
  problem.blobs.push_back({Point3(1.2, 0.5, 0), 0.35, 1, 0});
  const auto flow = start(problem, {{"n", "24"}});
  run(*flow, 60, 0.02);
  const double t = 1.2, way = 0.5 * t + (1 - std::cos(pi / 2 * t)) / (pi / 2);
  CHECK(flow->totals().center_of_mass[0] == Approx(1.2 + way).margin(2e-3));
  CHECK(flow->velocity(Point3(2, 0.5, 0))[0] == Approx(0.5 + std::sin(pi / 2 * t)));
  for (scene::Side& side : problem.sides[0]) side.kind = Kind::free_slip;
  CHECK_THAT(objections(problem).at(0), Contains("a gust without open sides"));
  CHECK_THROWS_WITH(start<stable_fluids::StableFluids>(problem, {}), Contains("a gust"));
  CHECK_THROWS_WITH(start<exact_flows::ExactFlows>(problem, {}), Contains("a gust"));
}

}  // namespace densities_test
