// Experiments of kind "flow": figures at named times, references and their store, histories, what is refused.
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/application/solvers.h"
#include "experiments/driver/run.h"
#include "experiments/judging/flow_metrics.h"
#include "scene/base/error.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace flows_test {

using namespace airlight;
using namespace airlight::experiments;
using airlight::test::replaced;
using Catch::Contains;

namespace {

const std::string vortex = R"([flow]
dimensions = 2
duration = 1
frame_rate = 4
box = { lo = [0, 0], hi = [6.283185307179586, 6.283185307179586] }
[sides]
all = { type = "periodic" }
[fluid]
viscosity = 0.05
[start]
velocity = { type = "taylor_green" }
)";

const std::string experiment = R"(kind = "flow"
title = "Vortices"
orders = true
metrics = ["velocity.rel_l2", "velocity.rel_l2@0.5", "energy_drift", "energy_drift@0", "divergence_max"]
[[scene]]
file = "flows/vortex.toml"
[reference]
solver = "exact"
[[method]]
name = "grid"
solver = "stable_fluids"
settings = { courant = 0.3, precision = "double" }
sweep = { key = "n", values = [8, 16, 32] }
[[plot]]
x = "column.time"
y = "column.energy"
[[plot]]
x = "setting"
y = "cell_seconds"
[[gate]]
method = "grid"
setting = 32
metric = "velocity.rel_l2"
at_most = 0.05
[profile.quick]
budget = 0
)";

struct Project : TemporaryFolder {
  explicit Project(const std::string& text = experiment, const std::string& problem = vortex) {
    write("experiments/g/e.toml", text);
    write("experiments/flows/vortex.toml", problem);
  }
  Outcome run(bool resume = false) const {
    return run_experiment(read_experiment(path(), "g/e", "quick"), {path(), resume, 1, false});
  }
  std::string result(const char* name) const { return read_bytes((path() / "results/g/e" / name).string()); }
  std::string complaint() const {
    return test::message_of([&] { run(); });
  }
};

double figure(const Row& row, const std::string& name) {
  const auto found = quantity(row, name);
  REQUIRE(found);
  return found->value;
}

scene::Totals totals(double energy, double mass, double height) {
  scene::Totals t;
  t.energy = energy;
  t.mass = mass;
  t.density_least = -0.1 * mass;
  t.divergence = 1 / energy;
  t.center_of_mass = Point3(0, height, 0);
  return t;
}

}  // namespace

TEST_CASE("flows are judged at named times", "[driver][flow]") {
  const Project project;
  const Outcome outcome = project.run();
  REQUIRE(outcome.rows.size() == 3);
  const Row& fine = outcome.rows[2];
  // The energy of the vortices decays by exp(-4 viscosity t); a grid of 32 cells loses a little more.
  CHECK(figure(fine, "energy_drift@0") == 0);
  CHECK(figure(fine, "energy_drift") == Approx(std::exp(-0.2) - 1).margin(0.03));
  CHECK(figure(fine, "velocity.rel_l2") > figure(fine, "velocity.rel_l2@0.5"));
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(figure(outcome.rows[i], "velocity.rel_l2") > 1.7 * figure(outcome.rows[i + 1], "velocity.rel_l2"));
  CHECK(outcome.gates.front().passed);
  // A history of five frames, drawn and kept.
  CHECK(fine.columns.at("time") == std::vector<double>{0, 0.25, 0.5, 0.75, 1});
  CHECK_THAT(project.result("plots/column.energy_against_column.time.vortex.csv"), Contains("grid 32,0.25,"));
  CHECK(figure(fine, "step_seconds") * fine.counters.at("steps") == Approx(fine.seconds.value));
  CHECK(figure(fine, "cell_seconds") * 1024 == Approx(figure(fine, "step_seconds")));
  CHECK_THAT(project.result("table.md"), Contains("| vortex | grid | velocity.rel_l2 | 8, 16, 32 |"));
  // The second time the reference comes from the store, and the rows from the journal.
  CHECK_FALSE(outcome.references.front().cached);
  const Outcome again = project.run(true);
  CHECK(again.references.front().cached);
  CHECK(again.rows[2].columns == fine.columns);
  CHECK(again.rows[2].times == fine.times);
}

