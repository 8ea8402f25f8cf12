// Whole flows: symmetry, rest, restart, threads, thin boxes, stiff coefficients.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/stable_fluids/requirements.h"
#include "scene/base/error.h"
#include "scene/geometry/shapes.h"
#include "tests/reference/stable_fluids/problems.h"

namespace flow_test {

using namespace airlight;
using namespace airlight::stable_fluids;
using Catch::Contains;
using testing::box_problem;
using testing::Kind;
using testing::plume;
using testing::start;

namespace {

// All of a flow's state but the first line and the checksum.
std::string fields(const scene::Flow& flow) {
  const std::string state = flow.state();
  const std::size_t first = state.find('\n') + 1;
  return state.substr(first, state.size() - first - 32);
}

}  // namespace

TEST_CASE("stable fluids: a plume is symmetric and rises", "[stable_fluids]") {
  const auto flow = start(plume(3), {{"n", "20"}});
  double height = 0, mass = 0;
  for (int step = 0; step < 100; ++step) {
    flow->step(0.01);
    if (step % 10 != 9) continue;
    const auto totals = flow->totals();
    CHECK(totals.center_of_mass[1] > height);
    CHECK(totals.mass > mass);
    CHECK(totals.divergence < 1e-12);
    height = totals.center_of_mass[1];
    mass = totals.mass;
  }
  double mirror = 0, turned = 0;
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 20; ++i) {
        const auto at = [&](int x, int z) {
          return flow->density(Point3((x + 0.5) / 20, (j + 0.5) / 20, (z + 0.5) / 20));
        };
        mirror = std::max(mirror, std::abs(at(i, k) - at(19 - i, k)));
        turned = std::max(turned, std::abs(at(i, k) - at(k, i)));
      }
  CHECK(mirror < 1e-10);
  CHECK(turned < 1e-10);
  CHECK(height > 0.3);
}

// At first nothing flows along x and z, and feet lie on lines of samples: the limiter must look to neither side of them.
TEST_CASE("stable fluids: the limiter keeps a plume its own mirror image", "[stable_fluids]") {
  const int n = 32;
  for (const char* scheme : {"maccormack", "bfecc"}) {
    const auto flow = start(plume(3), {{"n", "32"}, {"scheme", scheme}});
    testing::run(*flow, 3, 0.01);
    double most = 0;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const Point3 x((i + 0.5) / n, (j + 0.5) / n, (k + 0.5) / n);
          most = std::max(most, std::abs(flow->density(x) - flow->density(Point3(1 - x[0], x[1], x[2]))));
        }
    CHECK(most < 1e-13);
  }
}

TEST_CASE("stable fluids: one thread or many give the same bits", "[stable_fluids]") {
  for (const bool obstacle : {false, true})
    for (const char* precision : {"float", "double"}) {
      scene::FlowProblem problem = plume(3);
      problem.viscosity = 1e-3;
      problem.diffusivity = 1e-4;
      problem.confinement = 0.1;
      if (obstacle) problem.obstacles = {{"ball", scene::Sphere{Point3(0.45, 0.6, 0.5), 0.15}, {}}};
      const auto states = [&](int threads) {
        const auto flow = start(problem, {{"n", "20"}, {"precision", precision}}, threads);
        testing::run(*flow, 8, 0.02);
        return fields(*flow);
      };
      const std::string one = states(1);
      CHECK(one == states(2));
      CHECK(one == states(16));
    }
}

TEST_CASE("stable fluids: a restart goes on with the same bits", "[stable_fluids]") {
  scene::FlowProblem problem = plume(2);
  problem.obstacles = {{"ball", scene::Sphere{Point3(0.45, 0.6, 0), 0.15}, {}}};
  const std::string precision = GENERATE("float", "double");
  const auto unbroken = start(problem, {{"precision", precision}});
  testing::run(*unbroken, 5, 0.02);
  const std::string middle = unbroken->state();
  testing::run(*unbroken, 5, 0.02);

  const auto resumed = start(problem, {{"precision", precision}});
  resumed->restore(middle);
  CHECK(resumed->time() == 5 * 0.02);
  testing::run(*resumed, 5, 0.02);
  CHECK(resumed->state() == unbroken->state());

  const auto other = start(problem, {{"n", "8"}});
  CHECK_THROWS_WITH(other->restore(middle), Contains("expected \"stable fluids, 8 x 8 x 1 cells"));
  CHECK_THROWS_WITH(resumed->restore(middle.substr(0, middle.size() - 1)), Contains("checksum"));
  std::string damaged = middle;
  damaged[damaged.size() / 2] ^= 1;
  CHECK_THROWS_WITH(resumed->restore(damaged), Contains("checksum"));
}

