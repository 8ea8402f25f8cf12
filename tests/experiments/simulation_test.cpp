// Sequences of frames: what they hold, and that an end at any moment changes none of them.
#include "experiments/application/simulation.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <random>

#include "experiments/application/folder_lock.h"
#include "experiments/application/solvers.h"
#include "scene/base/error.h"
#include "scene/media/legendre_box.h"
#include "tests/experiments/rising_smoke.h"

namespace simulation_test {

using namespace airlight;
using namespace airlight::experiments;
using airlight::test::files_of;
using airlight::test::rising_smoke;
using Catch::Contains;

namespace {

Simulation simulation(const TemporaryFolder& folder, std::map<std::string, std::string> settings = {}) {
  const scene::Solver& solver = find_solver("stable_fluids", "test");
  settings.try_emplace("n", "24");
  return {std::make_shared<const scene::FlowProblem>(scene::parse_flow(rising_smoke, "smoke.toml", "")),
          solver,
          {solver.settings(), settings},
          folder.path()};
}

}  // namespace

TEST_CASE("a simulation leaves frames that a scene can show, and its history", "[simulation]") {
  const TemporaryFolder folder;
  const SimulationReport report = simulate(simulation(folder, {{"dt", "0.02"}}), {});
  CHECK(report.frames == 11);
  CHECK(report.resumed == 0);
  CHECK(report.counters.at("steps") == 30);
  const auto all = files_of(folder.path());
  CHECK(all.size() == 13);
  const std::string& history = all.at("history.csv");
  CHECK(std::count(history.begin(), history.end(), '\n') == 12);
  CHECK_THAT(history, Contains("\n10,0.5"));
  const auto frame = scene::read_vdb((folder.path() / "smoke.0010.vdb").string());
  CHECK(frame.size == Eigen::Vector3i(12, 24, 12));
  CHECK(frame.voxel_size == Approx(2.0 / 24));
  CHECK(frame.translation.isApprox(Vec3::Constant(1.0 / 24)));
  CHECK(*std::max_element(frame.values.begin(), frame.values.end()) > 0.5f);
  CHECK(scene::read_vdb((folder.path() / "smoke.0010.vdb").string(), "temperature").values.size() ==
        frame.values.size());
  CHECK_THROWS_WITH(scene::read_vdb((folder.path() / "smoke.0010.vdb").string(), "velocity"),
                    Contains("expected Tree_float_5_4_3"));

  // The files contain the flow's values.
  const Simulation again = simulation(folder, {{"dt", "0.02"}});
  const auto flow = again.solver.start(again.problem, again.settings, {});
  for (int step = 0; step < 30; ++step) flow->step(1.0 / 60);
  CHECK(flow->frame().density == frame.values);

  // All is there: nothing is computed again.
  const SimulationReport second = simulate(again, {});
  CHECK(second.resumed == 11);
  CHECK(second.times.empty());
  CHECK(files_of(folder.path()) == all);
}

TEST_CASE("a simulation that is interrupted after any step goes on with the same bits", "[simulation]") {
  const TemporaryFolder whole, broken;
  const std::map<std::string, std::string> two_steps = {{"dt", "0.025"}};
  simulate(simulation(whole, two_steps), {});
  for (int most = 1;; ++most) {
    int asked = 0;
    scene::Execution execution;
    execution.progress = [&](double) { return ++asked < most; };
    try {
      if (simulate(simulation(broken, two_steps), execution).frames == 11) break;
    } catch (const scene::Interrupted&) {
    }
  }
  CHECK(files_of(broken.path()) == files_of(whole.path()));
}

// In a problem of its own the flow begins anew with what a frame holds: the same but for the rounding of a projection.
TEST_CASE("a simulation begins with a frame of another one and goes on like it", "[simulation]") {
  const TemporaryFolder first, second;
  const scene::Solver& solver = find_solver("stable_fluids", "test");
  const scene::Settings settings(solver.settings(), {{"n", "24"}});
  const auto run = [&](const std::string& text, const TemporaryFolder& folder) {
    const auto problem =
        std::make_shared<const scene::FlowProblem>(scene::parse_flow(text, "smoke.toml", first.path().string()));
    simulate({problem, solver, settings, folder.path()}, {});
  };
  run(rising_smoke, first);
  std::string rest = rising_smoke;
  rest.replace(rest.find("0.5"), 3, "0.2");
  run(rest +
          "[start]\nfile = \"smoke.0006.vdb\"\ngrid = \"density\"\ntemperature_grid = \"temperature\"\n"
          "velocity_grid = \"velocity\"\n",
      second);
  double most = 0, greatest = 0;
  const auto a = scene::read_velocity_vdb(first.file("smoke.0010.vdb"), "velocity");
  const auto b = scene::read_velocity_vdb(second.file("smoke.0004.vdb"), "velocity");
  for (int axis = 0; axis < 3; ++axis) {
    REQUIRE(a[axis].values.size() == b[axis].values.size());
    for (std::size_t i = 0; i < a[axis].values.size(); ++i) {
      most = std::max(most, std::abs(double(a[axis].values[i]) - b[axis].values[i]));
      greatest = std::max(greatest, std::abs(double(a[axis].values[i])));
    }
  }
  CHECK(most < 6e-7 * greatest);
}

// The program itself, ended by a signal that it cannot catch.
TEST_CASE("a simulation that is killed fifty times goes on with the same bits", "[simulation][slow]") {
  const TemporaryFolder folder;
  folder.write("smoke.toml", rising_smoke);
  const std::string& arguments = airlight::test::simulate_smoke;
  REQUIRE(airlight::test::run_command(arguments + "whole", folder).code == 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> seconds(0, 0.25);
  int killed = 0;
  for (int run = 0; run < 400 && killed < 50; ++run) {
    const auto result =
        airlight::test::run_command(fmt::format("timeout -s KILL {:.3f} {}broken", seconds(random), arguments), folder);
    if (result.code == 0)  // it reached its end: from the start again
      std::filesystem::remove_all(folder.path() / "broken");
    else
      ++killed;
  }
  CHECK(killed == 50);
  REQUIRE(airlight::test::run_command(arguments + "broken", folder).code == 0);
  CHECK(files_of(folder.path() / "broken") == files_of(folder.path() / "whole"));
}

TEST_CASE("coefficients lie beside the frames, and a scene shows them", "[simulation]") {
  const std::string two = R"(
name = "two"
[flow]
duration = 0.4
frame_rate = 10
box = { lo = [0, 0, 0], hi = [1, 2, 1] }
[start]
velocity = { type = "swirl", speed = 1 }
blob = [ { center = [0.4, 1, 0.5], width = 0.4, density = 1 } ]
[[density]]
name = "red"
blob = [ { center = [0.6, 1, 0.5], width = 0.4, density = 1 } ]
)";
  const TemporaryFolder folder, broken;
  const scene::Solver& solver = find_solver("legendre_fluids", "test");
  const scene::Settings settings(solver.settings(), {{"n", "6"}, {"dt", "0.05"}});
  const auto problem = std::make_shared<const scene::FlowProblem>(scene::parse_flow(two, "two.toml", ""));
  simulate({problem, solver, settings, folder.path()}, {});
  const auto all = files_of(folder.path());
  CHECK(all.size() == 3 * 5 + 2);
  const auto flow = solver.start(problem, settings, {});
  for (int step = 0; step < 6; ++step) flow->step(0.05);
  for (const std::string name : {"two", "two.red"}) {
    const auto scene = scene::parse_scene(
        "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[film]\nwidth = 1\nheight = 1\n[[medium]]\ntype = "
        "\"legendre\"\nsigma_t = 1\nsize = [6, 6, 6]\nlo = [0, 0, 0]\nhi = [1, 2, 1]\nframe = 3\nfile = \"" +
            name + ".####.csv\"\n",
        "s.toml", folder.path().string());
    const auto& shown = std::get<scene::LegendrePointer>(scene.media.at(0).field)->coefficients();
    const scene::DensityField medium = flow->medium(name != "two");
    // The files leave out coefficients below 1e-20.
    CHECK((shown - std::get<scene::LegendrePointer>(medium)->coefficients()).cwiseAbs().maxCoeff() < 1e-20);
  }

  for (int most = 1;; ++most) {
    int asked = 0;
    scene::Execution execution;
    execution.progress = [&](double) { return ++asked < most; };
    try {
      if (simulate({problem, solver, settings, broken.path()}, execution).frames == 5) break;
    } catch (const scene::Interrupted&) {
    }
  }
  CHECK(files_of(broken.path()) == all);
  const Simulation again{problem, solver, settings, broken.path()};
  CHECK(frames_there(again).frames == 5);
  std::filesystem::remove(broken.path() / "two.red.0002.csv");
  CHECK(frames_there(again).frames == 0);
  CHECK_THROWS_WITH(simulate(again, {}), Contains("two.red.0002.csv: is gone"));
}

TEST_CASE("a folder of another simulation is refused", "[simulation]") {
  const TemporaryFolder folder;
  simulate(simulation(folder), {});
  const auto all = files_of(folder.path());
  CHECK_THROWS_WITH(simulate(simulation(folder, {{"scheme", "bfecc"}}), {}),
                    Contains("of another problem, solver, settings or program"));
  CHECK(files_of(folder.path()) == all);
  std::filesystem::remove(folder.path() / "smoke.0004.vdb");
  CHECK_THROWS_WITH(simulate(simulation(folder), {}), Contains("smoke.0004.vdb: is gone"));
  Simulation elsewhere = simulation(folder);
  elsewhere.folder = "/proc/nowhere";
  CHECK_THROWS_AS(simulate(elsewhere, {}), Error);
}

// One bit, a cut, another frame, something that is no file: none of it is taken for what was written.
TEST_CASE("a simulation's files that changed are refused, and named", "[simulation][particles]") {
  const TemporaryFolder folder;
  const scene::Solver& solver = find_solver("stable_fluids", "test");
  const auto problem = std::make_shared<const scene::FlowProblem>(scene::parse_flow(
      "name = \"f\"\n[flow]\nduration = 0.2\nframe_rate = 10\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }\n[start]\n"
      "blob = [ { center = [0.4, 0.5, 0.5], width = 0.4, density = 1, temperature = 9 } ]\n[fluid]\n"
      "gravity = [0, -9.81, 0]\nexpansion = 0.0033\n[[particles]]\ncount = 3\n",
      "f.toml", ""));
  const Simulation s{problem, solver, {solver.settings(), {{"n", "4"}}}, folder.path()};
  simulate(s, {});
  const auto all = files_of(folder.path());
  REQUIRE(all.size() == 3 * 2 + 2);
  const auto refused = [&](const std::string& name) {
    CAPTURE(name);
    CHECK_THROWS_WITH(simulate(s, {}), Catch::StartsWith((folder.path() / name).string() + ": "));
    CHECK(frames_there(s).frames == 0);
    CHECK_THAT(frames_there(s).damage, Contains(name));
    std::filesystem::remove_all(folder.path() / name);
    write_bytes(folder.file(name), all.at(name));
  };
  for (const auto& [name, bytes] : all) {
    // In `state`: the last frame ('2' to '0'), a checksum, the particles, the flow.
    const std::size_t number = name == "state" ? bytes.find('\n') + 1 : bytes.size() / 7;
    const std::size_t particles = name == "state" ? bytes.find("\n\n") + 5 : bytes.size() / 5;
    for (const std::size_t at : {number, number + 20, particles, bytes.size() / 2, bytes.size() - 1}) {
      CAPTURE(at);
      std::string changed = bytes;
      changed[at] = char(changed[at] ^ 2);
      write_bytes(folder.file(name), changed);
      refused(name);
    }
    for (const std::size_t size : {std::size_t(0), bytes.size() / 3, bytes.size() - 1}) {
      write_bytes(folder.file(name), bytes.substr(0, size));
      refused(name);
    }
    std::filesystem::remove(folder.path() / name);
    std::filesystem::create_directory(folder.path() / name);
    refused(name);
    std::filesystem::remove(folder.path() / name);
    REQUIRE(mkfifo(folder.file(name).c_str(), 0600) == 0);
    refused(name);
  }
  for (const std::string kind : {".", ".particles."}) {
    const std::string end = kind == "." ? ".vdb" : ".csv", first = "f" + kind + "0001" + end;
    write_bytes(folder.file(first), all.at("f" + kind + "0002" + end));
    write_bytes(folder.file("f" + kind + "0002" + end), all.at(first));
    CHECK_THROWS_WITH(simulate(s, {}), Contains(first + ": is not what was written there"));
    write_bytes(folder.file(first), all.at(first));
    write_bytes(folder.file("f" + kind + "0002" + end), all.at("f" + kind + "0002" + end));
  }
  CHECK(simulate(s, {}).resumed == 3);
  CHECK(files_of(folder.path()) == all);
}

// The kernel ends a lock with its process: that an end by kill -9 is gone on with is held above.
TEST_CASE("two simulations at once in one folder are refused", "[simulation]") {
  const TemporaryFolder folder;
  folder.write("smoke.toml", rising_smoke);
  std::filesystem::create_directory(folder.path() / "out");
  {
    const FolderLock lock(folder.path() / "out");
    const auto result = airlight::test::run_command(airlight::test::simulate_smoke + "out", folder);
    CHECK(result.code == 2);
    CHECK(result.err ==
          "airlight: out: another airlight writes into this folder, expected one at a time or another folder\n");
    CHECK(files_of(folder.path() / "out").empty());
  }
  CHECK(airlight::test::run_command(airlight::test::simulate_smoke + "out", folder).code == 0);
}

TEST_CASE("of two problems at once in one folder one is simulated", "[simulation]") {
  const TemporaryFolder folder;
  folder.write("smoke.toml", rising_smoke);
  const std::string other = airlight::test::simulate_smoke + "both --override flow.duration=0.2";
  for (int round = 0; round < 4; ++round) {
    const auto result = airlight::test::run_command(
        fmt::format("({}both & echo $! >pid; {}; echo $? >second; wait $(cat pid); echo $? >first)",
                    airlight::test::simulate_smoke, other),
        folder);
    const std::string first = read_bytes(folder.file("first")), second = read_bytes(folder.file("second"));
    CAPTURE(result.err);
    CHECK(((first == "0\n" && second == "2\n") || (first == "2\n" && second == "0\n")));
    CHECK(result.error_lines() == 1);
    CHECK(int(files_of(folder.path() / "both").size()) == (first == "0\n" ? 11 : 5) + 2);
    std::filesystem::remove_all(folder.path() / "both");
  }
}

TEST_CASE("particles that a simulation carries come back with it, whenever it was interrupted",
          "[simulation][particles]") {
  const std::string text = R"(
[flow]
duration = 0.3
frame_rate = 10
box = { lo = [-1, -1, -1], hi = [1, 1, 1] }
[[force]]
acceleration = [3, 5, -4]
region = { type = "sphere", center = [0.3, 0, 0], radius = 0.6 }
[[particles]]
count = 40
seed = 4
fall = [0, -3, 0]
leaving = "respawn"
[[particles]]
count = 3
)";
  const TemporaryFolder whole, broken;
  const auto simulation = [&](const TemporaryFolder& folder) {
    const scene::Solver& solver = find_solver("legendre_fluids", "test");
    return Simulation{std::make_shared<const scene::FlowProblem>(scene::parse_flow(text, "thrown.toml", "")),
                      solver,
                      {solver.settings(), {{"n", "4"}, {"cells", "6"}, {"dt", "0.05"}}},
                      folder.path()};
  };
  CHECK(simulate(simulation(whole), {}).frames == 4);
  for (int most = 1;; ++most) {
    int asked = 0;
    scene::Execution execution;
    execution.threads = 1 + most % 2;
    execution.progress = [&](double) { return ++asked < most; };
    try {
      if (simulate(simulation(broken), execution).frames == 4) break;
    } catch (const scene::Interrupted&) {
    }
  }
  const auto all = files_of(whole.path());
  CHECK(files_of(broken.path()) == all);
  const std::string &first = all.at("thrown.particles.0000.csv"), &last = all.at("thrown.particles.0003.csv");
  CHECK(std::count(first.begin(), first.end(), '\n') == 44);
  CHECK(first != last);

  std::filesystem::remove(broken.path() / "thrown.particles.0001.csv");
  CHECK(frames_there(simulation(broken)).frames == 0);
  CHECK_THROWS_WITH(simulate(simulation(broken), {}), Contains("is gone"));
}

}  // namespace simulation_test
