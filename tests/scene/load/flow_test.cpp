// Flow problems: what their files say, and what is refused, with its place.
#include <sstream>

#include "scene/flow/flow_problem.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace flow_test {

using namespace airlight;
using namespace airlight::scene;
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string flow_of_box = "[flow]\nduration = 2\nbox = { lo = [0, 0, 0], hi = [1, 2, 1] }\n";

const std::string all_keys = R"(
name = "all"
[flow]
duration = 3
frame_rate = 30
box = { lo = [-1, 0, -1], hi = [1, 4, 1] }
[sides]
all = { type = "free_slip" }
bottom = { type = "inflow", velocity = [0, 0.5, 0], density = 0.2, temperature = 3 }
top = { type = "open" }
left = { type = "moving", velocity = [0, 1, 0], regularized = true }
front = { type = "no_slip" }
[fluid]
viscosity = 1e-5
diffusivity = 2e-5
decay = 0.1
gravity = [0, -9.81, 0]
weight = 0.3
expansion = 0.003
confinement = 0.2
[start]
velocity = { type = "wind", velocity = [0.1, 0, 0] }
density = 0.01
temperature = 1
wave = { waves = [1, 0, 2], density = 0.1 }
[[start.blob]]
center = [0, 1, 0]
width = 0.3
density = 1
[[source]]
region = { type = "sphere", center = [0, 0.5, 0], radius = 0.2 }
from = 0.5
to = 2
density_rate = 4
temperature = 100
velocity = [0, 2, 0]
[[obstacle]]
type = "sphere"
center = [0.3, 2, 0]
radius = 0.4
[[force]]
region = { type = "box", lo = [-1, 1, -1], hi = [1, 2, 1] }
acceleration = [1, 0, 0]
frequency = 0.5
)";

FlowProblem flow(const std::string& text) { return parse_flow(text, "f.toml", "."); }

std::string refusal(const std::string& text) {
  return test::message_of([&] { flow(text); });
}

}  // namespace

TEST_CASE("flow problems: all keys", "[flow][load]") {
  const FlowProblem p = flow(all_keys);
  CHECK(p.name == "all");
  CHECK(p.duration == 3);
  CHECK(p.frame_rate == 30);
  CHECK(p.box.hi == Point3(1, 4, 1));
  CHECK(p.sides[1][0].kind == Side::Kind::no_slip);
  CHECK(p.sides[1][0].velocity[1] == 0.5);
  CHECK(p.sides[1][0].density == 0.2);
  CHECK(p.sides[1][1].kind == Side::Kind::open);
  CHECK(p.sides[0][0].regularized);
  CHECK(p.sides[0][1].kind == Side::Kind::free_slip);
  CHECK(p.sides[2][1].kind == Side::Kind::no_slip);
  CHECK(p.weight == 0.3);
  CHECK(std::get<Wind>(p.velocity).velocity[0] == 0.1);
  CHECK(start_density(p, Point3(0, 1, 0)) == Approx(0.01 + 1 + 0.1 * std::cos(2 * pi * (0.5 + 1))));
  CHECK(start_temperature(p, Point3(0, 1, 0)) == 1);
  REQUIRE(p.sources.size() == 1);
  CHECK(p.sources[0].time.hi == 2);
  CHECK(*p.sources[0].temperature == 100);
  CHECK_FALSE(p.sources[0].density);
  CHECK(p.obstacles.size() == 1);
  CHECK(p.pushes[0].frequency == 0.5);
}

TEST_CASE("flow problems: several densities, each with a start, sources and sides of its own", "[flow][load]") {
  const FlowProblem p = flow(flow_of_box +
                             "[start]\ndensity = 0.5\n[[density]]\nname = \"red\"\ndensity = 0.25\n"
                             "blob = [ { center = [0, 1, 0], width = 1, density = 2 } ]\n[[density]]\nname = \"b_2\"\n"
                             "wave = { waves = [1, 0, 0], density = 1, offset = 1 }\n"
                             "[sides]\nleft = { type = \"inflow\", velocity = [1, 0, 0], density = 3, of = \"b_2\" }\n"
                             "right = { type = \"open\" }\n"
                             "[[source]]\nregion = { type = \"unbounded\" }\ndensity_rate = 7\nof = \"red\"\n");
  REQUIRE(p.densities.size() == 2);
  CHECK(start_density(p, Point3(0, 1, 0)) == 0.5);
  const FlowProblem red = with_density(p, 1), second = with_density(p, 2);
  CHECK(start_density(red, Point3(0, 1, 0)) == 2.25);
  CHECK(start_density(second, Point3(0, 1, 0)) == 2);
  CHECK(red.sources[0].density_rate == 7);
  CHECK(second.sources[0].density_rate == 0);
  CHECK(red.sides[0][0].density == 0);
  CHECK(second.sides[0][0].density == 3);
  CHECK(red.hash != second.hash);
  CHECK(flow(flow_of_box + "[[density]]\nname = \"a\"\n").hash !=
        flow(flow_of_box + "[[density]]\nname = \"b\"\n").hash);
  const Wind wind = std::get<Wind>(
      flow(flow_of_box +
           "[start]\nvelocity = { type = \"wind\", velocity = [1, 0, 0], gust = [0, 2, 0], frequency = 0.5 }\n")
          .velocity);
  CHECK(wind.at(0.5).isApprox(Vec3(1, 2, 0)));
}