TEST_CASE("stable fluids: an axis of one cell is two dimensions", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  scene::FlowProblem flat = plume(2), thin = plume(3);
  flat.viscosity = thin.viscosity = 1e-3;
  thin.box = {Point3(0, 0, -1.0 / 32), Point3(1, 1, 1.0 / 32)};
  thin.sources = flat.sources;
  const auto two = start(flat, {{"precision", precision}}), three = start(thin, {{"precision", precision}});
  testing::run(*two, 20, 0.02);
  testing::run(*three, 20, 0.02);
  double most = 0;
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) {
      const Point3 x((i + 0.5) / 16, (j + 0.5) / 16, 0);
      most = std::max(
          {most, (two->velocity(x) - three->velocity(x)).norm(), std::abs(two->density(x) - three->density(x))});
    }
  CHECK(most < 1e-12);
  CHECK(three->velocity(Point3(0.4, 0.4, 0))[2] == 0);
}

TEST_CASE("stable fluids: boxes of a cell or two, and of prime sizes", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  for (const Vec3& cells : {Vec3(1, 1, 1), Vec3(2, 2, 2), Vec3(7, 129, 3), Vec3(1, 2, 31)})
    for (const Kind sides : {Kind::free_slip, Kind::no_slip, Kind::open, Kind::periodic}) {
      scene::FlowProblem problem = plume(3);
      for (auto& axis : problem.sides)
        for (scene::Side& side : axis) side.kind = sides;
      problem.box = {Point3::Zero(), 0.1 * cells};
      problem.sources[0].region = Box{Point3::Zero(), 0.06 * cells};
      problem.viscosity = 0.01;
      problem.confinement = 0.5;
      const auto flow = start(problem, {{"n", std::to_string(int(cells.maxCoeff()))}, {"precision", precision}});
      testing::run(*flow, 3, 0.02);
      INFO("cells " << cells.transpose() << ", sides " << scene::side_name(sides));
      CHECK(std::isfinite(flow->totals().energy));
      CHECK(flow->totals().divergence * flow->totals().greatest_speed <
            (precision == "float" ? 1e-5 : 1e-12) * std::max(flow->totals().greatest_speed, 0.01));
      if (cells.maxCoeff() == 1 && (sides == Kind::free_slip || sides == Kind::no_slip))
        CHECK(flow->totals().greatest_speed == 0);
    }
}

TEST_CASE("stable fluids: viscosity from nothing to a million", "[stable_fluids]") {
  for (const char* precision : {"double", "float"}) {
    const double rounding = precision[0] == 'd' ? 1e-12 : 1e-5;
    scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::periodic);
    problem.velocity = scene::Wind{Vec3(0.3, 0.1, 0)};
    problem.viscosity = 1e6;
    auto flow = start(problem, {{"precision", precision}});
    testing::run(*flow, 3, 0.1);
    CHECK(std::abs(flow->velocity(Point3(0.2, 0.2, 0))[0] - 0.3) < rounding);  // the mean stays

    problem = box_problem(2, Vec3(1, 1, 0), Kind::no_slip);
    problem.velocity = scene::Swirl{1};
    problem.viscosity = 1e6;
    flow = start(problem, {{"precision", precision}});
    flow->step(0.1);
    CHECK(flow->totals().greatest_speed < 1e-5);

    // Cells of 0.1 mm and nu dt = 1e9.
    problem.box = {Point3::Zero(), Point3(16e-4, 16e-4, 0)};
    problem.viscosity = 1e9;
    flow = start(problem, {{"precision", precision}});
    testing::run(*flow, 2, 1);
    CHECK(flow->totals().greatest_speed < 1e-12);
    CHECK(std::isfinite(flow->totals().energy));
  }
}

