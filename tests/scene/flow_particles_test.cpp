// Particles that a flow carries, in flows whose paths are known.
#include "scene/flow/flow_particles.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace flow_particles_test {

using namespace airlight;
using Catch::Contains;

namespace {

constexpr double box = 1;  // half its size

// u = (-y(1-x^2), x(1-y^2), 0) times a rate: nothing passes the walls, and psi = (1-x^2)(1-y^2)/2 stays on each path.
class Swirl : public scene::Flow {
 public:
  explicit Swirl(double rate = 1) : rate_(rate) {}
  double time() const override { return 0; }
  void step(double) override {}
  Vec3 velocity(const Point3& x) const override {
    return rate_ * Vec3(-x[1] * (1 - x[0] * x[0]), x[0] * (1 - x[1] * x[1]), 0);
  }
  double density(const Point3&) const override { return 0; }
  double temperature(const Point3&) const override { return 0; }
  scene::DensityField medium(int) const override { return scene::Homogeneous{}; }
  scene::Frame frame() const override { return {}; }
  scene::Totals totals() const override { return {}; }
  std::vector<scene::StageTime> times() const override { return {}; }
  std::map<std::string, double> counters() const override { return {}; }
  std::string state() const override { return ""; }
  void restore(const std::string&) override {}

 private:
  double rate_;
};

double psi(const Point3& x) { return 0.5 * (1 - x[0] * x[0]) * (1 - x[1] * x[1]); }

scene::FlowProblem problem(int count, scene::ParticleSet::Leaving leaving = scene::ParticleSet::Leaving::stay,
                           const Vec3& fall = Vec3::Zero()) {
  scene::FlowProblem p;
  p.box = {Point3::Constant(-box), Point3::Constant(box)};
  p.particles.push_back({count, {}, 5, fall, leaving});
  return p;
}

// The greatest change of psi over 20 time units.
double drift(double dt) {
  scene::FlowParticles particles(problem(300));
  const std::vector<Point3> start = particles.positions()[0];
  const Swirl flow;
  for (int step = 0; step < std::lround(20 / dt); ++step) particles.step(flow, flow, dt, {});
  double greatest = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    greatest = std::max(greatest, std::abs(psi(particles.positions()[0][i]) - psi(start[i])));
  return greatest;
}

}  // namespace

TEST_CASE("particles stay on their stream lines to the fourth order of the step", "[particles][flow]") {
  const double coarse = drift(0.2), middle = drift(0.1), fine = drift(0.05);
  CAPTURE(coarse, middle, fine);
  CHECK(coarse < 1e-3);
  CHECK(std::log2(coarse / middle) > 3.7);
  CHECK(std::log2(middle / fine) > 3.8);
}

TEST_CASE("the velocity between two states of a flow is linear in time", "[particles][flow]") {
  // Along a path of the swirl only the integral of its rate counts: that of 1 + t up to t = 1 is 1.5.
  scene::FlowParticles exact(problem(100));
  for (int step = 0; step < 1500; ++step) exact.step(Swirl(1), Swirl(1), 1e-3, {});
  const auto error = [&](int steps) {
    scene::FlowParticles particles(problem(100));
    const double dt = 1.0 / steps;
    for (int i = 0; i < steps; ++i) particles.step(Swirl(1 + i * dt), Swirl(1 + (i + 1) * dt), dt, {});
    double greatest = 0;
    for (std::size_t i = 0; i < 100; ++i)
      greatest = std::max(greatest, (particles.positions()[0][i] - exact.positions()[0][i]).norm());
    return greatest;
  };
  const double coarse = error(10), fine = error(20);
  CAPTURE(coarse, fine);
  CHECK(coarse < 1e-4);
  CHECK(std::log2(coarse / fine) > 3.7);
}