TEST_CASE("flow problems: equal content, equal hash", "[flow][load]") {
  const std::string other =
      "name = \"b\"\n[flow]\nbox = { hi = [1, 2, 1.0], lo = [0, 0, 0] }\nduration = 2.0\nframe_rate = 24\n";
  const std::string hash = flow(flow_of_box).hash;
  CHECK(hash.size() == 32);
  CHECK(flow(other).hash == hash);
  for (const char* change :
       {"[fluid]\nviscosity = 1e-3", "[fluid]\ngravity = [0, -1, 0]", "[sides]\ntop = { type = \"open\" }",
        "[start]\ndensity = 0.5", "[start]\nvelocity = { type = \"swirl\" }", "[[force]]\nacceleration = [0, 0, 1]",
        "[[source]]\nregion = { type = \"unbounded\" }\ndensity = 1",
        "[[source]]\nregion = { type = \"unbounded\" }\ndensity_rate = 1",
        "[[obstacle]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.1"})
    CHECK(flow(flow_of_box + change).hash != hash);
}

TEST_CASE("flow problems: refused with place, what was found and what was expected", "[flow][load]") {
  CHECK(refusal("") == "f.toml:1:1: missing key 'flow', expected a table");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[flow]\nduration = 1", "missing key 'box'"},
      {"[flow]\nduration = 0\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }",
       "f.toml:2:12: flow: duration = 0, expected a number in"},
      {"[flow]\nduration = 1\nbox = { lo = [0, 0, 0], hi = [1, 0, 1] }", "expected"},
      {"[flow]\nduration = 1\ndimensions = 2\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }",
       "lo = [0, 0, 0], expected a list of numbers: 2"},
      {"[flow]\nduration = 1\ndimensions = 4\nbox = { lo = [0, 0], hi = [1, 1] }", "dimensions = 4, expected"},
      {flow_of_box + "[fluids]\nviscosity = 1", "unknown key 'fluids'"},
      {flow_of_box + "[fluid]\nviscosity = -1", "viscosity = -1, expected"},
      {flow_of_box + "[fluid]\nviscosity = nan", "viscosity = nan, expected"},
      {flow_of_box + "[fluid]\nviscosity = \"thick\"", "expected"},
      {flow_of_box + "[sides]\nleft = { type = \"periodic\" }",
       "left and right are opposite sides, expected both periodic or none"},
      {flow_of_box + "[sides]\ntop = { type = \"moving\", velocity = [1, 1, 0] }",
       "expected 0 along y: a wall moves in its plane"},
      {flow_of_box + "[sides]\ntop = { type = \"inflow\", velocity = [1, 0, 0] }",
       "expected a number other than 0 along y"},
      {flow_of_box + "[sides]\ntop = { type = \"inflow\", velocity = [0, 1, 0], density = 1 }",
       "density has no effect: the velocity points outwards"},
      {flow_of_box + "[sides]\ntop = { type = \"wall\" }", "type = \"wall\", expected one of"},
      {flow_of_box + "[[source]]\nregion = { type = \"sphere\", center = [5, 5, 5], radius = 1 }\ndensity = 1",
       "region lies outside the box of the flow"},
      {flow_of_box + "[[source]]\nregion = { type = \"unbounded\" }", "nothing comes from it, expected density_rate"},
      {flow_of_box + "[[source]]\nregion = { type = \"unbounded\" }\ndensity = 1\nfrom = 2\nto = 1",
       "to = 1, expected a time after 2 s"},
      {flow_of_box + "[[obstacle]]\ntype = \"plane\"\npoint = [0, 0, 0]", "this surface encloses nothing"},
      {flow_of_box +
           "[[obstacle]]\ntype = \"tube\"\npath = [[0, 0, 0], [1, 0, 0]]\nradius = 0.1\nsize = [4, 8]\ncaps = false",
       "this surface encloses nothing"},
      {flow_of_box + "[[force]]\nacceleration = [1, inf, 0]", "expected"},
      {flow_of_box + "[[force]]\nregion = { type = \"box\", lo = [2, 0, 0], hi = [3, 1, 1] }\nacceleration = [1, 0, 0]",
       "f.toml:5:10: force 0: region lies outside the box of the flow"},
      {flow_of_box + "[[obstacle]]\ntype = \"sphere\"\ncenter = [9, 0, 0]\nradius = 1",
       "f.toml:4:1: obstacle 0: this surface lies outside the box of the flow"},
      {flow_of_box + "[[obstacle]]\ntype = \"box\"\nlo = [0, 2.1, 0]\nhi = [1, 3, 1]",
       "f.toml:4:1: obstacle 0: this surface lies outside the box of the flow"},
      {flow_of_box + "[[obstacle]]\ntype = \"sphere\"\ncenter = [0.5, 1, 0.5]\nradius = 1.3",
       "f.toml:4:1: obstacle 0: this sphere fills the box"},
      {flow_of_box + "[sides]\nleft = { type = \"inflow\", velocity = [3, 1, 0] }",
       "f.toml:4:1: sides: 6 m^3/s flow into the box, and no side is open, expected as much in as out"},
      {flow_of_box + "[sides]\nleft = { type = \"inflow\", velocity = [3, 0, 0] }\ntop = { type = \"inflow\", velocity "
                     "= [0, 7, 0] }",
       "1 m^3/s flow out of the box"},
      {"[flow]\nduration = 1e9\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }",
       "f.toml:2:12: flow: duration = 1000000000, expected at most 1e+07 frames, 24 of them a second"},
      {"[flow]\nduration = 1\nbox = { lo = [0, nan, 0], hi = [1, 1, 1] }",
       "f.toml:3:18: flow: box: lo[1] = nan, expected"},
      {"[flow]\nduration = 1\nframe_rate = 0\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }",
       "f.toml:3:14: flow: frame_rate = 0, expected"},
      {flow_of_box + "[start]\nvelocity = { type = \"wind\" }", "missing key 'velocity'"},
      {flow_of_box + "[start]\nvelocity = { type = \"wind\", velocity = [1, 0, 0], gust = [1, 0, 0] }",
       "missing key 'frequency'"},
      {flow_of_box + "[[density]]\ndensity = 1", "density 0: missing key 'name'"},
      {flow_of_box + "[[density]]\nname = \"../a\"", "f.toml:5:8: density 0: name = \"../a\", expected small letters"},
      {flow_of_box + "[[density]]\nname = \"velocity\"", "f.toml:5:8: density 0: there is a velocity already"},
      {flow_of_box + "[[density]]\nname = \"a\"\ngrid = \"a\"", "grid has no effect: there is no file"},
      {flow_of_box + "[[source]]\nregion = { type = \"unbounded\" }\ndensity = 1\nof = \"red\"",
       "source 0: of = \"red\", expected"},
      {flow_of_box + "[[source]]\nregion = { type = \"unbounded\" }\ntemperature = 1\nof = \"density\"",
       "source 0: of has no effect: there is no density"},
      {flow_of_box + "[start]\nfile = \"none.vdb\"", "none.vdb"},
      {flow_of_box + "[start]\ngrid = \"density\"", "grid has no effect: there is no file"}};
  for (const auto& [text, says] : cases) {
    INFO(text);
    CHECK_THAT(refusal(text), StartsWith("f.toml:") && Contains(says));
    CHECK(refusal(text).find('\n') == std::string::npos);
  }
  CHECK_THROWS_WITH(load_flow("/nowhere/f.toml"), Contains("/nowhere/f.toml"));
  // A flow that can leave may come in.
  for (const char* way_out : {"right = { type = \"open\" }", "right = { type = \"inflow\", velocity = [3, 0, 0] }",
                              "top = { type = \"inflow\", velocity = [0, 6, 0] }"})
    CHECK(refusal(flow_of_box + "[sides]\nleft = { type = \"inflow\", velocity = [3, 0, 0] }\n" + way_out).empty());
}