TEST_CASE("stable fluids: implicit viscosity and diffusion multiply a wave by 1 / (1 + nu dt lambda)",
          "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  for (const double nu : {0.0, 1e-3, 1.0, 1e6}) {
    // A shear that carries itself nowhere, and a density in a fluid at rest: n cells, one wave along y.
    const int n = 16;
    const double dt = 0.25, lambda = 4.0 * n * n * std::pow(std::sin(pi / n), 2), factor = 1 / (1 + nu * dt * lambda);
    scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::periodic);
    problem.viscosity = problem.diffusivity = nu;
    scene::VelocityGrid shear;
    for (int a = 0; a < 3; ++a) {
      shear[a].size = {n + 1, n, 1};
      shear[a].voxel_size = 1.0 / n;
      shear[a].translation = Vec3(0, 0.5 / n, 0);
      for (int i = 0; i < n * (n + 1); ++i)
        shear[a].values.push_back(a == 0 ? float(std::sin(2 * pi * (i / (n + 1) + 0.5) / n)) : 0.0f);
    }
    problem.velocity_grid = std::make_shared<const scene::VelocityGrid>(shear);
    const auto flow = start(problem, {{"precision", precision}});
    scene::FlowProblem still = box_problem(2, Vec3(1, 1, 0), Kind::periodic);
    still.diffusivity = nu;
    still.wave = scene::Wave{Vec3(0, 1, 0), 1, 0, 0};
    const auto smoke = start(still, {{"precision", precision}});
    flow->step(dt);
    smoke->step(dt);
    double most = 0;
    for (int j = 0; j < n; ++j) {
      const double y = (j + 0.5) / n;
      most = std::max({most,
                       std::abs(flow->velocity(Point3(0.25, y, 0))[0] - factor * double(float(std::sin(2 * pi * y)))),
                       std::abs(smoke->density(Point3(0.3, y, 0)) - factor * std::cos(2 * pi * y))});
    }
    CHECK(most < (precision == "float" ? 2e-7 : 6e-9));  // the shear comes from a file, in float
  }
}

TEST_CASE("stable fluids: a plume at steps of a thousand seconds is finite, and its smoke within bounds",
          "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  for (const char* scheme : {"semi_lagrangian", "maccormack", "bfecc"})
    for (const bool obstacle : {false, true}) {
      scene::FlowProblem problem = plume(3);
      problem.viscosity = 1e-3;
      if (obstacle) problem.obstacles = {{"ball", scene::Sphere{Point3(0.45, 0.6, 0.5), 0.15}, {}}};
      const auto flow = start(problem, {{"scheme", scheme}, {"precision", precision}});
      testing::run(*flow, 5, 1e3);
      const scene::Totals totals = flow->totals();
      CHECK(std::isfinite(totals.energy));
      CHECK(totals.density_least >= 0);
      CHECK(totals.density_greatest <= (precision == "float" ? 1 + 1e-6 : 1 + 1e-14));
      CHECK(totals.cfl > 1e3);
      // Among obstacles conjugate gradients stop at 1e-6.
      CHECK(totals.divergence < (precision == "float" ? 7e-6 : obstacle ? 6e-7 : 1e-12));
    }
}

TEST_CASE("stable fluids: a wall that splits the box leaves two parts that each keep their own", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  scene::FlowProblem problem = plume(3);
  problem.obstacles = {{"wall", scene::make_box({Point3(0.6, -1, -1), Point3(0.7, 2, 2)}), {}}};
  for (const char* pressure : {"incomplete_cholesky", "transforms_as_guess"}) {
    const auto flow = start(problem, {{"precision", precision}, {"pressure", pressure}, {"tolerance", "1e-6"}});
    testing::run(*flow, 10, 0.02);
    CHECK(flow->totals().greatest_speed > 0.05);
    CHECK(flow->totals().divergence < (precision == "float" ? 6e-7 : 2e-7));
    // Behind the wall nothing moves.
    CHECK(flow->velocity(Point3(0.85, 0.3, 0.5)).norm() < 1e-6);
    CHECK(flow->density(Point3(0.85, 0.3, 0.5)) == 0);
  }
}

