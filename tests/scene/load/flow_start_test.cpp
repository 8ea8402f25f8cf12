// Initial states of flows from files: frames come back bit for bit, other grids at their places, damage is refused.
#include <random>

#include "reference/stable_fluids/stable_fluids.h"
#include "scene/flow/flow.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace flow_start_test {

using namespace airlight;
using namespace airlight::scene;
using Catch::Contains;

namespace {

const std::string all_grids =
    "[start]\nfile = \"frame.vdb\"\ngrid = \"density\"\ntemperature_grid = \"temperature\"\n"
    "velocity_grid = \"velocity\"\n";

std::unique_ptr<Flow> start(const FlowProblem& problem, std::map<std::string, std::string> settings) {
  const stable_fluids::StableFluids solver;
  return solver.start(std::make_shared<const FlowProblem>(problem), Settings(solver.settings(), settings), {});
}

std::string refusal(const std::string& text, const TemporaryFolder& folder) {
  return test::message_of([&] { parse_flow(text, "f.toml", folder.path().string()); });
}

// (u, v, w), density and temperature linear in space, on n cells of a box from `low`.
Vec3 linear_velocity(const Point3& x) {
  return {1 + 2 * x[0] - x[1] + 0.5 * x[2], x[0] + x[1] - 3 * x[2], -x[0] + 4 * x[1] + x[2]};
}
Frame linear_frame(const Eigen::Vector3i& n, double cell, const Point3& low) {
  Frame frame;
  frame.size = n;
  frame.cell = cell;
  frame.low = low;
  const auto at = [&](double i, double j, double k) { return Point3(low + cell * Vec3(i, j, k)); };
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i) {
        const bool faces[3] = {j < n[1] && k < n[2], i < n[0] && k < n[2], i < n[0] && j < n[1]};
        const Point3 x[3] = {at(i, j + 0.5, k + 0.5), at(i + 0.5, j, k + 0.5), at(i + 0.5, j + 0.5, k)};
        for (int a = 0; a < 3; ++a) frame.velocity.push_back(faces[a] ? float(linear_velocity(x[a])[a]) : 0.0f);
        if (i == n[0] || j == n[1] || k == n[2]) continue;
        frame.density.push_back(float(10 + at(i + 0.5, j + 0.5, k + 0.5).sum()));
        frame.temperature.push_back(float(at(i + 0.5, j + 0.5, k + 0.5).sum() - 10));
      }
  return frame;
}

}  // namespace