TEST_CASE("particles never leave the box, whatever carries them", "[particles][flow]") {
  using Leaving = scene::ParticleSet::Leaving;
  for (const Leaving leaving : {Leaving::stay, Leaving::wrap, Leaving::respawn}) {
    scene::FlowParticles particles(problem(200, leaving, Vec3(0.3, -1, 5)));
    const Swirl flow(3);
    for (int step = 0; step < 100; ++step) {
      particles.step(flow, flow, 0.3, {});
      for (const Point3& x : particles.positions()[0]) REQUIRE(x.cwiseAbs().maxCoeff() <= box);
    }
    double mean = 0;
    for (const Point3& x : particles.positions()[0]) mean += x[2] / 200;
    if (leaving == Leaving::stay)
      CHECK(mean == Approx(1));  // all are at the wall that they fall to
    else
      CHECK(std::abs(mean) < 0.3);
  }
}

TEST_CASE("what leaves comes back on the other side: there, or anywhere on it", "[particles][flow]") {
  using Leaving = scene::ParticleSet::Leaving;
  const Swirl still(0);
  for (const Leaving leaving : {Leaving::wrap, Leaving::respawn}) {
    scene::FlowParticles particles(problem(100, leaving, Vec3(0, 0, 1)));
    const std::vector<Point3> start = particles.positions()[0];
    particles.step(still, still, 0.5, {});
    for (std::size_t i = 0; i < start.size(); ++i) {
      const Point3& x = particles.positions()[0][i];
      const bool left = start[i][2] > 0.5;
      CHECK(x[2] == Approx(start[i][2] + 0.5 - (left ? 2 : 0)));
      const bool same = x.head<2>() == start[i].head<2>();
      CHECK(same == (leaving == Leaving::wrap || !left));
    }
  }
}

TEST_CASE("particles do not depend on threads, and go on from their state", "[particles][flow]") {
  const auto p = problem(500, scene::ParticleSet::Leaving::respawn, Vec3(0.4, -2, 0));
  scene::FlowParticles one(p), many(p), resumed(p);
  scene::Execution single, four;
  single.threads = 1, four.threads = 4;
  const Swirl before(1), after(1.5);
  for (int step = 0; step < 10; ++step) one.step(before, after, 0.1, single);
  for (int step = 0; step < 10; ++step) many.step(before, after, 0.1, four);
  CHECK(one.csv() == many.csv());
  scene::FlowParticles broken(p);
  for (int step = 0; step < 5; ++step) broken.step(before, after, 0.1, four);
  resumed.restore(broken.state());
  for (int step = 0; step < 5; ++step) resumed.step(before, after, 0.1, single);
  CHECK(resumed.csv() == one.csv());
  CHECK(resumed.state() == one.state());
  CHECK_THROWS_WITH(resumed.restore("short"), Contains("expected 16000"));
}

TEST_CASE("sets of particles are read with the flow, and refused in one line", "[particles][flow][load]") {
  const std::string head = "[flow]\nduration = 1\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }\n";
  const auto read = [&](const std::string& rest) { return scene::parse_flow(head + rest, "f.toml", ""); };
  const auto p = read("[[particles]]\ncount = 7\nseed = 3\nfall = [0, -1, 0]\nleaving = 'wrap'\n");
  REQUIRE(p.particles.size() == 1);
  CHECK(p.particles[0].count == 7);
  CHECK(p.particles[0].leaving == scene::ParticleSet::Leaving::wrap);
  CHECK(p.hash != read("").hash);
  CHECK(p.hash != read("[[particles]]\ncount = 7\nseed = 3\nfall = [0, -1, 0]\n").hash);
  CHECK_THROWS_WITH(read("[[particles]]\ncount = 0\n"), Contains("f.toml:5:9") && Contains("count = 0"));
  CHECK_THROWS_WITH(read("[[particles]]\ncount = 5\nleaving = 'bounce'\n"),
                    Contains("leaving = \"bounce\", expected one of"));
  CHECK_THROWS_WITH(read("[[particles]]\ncount = 5\nregion = { type = 'sphere', center = [9, 9, 9], radius = 1 }\n"),
                    Contains("outside the box"));
}

}  // namespace flow_particles_test