TEST_CASE("stable fluids: in float nothing diverges beyond 1e-5 along long axes either", "[stable_fluids]") {
  scene::FlowProblem problem = plume(2);
  const auto flow = start(problem, {{"precision", "float"}, {"n", "1024"}});
  for (int step = 0; step < 3; ++step) {
    flow->step(0.05);
    CHECK(flow->totals().divergence < 1e-5);
  }
}

TEST_CASE("stable fluids: without a source, at rest, what is carried keeps its bits", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  scene::FlowProblem problem = box_problem(3, Vec3(1, 1, 1));
  problem.blobs.push_back({Point3(0.4, 0.5, 0.6), 0.2, 1, 0});
  for (const char* scheme : {"semi_lagrangian", "maccormack", "bfecc"}) {
    const auto flow = start(problem, {{"scheme", scheme}, {"precision", precision}});
    const auto before = std::get<scene::GridPointer>(flow->medium())->values;
    testing::run(*flow, 20, 0.1);
    CHECK(std::get<scene::GridPointer>(flow->medium())->values == before);
  }
}

TEST_CASE("stable fluids: confinement of nothing, of a little, of a thousand", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  for (const double epsilon : {0.0, 0.5, 1e3}) {
    scene::FlowProblem problem = plume(3);
    problem.confinement = epsilon;
    const auto flow = start(problem, {{"precision", precision}});
    testing::run(*flow, 20, 0.01);
    CHECK(std::isfinite(flow->totals().energy));
  }
  // Without vorticity it does nothing.
  scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::periodic);
  problem.velocity = scene::Wind{Vec3(0.25, 0.5, 0)};
  problem.confinement = 1e3;
  const auto flow = start(problem, {{"precision", precision}});
  testing::run(*flow, 4, 0.0625);
  CHECK(std::abs(flow->velocity(Point3(0.3, 0.3, 0))[0] - 0.25) < (precision == "float" ? 1e-6 : 1e-14));
}

TEST_CASE("stable fluids: what cannot be is told with step and cell, or refused", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  scene::FlowProblem problem = plume(2);
  scene::Push push;
  push.region = scene::Sphere{Point3(0.5, 0.5, 0), 0.05};
  push.time = {0.05, 1};
  push.acceleration = Vec3(0, std::nan(""), 0);
  problem.pushes.push_back(push);
  const auto flow = start(problem, {{"precision", precision}});
  testing::run(*flow, 2, 0.02);
  CHECK_THROWS_WITH(flow->step(0.02), Contains("step 3, t = 0.04 s: the velocity along"));

  problem = plume(2);
  problem.box.hi[1] = 0.9;
  CHECK_THROWS_WITH(start(problem, {}), Contains("16 cells along the longest side of the box are 14.4 along y"));

  problem = plume(2);
  problem.obstacles = {{"all", scene::Sphere{Point3(0.5, 0.5, 0), 2}, {}}};
  CHECK_THROWS_WITH(start(problem, {}), Contains("the obstacles fill the box"));
  problem.obstacles = {{"some", scene::Sphere{Point3(0.5, 0.5, 0), 0.2}, {}}};
  CHECK_THROWS_WITH(start(problem, {{"pressure", "transforms"}}), Contains("boxes without obstacles only"));
}