TEST_CASE("a flow begins with the bits of a frame of another one", "[flow][load]") {
  const std::string box3 = "box = { lo = [-1, 0.1, 3], hi = [1, 1.1, 4.5] }\n",
                    box2 = "box = { lo = [-1, 0.1], hi = [1, 1.1] }\n";
  const auto smoke = [](const std::string& z) {
    return R"(
[fluid]
gravity = [0, -9.81, 0]
expansion = 0.01
weight = 0.3
[start]
velocity = { type = "taylor_green", speed = 0.7 }
[[start.blob]]
width = 0.3
density = 1
temperature = -40
center = [-0.2, 0.4, )" +
           z + "]\n";
  };
  for (const std::string sides :
       {"", "[sides]\nall = { type = \"periodic\" }\n", "[sides]\nall = { type = \"open\" }\n"})
    for (const std::string dimensions : {"2", "3"}) {
      const TemporaryFolder folder;
      const std::string box =
          "[flow]\nduration = 1\ndimensions = " + dimensions + "\n" + (dimensions == "2" ? box2 : box3) + sides;
      INFO(box);
      const std::map<std::string, std::string> settings = {{"n", "20"}};
      const auto first = start(parse_flow(box + smoke(dimensions == "2" ? "0" : "3.6"), "a.toml", ""), settings);
      for (int step = 0; step < 5; ++step) first->step(0.03);
      const Frame frame = first->frame();
      write_frame(folder.file("frame.vdb"), frame, {});

      // The values equal those of the file: a velocity that stays is not projected.
      const std::string text = box + all_grids;
      const FlowProblem given = parse_flow(text + "velocity_stays = true\n", "b.toml", folder.path().string());
      const Frame back = start(given, settings)->frame();
      CHECK(back.velocity == frame.velocity);
      CHECK(back.density == frame.density);
      CHECK(back.temperature == frame.temperature);
      CHECK(*std::min_element(back.temperature.begin(), back.temperature.end()) < -1);

      // And projected: it was free of divergence, to the rounding of float.
      const FlowProblem problem = parse_flow(text, "b.toml", folder.path().string());
      const auto second = start(problem, settings);
      const Frame begun = second->frame();
      float most = 0;
      for (std::size_t i = 0; i < frame.velocity.size(); ++i)
        most = std::max(most, std::abs(begun.velocity[i] - frame.velocity[i]));
      CHECK(most < 2e-7f);

      CHECK(begun.density == frame.density);
      CHECK(second->totals().divergence < 1e-5);
      CHECK(second->time() == 0);

      // The content counts.
      CHECK(problem.hash != given.hash);
      Frame other = frame;
      other.velocity[30] += 1e-3f;
      write_frame(folder.file("frame.vdb"), other, {});
      const std::string hash = parse_flow(text, "b.toml", folder.path().string()).hash;
      CHECK(hash != problem.hash);
      other.temperature[7] += 1;
      write_frame(folder.file("frame.vdb"), other, {});
      CHECK(parse_flow(text, "b.toml", folder.path().string()).hash != hash);
    }
}

TEST_CASE("a flow begins with grids of other cells, staggered or not", "[flow][load]") {
  const TemporaryFolder folder;
  write_frame(folder.file("frame.vdb"), linear_frame({8, 4, 6}, 0.25, Point3(-1, 0.5, 2)), {});
  const std::string inside = "[flow]\nduration = 1\nbox = { lo = [-0.75, 0.75, 2.25], hi = [0.75, 1.25, 3.25] }\n";
  FlowProblem problem = parse_flow(inside + all_grids, "b.toml", folder.path().string());
  const auto most_wrong = [&](const Vec3& shift) {
    double most = 0;
    for (const Point3& x : {Point3(-0.7, 0.8, 2.3), Point3(0.11, 0.93, 2.61), Point3(0.75, 1.25, 3.25)})
      for (int a = 0; a < 3; ++a)
        most = std::max(
            most, std::abs(start_velocity(problem, a, x) - linear_velocity(x + shift.cwiseProduct(Vec3::Unit(a)))[a]));
    return most;
  };
  CHECK(most_wrong(Vec3::Zero()) < 3e-6);
  CHECK(start_density(problem, Point3(0.1, 0.9, 2.6)) == Approx(10 + 3.6).margin(1e-5));
  CHECK(start_temperature(problem, Point3(0.1, 0.9, 2.6)) == Approx(3.6 - 10).margin(1e-5));
  // The nearest sample up to the last face, nothing beyond.
  CHECK(start_density(problem, Point3(0.99, 1.49, 3.49)) == Approx(10 + 0.875 + 1.375 + 3.375));
  CHECK(start_density(problem, Point3(1.01, 1, 3)) == 0);
  CHECK(start_velocity(problem, 0, Point3(1.01, 0.7, 2.2)) == Approx(1 + 2 - 0.7 + 1.1).margin(0.03));
  CHECK(start_velocity(problem, 1, Point3(1.13, 0.7, 2.2)) == 0);

  // The file with a class that is not staggered: values belong to the middle of cells.
  std::string bytes = read_bytes(folder.file("frame.vdb"));
  REQUIRE(bytes.find("staggered") != std::string::npos);
  bytes.replace(bytes.find("staggered"), 9, "collocate");
  folder.write("frame.vdb", bytes);
  problem = parse_flow(inside + all_grids, "b.toml", folder.path().string());
  CHECK(most_wrong(Vec3::Constant(-0.125)) < 3e-6);

  // Without a density where only others are named.
  problem = parse_flow(inside + "[start]\nfile = \"frame.vdb\"\nvelocity_grid = \"velocity\"\n", "b.toml",
                       folder.path().string());
  CHECK_FALSE(problem.density_grid);
  CHECK_FALSE(problem.temperature_grid);
}