TEST_CASE("flow problems: every value replaced by one of another type is refused at its line, or taken",
          "[flow][load]") {
  std::vector<std::string> lines;
  std::istringstream stream(all_keys);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  int refused = 0, taken = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t at = lines[i].find(" = ");
    if (at == std::string::npos) continue;
    for (const char* value : {"\"thick\"", "nan", "-inf", "-1e300", "true", "[]", "[nan, 0, 0]", "[\"a\", 1, 2]",
                              "[[1], 2, 3]", "{}", "{ type = 3 }", "1979-05-27"}) {
      std::string text;
      for (std::size_t j = 0; j < lines.size(); ++j)
        text += (i == j ? lines[i].substr(0, at + 3) + value : lines[j]) + "\n";
      const std::string message = refusal(text);
      INFO(lines[i] << " with " << value << ": " << message);
      // Text is a name, a flag of nothing here: all else has a type of its own.
      if (message.empty()) {
        ++taken;
        CHECK(lines[i].substr(0, at) == "name");
        continue;
      }
      ++refused;
      CHECK_THAT(message, StartsWith("f.toml:" + std::to_string(i + 1) + ":") &&
                              (Contains("expected") || Contains("missing key")));
      CHECK(message.find('\n') == std::string::npos);
    }
  }
  CHECK(taken == 1);
  CHECK(refused > 400);
}

}  // namespace flow_test