TEST_CASE("stable fluids: what would be without effect on a grid is refused, and a grid beyond all memory",
          "[stable_fluids]") {
  scene::FlowProblem problem = plume(2);
  problem.file = "plume.toml";
  problem.sources[0].region = scene::Sphere{Point3(0.5, 0.2, 0), 0.02};
  CHECK_THROWS_WITH(start(problem, {}),
                    Catch::StartsWith("plume.toml: source 0: its region holds no sample of cells of 0.0625 m"));
  CHECK_NOTHROW(start(problem, {{"n", "64"}}));
  // The centre of a face, which has a velocity and neither density nor temperature.
  problem.sources[0].region = scene::Sphere{Point3(0.5, 7.5 / 16, 0), 0.02};
  CHECK_THROWS_WITH(start(problem, {}), Contains("source 0: its region"));
  problem.sources[0].density.reset();
  problem.sources[0].temperature.reset();
  problem.sources[0].velocity = Vec3(1, 0, 0);
  CHECK_NOTHROW(start(problem, {}));

  problem = plume(2);
  problem.pushes.push_back({scene::Sphere{Point3(0.51, 0.51, 0), 0.005}, {0, infinity}, Vec3(1, 0, 0), 0});
  CHECK_THROWS_WITH(start(problem, {}), Contains("force 0: its region holds no sample"));
  problem.pushes.clear();
  problem.obstacles = {{"ball", scene::Sphere{Point3(0.45, 0.6, 0), 0.15}, {}},
                       {"sheet", scene::make_box({Point3(0.51, 0, -1), Point3(0.52, 1, 1)}), {}}};
  CHECK_THROWS_WITH(start(problem, {}), Contains("obstacle 1: the centre of no cell of 0.0625 m lies in it"));

  Lattice huge = make_lattice(plume(3), 16);
  CHECK_NOTHROW(require_memory(huge, 8));
  huge.n = {1 << 20, 1 << 20, 1 << 20};
  CHECK_THROWS_WITH(require_memory(huge, 4), Contains("1048576 x 1048576 x 1048576 cells: would take "));
  CHECK_THROWS_WITH(start(plume(2), {{"dt", "1e-12"}}),
                    Contains("dt = 1e-12, courant = 0 make 4.17e+10 steps of a frame"));
}

TEST_CASE("stable fluids: smoke leaves by an open side, and none is ever below nothing", "[stable_fluids]") {
  for (const char* scheme : {"semi_lagrangian", "maccormack", "bfecc"})
    for (const char* precision : {"float", "double"}) {
      scene::FlowProblem problem = box_problem(3, Vec3(1, 1, 1), Kind::open);
      problem.velocity = scene::Wind{Vec3(0.7, 0.4, -0.3)};
      problem.blobs.push_back({Point3(0.5, 0.5, 0.5), 0.25, 1, 0});
      const auto flow = start(problem, {{"scheme", scheme}, {"precision", precision}});
      double mass = flow->totals().mass;
      for (int step = 0; step < 60; ++step) {
        flow->step(0.05);
        CHECK(flow->totals().density_least >= 0);
      }
      CHECK(flow->totals().mass < 1e-3 * mass);
    }
}

TEST_CASE("stable fluids: a lid drives its box, an inflow leaves by an open side", "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(2, Vec3(2, 1, 0));
  problem.sides[0][0] = {Kind::no_slip, Vec3(0.5, 0, 0), false, 0.8, 0};
  problem.sides[0][1] = {Kind::open};
  const auto flow = start(problem, {{"n", "32"}});
  testing::run(*flow, 200, 0.05);
  // A plug flow: the same velocity and density everywhere.
  for (const double x : {0.1, 0.7, 1.9}) {
    CHECK(std::abs(flow->velocity(Point3(x, 0.4, 0))[0] - 0.5) < 1e-10);
    CHECK(std::abs(flow->density(Point3(x, 0.4, 0)) - (x < 1.9 ? 0.8 : flow->density(Point3(1.9, 0.6, 0)))) < 1e-10);
  }
}

TEST_CASE("stable fluids: a tolerance below rounding is refused", "[stable_fluids]") {
  const auto begin = [](const char* pressure, const char* precision) {
    start(plume(3), {{"pressure", pressure}, {"precision", precision}, {"tolerance", "1e-12"}});
  };
  CHECK_THROWS_WITH(
      begin("incomplete_cholesky", "float"),
      Contains("tolerance = 1e-12 is below the rounding of precision = float, expected at least 1.2e-07"));
  CHECK_NOTHROW(begin("incomplete_cholesky", "double"));
  CHECK_THROWS_WITH(begin("transforms", "float"), Contains("is not read with pressure = transforms"));
}

}  // namespace flow_test