TEST_CASE("another solver may be the reference of flows", "[driver][flow]") {
  const Project project(
      replaced(experiment, "solver = \"exact\"\n",
               "solver = \"stable_fluids\"\nsettings = { n = 32, courant = 0.3, precision = \"double\" }\n"));
  const Outcome outcome = project.run();
  CHECK(figure(outcome.rows[2], "velocity.rel_l2") == 0);
  CHECK(figure(outcome.rows[1], "velocity.rel_l2") > 0.01);
}

TEST_CASE("what is wrong with experiments of flows is one line", "[driver][flow]") {
  const auto wrong = [](const std::string& what, const std::string& by) {
    return Project(replaced(experiment, what, by)).complaint();
  };
  CHECK_THAT(wrong("\"divergence_max\"", "\"divergence\""),
             Contains("e.toml:4:11: unknown metric 'divergence' of flows") && Contains("divergence_max"));
  CHECK_THAT(wrong("l2@0.5", "l2@soon"), Contains("expected a time in seconds after the @"));
  CHECK_THAT(wrong("l2@0.5", "l2@0.3"), Contains("expected the time of a frame, a multiple of 0.25 s up to 1 s"));
  CHECK_THAT(wrong("l2@0.5", "l2@1.25"), Contains("up to 1 s"));
  CHECK_THAT(wrong("[reference]\nsolver = \"exact\"\n", ""), Contains("there is velocity.rel_l2 and no [reference]"));
  CHECK_THAT(wrong("solver = \"stable_fluids\"", "solver = \"stable_fluid\""), Contains("nearest: stable_fluids"));
  CHECK_THAT(wrong("courant", "curant"), Contains("curant"));
  CHECK_THAT(wrong("y = \"column.energy\"", "y = \"energy_drift\""), Contains("expected both columns or none"));
  CHECK_THAT(Project(experiment, replaced(vortex, "all = { type = \"periodic\" }", "all = { type = \"no_slip\" }"))
                 .complaint(),
             Contains("reference exact: no closed form is known here for Taylor-Green beside sides"));
}

TEST_CASE("what a solver cannot solve is a note in its row", "[driver][flow]") {
  const std::string ball = vortex + "[[obstacle]]\ntype = \"sphere\"\ncenter = [3, 3, 0]\nradius = 1\n";
  std::string text = replaced(experiment, "\"velocity.rel_l2\", \"velocity.rel_l2@0.5\", ", "");
  text = replaced(text, "[reference]\nsolver = \"exact\"\n", "");
  text =
      replaced(text, "[[gate]]\nmethod = \"grid\"\nsetting = 32\nmetric = \"velocity.rel_l2\"\nat_most = 0.05\n", "");
  const Project project(replaced(text, "courant = 0.3", "courant = 0.3, pressure = \"transforms\""), ball);
  const Outcome outcome = project.run();
  CHECK_THAT(outcome.rows.front().note, Contains("not supported") && Contains("without obstacles"));
}

TEST_CASE("figures of flows by hand", "[flow]") {
  FlowMoment m;
  m.totals = {totals(2, 1, 0.5), totals(1, 2, 0.3), totals(1.5, 3, 0.4)};
  CHECK(flow_figure("energy_drift", m) == Approx(-0.25));
  CHECK(flow_figure("mass_drift", m) == Approx(2));
  CHECK(flow_figure("minimum", m) == Approx(-0.3));
  CHECK(flow_figure("divergence_max", m) == Approx(1));
  CHECK(flow_figure("energy_growth", m) == Approx(0.5));
  CHECK(flow_figure("center_falls", m) == Approx(0.2));
  // Energy that grows in many small steps has grown by all of them.
  FlowMoment creeping;
  creeping.totals = {totals(2, 1, 0.5), totals(1, 1, 0.5), totals(1.5, 1, 0.5), totals(1.75, 1, 0.5)};
  CHECK(flow_figure("energy_growth", creeping) == Approx(0.75));
  FlowSample reference;
  reference.velocity = {3, 4, 0, 0, 0, 0};
  reference.density = {0, 0, 0, 0};
  m.reference = &reference;
  m.here.velocity = {3, 4, 0, 0, 1, 0};
  m.here.density = {1, 3, 1, 3};
  m.deviation_at_start = 2;
  CHECK(flow_figure("velocity.rel_l2", m) == Approx(0.2));
  CHECK(flow_figure("velocity.greatest", m) == Approx(0.2));
  CHECK(std::isnan(flow_figure("density.rel_l2", m)));  // of nothing
  CHECK(flow_figure("density.contrast", m) == Approx(0.5));
  m.mirrored[0].density = {1, 3, 1, 2};
  CHECK(flow_figure("density.asymmetry", m) == Approx(1.0 / 3));
}

