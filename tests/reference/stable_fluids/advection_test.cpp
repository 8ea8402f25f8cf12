// Advection where the answer is known: whole cells, bounds, walls, obstacles.
#include "reference/stable_fluids/advection.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "scene/geometry/shapes.h"
#include "tests/reference/stable_fluids/problems.h"

namespace advection_test {

using namespace airlight;
using namespace airlight::stable_fluids;
using testing::box_problem;
using testing::Kind;
using testing::start;

namespace {

const std::map<std::string, std::string> schemes[] = {{{"scheme", "semi_lagrangian"}},
                                                      {{"scheme", "semi_lagrangian"}, {"interpolation", "cubic"}},
                                                      {{"scheme", "maccormack"}},
                                                      {{"scheme", "bfecc"}},
                                                      {{"scheme", "bfecc"}, {"interpolation", "cubic"}},
                                                      {{"scheme", "maccormack"}, {"limiter", "revert"}}};

scene::FlowProblem blob_in_wind(int dimensions, const Vec3& wind, Kind sides) {
  scene::FlowProblem problem = box_problem(dimensions, Vec3(1, 1, 1), sides);
  problem.velocity = scene::Wind{wind};
  problem.velocity_stays = true;
  problem.blobs.push_back({Point3(0.4, 0.6, dimensions == 2 ? 0 : 0.3), 0.2, 1, 0});
  return problem;
}

}  // namespace

TEST_CASE("stable fluids: whole cells a step shift what is carried, bit for bit", "[stable_fluids]") {
  for (const char* precision : {"double", "float"})
    for (auto settings : schemes) {
      settings["precision"] = precision;
      const auto flow = start(blob_in_wind(3, Vec3(1, -2, 3), Kind::periodic), settings);
      const auto before = std::get<scene::GridPointer>(flow->medium());
      testing::run(*flow, 3, 1.0 / 16);
      const auto after = std::get<scene::GridPointer>(flow->medium());
      int wrong = 0;
      for (int k = 0; k < 16; ++k)
        for (int j = 0; j < 16; ++j)
          for (int i = 0; i < 16; ++i)
            wrong += after->at((i + 3) % 16, (j + 10) % 16, (k + 9) % 16) != before->at(i, j, k);
      CHECK(wrong == 0);
    }
}

TEST_CASE("stable fluids: limited schemes stay within what there was, at any step", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  for (auto settings : schemes)
    for (const double dt : {0.01, 0.3, 1e3}) {
      settings["precision"] = precision;
      scene::FlowProblem problem = blob_in_wind(2, Vec3::Zero(), Kind::free_slip);
      problem.velocity = scene::Swirl{1};
      const auto flow = start(problem, settings);
      const auto before = flow->totals();
      testing::run(*flow, 5, dt);
      const auto after = flow->totals();
      INFO(settings.at("scheme") << " dt " << dt);
      CHECK(after.density_greatest <= before.density_greatest * (precision == "float" ? 1 + 1e-6 : 1 + 1e-14));
      CHECK(after.density_least >= 0);
      CHECK(std::isfinite(after.mass));
    }
}

TEST_CASE("stable fluids: ten thousand tiny steps lose what interpolation loses", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  // A wave that moves a millionth of a cell a step: the factor of a step is |1 - f + f exp(-i theta)|.
  scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::periodic);
  problem.velocity = scene::Wind{Vec3(1, 0, 0)};
  problem.velocity_stays = true;
  problem.wave = scene::Wave{Vec3(2, 0, 0), 1, 0, 0};
  const auto flow = start(problem, {{"scheme", "semi_lagrangian"}, {"n", "8"}, {"precision", precision}});
  const int steps = 10000;
  const double dt = 1e-6, f = dt * 8, theta = 2 * pi * 2 / 8;
  testing::run(*flow, steps, dt);
  const std::complex<double> factor = std::pow(1 - f + f * std::exp(std::complex<double>(0, -theta)), steps);
  for (int i = 0; i < 8; ++i) {
    const double expected = (factor * std::exp(std::complex<double>(0, theta * (i + 0.5)))).real();
    // In float each step rounds three times, by half of the last place of numbers below 1.
    const double rounding = precision == "float" ? steps * 3 * std::ldexp(1.0, -25) * 2 : 1e-11;
    CHECK(std::abs(flow->density(Point3((i + 0.5) / 8, 0.5 / 8, 0)) - expected) < rounding);
  }
}

TEST_CASE("stable fluids: nothing gets through an obstacle of one cell", "[stable_fluids]") {
  const std::string precision = GENERATE("float", "double");
  for (auto settings : schemes)
    for (const Vec3& wind : {Vec3(3, 0, 0), Vec3(3, 2, -1), Vec3(40, 25, 0)}) {
      scene::FlowProblem problem = blob_in_wind(3, wind, Kind::free_slip);
      problem.blobs.clear();
      scene::Source source;
      source.region = scene::Sphere{Point3(0.2, 0.5, 0.5), 0.15};
      source.density = 1;
      problem.sources = {source};
      problem.obstacles = {{"wall", scene::make_box({Point3(0.5, -1, -1), Point3(0.5 + 1.0 / 16, 2, 2)}), {}}};
      settings["precision"] = precision;
      const auto flow = start(problem, settings);
      const auto mass_behind = [&] {
        const auto grid = std::get<scene::GridPointer>(flow->medium());
        double sum = 0;
        for (int k = 0; k < 16; ++k)
          for (int j = 0; j < 16; ++j)
            for (int i = 9; i < 16; ++i) sum += grid->at(i, j, k);
        return sum;
      };
      testing::run(*flow, 20, 0.02);
      CHECK(mass_behind() == 0);
      CHECK(flow->totals().mass > 0.005);
    }
}

}  // namespace advection_test