TEST_CASE("what no flow can begin with is refused with file, grid and voxel", "[flow][load]") {
  const TemporaryFolder folder;
  const std::string text = "[flow]\nduration = 1\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }\n" + all_grids;
  const auto says = [&](const Frame& frame, const std::string& words) {
    write_frame(folder.file("frame.vdb"), frame, {});
    const std::string message = refusal(text, folder);
    CHECK_THAT(message, Catch::StartsWith("f.toml:5:8: start: ") && Contains(words));
    CHECK(message.find('\n') == std::string::npos);
  };
  const Frame good = linear_frame({5, 4, 3}, 0.2, Point3::Zero());
  const std::size_t cell = 2 + 5 * (1 + 4 * 2), face = 3 * (2 + 6 * (1 + 5 * 2));
  for (const auto& [value, name] :
       std::vector<std::pair<float, std::string>>{{NAN, "nan"}, {INFINITY, "inf"}, {-2e6f, "-2000000"}}) {
    Frame bad = good;
    bad.density[cell] = value;
    says(bad, "frame.vdb: grid 'density': voxel (2, 1, 2) is " + name + ", expected a finite density >= 0");
    bad = good;
    bad.temperature[cell] = value;
    says(bad,
         "frame.vdb: grid 'temperature': voxel (2, 1, 2) is " + name + ", expected a temperature of at most 1000000 K");
    bad = good;
    bad.velocity[face] = 1, bad.velocity[face + 1] = value, bad.velocity[face + 2] = 3;
    says(bad, "frame.vdb: grid 'velocity': voxel (2, 1, 2) is (1, " + name +
                  ", 3), expected components of at most 1000000 m/s");
  }
  Frame far = good;
  far.low[1] = 2e9;
  says(far, "a corner of the grid comes to lie at");
  Frame dense = good;
  dense.density[cell] = 2e20f;
  says(dense, "a density of 2e+20, expected at most 1e+20");

  write_frame(folder.file("frame.vdb"), good, {});
  CHECK(refusal(text, folder).empty());
  const std::string whole = read_bytes(folder.file("frame.vdb"));
  for (const auto& [grid, words] : std::vector<std::pair<std::string, std::string>>{
           {"velocity_grid = \"density\"", "is of type Tree_float_5_4_3, expected Tree_vec3s_5_4_3"},
           {"temperature_grid = \"velocity\"", "is of type Tree_vec3s_5_4_3, expected Tree_float_5_4_3"},
           {"temperature_grid = \"heat\"", "has no grid 'heat', only: density, temperature, velocity"},
           {"velocity_grid = 3", "velocity_grid = 3, expected"}})
    CHECK_THAT(
        refusal(
            "[flow]\nduration = 1\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }\n[start]\nfile = \"frame.vdb\"\n" + grid,
            folder),
        Contains(words));
  // Cut anywhere, or with three bytes changed: it is noticed, or what is read is the same.
  const std::string hash = parse_flow(text, "f.toml", folder.path().string()).hash;
  std::mt19937 random(6);
  int noticed = 0;
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    if (i % 3 == 0)
      bytes.resize(random() % bytes.size());
    else
      for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = char(random());
    folder.write("frame.vdb", bytes);
    const std::string message = refusal(text, folder);
    noticed += !message.empty();
    CHECK(message.find('\n') == std::string::npos);
    if (message.empty()) CHECK(parse_flow(text, "f.toml", folder.path().string()).hash == hash);
  }
  CHECK(noticed > 200);
}

}  // namespace flow_start_test