namespace {

// d_t + u.grad d - diffusivity lap d + decay d, by differences, over the size of its terms.
double residual_of(const std::string& text, const Point3& x, double t) {
  const auto problem = std::make_shared<const scene::FlowProblem>(scene::parse_flow(text, "p", "."));
  const scene::Solver& exact = find_solver("exact", "test");
  const auto at = [&](const Point3& y, double time) {
    const auto flow = exact.start(problem, scene::Settings(exact.settings(), {}, "exact"), {});
    flow->step(time);
    return flow->density(y);
  };
  const double h = 1e-4;
  const auto flow = exact.start(problem, scene::Settings(exact.settings(), {}, "exact"), {});
  flow->step(t);
  const Vec3 u = flow->velocity(x);
  double sum = (at(x, t + h) - at(x, t - h)) / (2 * h), size = std::abs(sum);
  for (int a = 0; a < 2; ++a) {
    const Vec3 step = h * Vec3::Unit(a);
    const double low = at(x - step, t), here = at(x, t), high = at(x + step, t);
    sum += u[a] * (high - low) / (2 * h) - problem->diffusivity * (high - 2 * here + low) / (h * h);
    size += std::abs(u[a] * (high - low) / (2 * h));
  }
  return std::abs(sum + problem->decay * at(x, t)) / (size + 1e-3);
}

}  // namespace

TEST_CASE("closed forms satisfy the equation of what is carried", "[flow]") {
  const std::string box = "[flow]\ndimensions = 2\nduration = 1\nbox = { lo = [0, 0], hi = [1, 2] }\n";
  const std::string periodic = "[sides]\nall = { type = \"periodic\" }\n";
  for (const Point3& x : {Point3(0.3, 0.4, 0), Point3(0.71, 1.6, 0)}) {
    CHECK(
        residual_of(
            box + periodic +
                "[fluid]\ndiffusivity = 0.01\ndecay = 0.3\n[start]\nvelocity = { type = \"wind\", velocity = [1, -0.5, 0] "
                "}\nwave = { waves = [2, 1, 0], density = 1, offset = 2, phase = 0.4 }\n",
            x, 0.6) < 1e-5);
    CHECK(
        residual_of(
            box + periodic +
                "[fluid]\ndecay = 0.2\n[start]\nvelocity = { type = \"wind\", velocity = [0.3, 0.2, 0] }\n[[start.blob]]\n"
                "center = [0.4, 1, 0]\nwidth = 0.3\ndensity = 1\n",
            x, 0.6) < 1e-5);
    CHECK(
        residual_of(
            box +
                "[start]\nvelocity = { type = \"rotation\", center = [0.5, 1, 0], rate = [0, 0, 1.5] }\nvelocity_stays = "
                "true\n[[start.blob]]\ncenter = [0.4, 1, 0]\nwidth = 0.3\ndensity = 1\n",
            x, 0.6) < 1e-5);
  }
}

TEST_CASE("closed forms are refused by name where there is none", "[flow]") {
  const scene::Solver& exact = find_solver("exact", "test");
  const auto why = [&](const std::string& more) {
    const scene::FlowProblem p = scene::parse_flow(
        "[flow]\ndimensions = 2\nduration = 1\nbox = { lo = [0, 0], hi = [1, 1] }\n" + more, "p", ".");
    const auto reasons = exact.supports(p, scene::Settings(exact.settings(), {}, "exact"));
    return reasons.empty() ? std::string("none") : reasons.front();
  };
  CHECK(why("") == "none");
  CHECK_THAT(why("[start]\nvelocity = { type = \"swirl\" }\n"), Contains("a swirl or a rotation that moves itself"));
  CHECK_THAT(why("[start]\nvelocity = { type = \"wind\", velocity = [1, 0, 0] }\n"), Contains("wind through sides"));
  CHECK_THAT(why("[fluid]\ndiffusivity = 0.1\n[[start.blob]]\ncenter = [0.5, 0.5, 0]\nwidth = 0.1\ndensity = 1\n"),
             Contains("diffusion of anything but waves"));
  CHECK_THAT(why("[[force]]\nacceleration = [1, 0, 0]\n"), Contains("forces"));
  CHECK_THAT(why("[[source]]\nregion = { type = \"sphere\", center = [0.5, 0.5, 0], radius = 0.2 }\ndensity = 1\n"),
             Contains("sources"));
}

}  // namespace flows_test
