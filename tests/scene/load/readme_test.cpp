// The documentation of the scene format is executed: its examples must load, and it must name every key there is.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scene/base/error.h"
#include "scene/flow/flow_problem.h"
#include "scene/scene.h"
#include "tests/scene/load/message.h"

namespace readme_test {

using namespace airlight;
using namespace airlight::scene;
using test::camera;

namespace {

const std::string root = AIRLIGHT_SOURCE_DIR;

std::string readme() {
  std::ifstream stream(root + "/scene/README.md");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> examples() {
  std::vector<std::string> found;
  std::istringstream lines(readme());
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (!inside && line == "```toml") {
      inside = true;
      found.emplace_back();
    } else if (inside && line == "```") {
      inside = false;
    } else if (inside) {
      found.back() += line + "\n";
    }
  }
  return found;
}

// The keys that may stand in a table: the loader lists them when it meets one that may not.
std::vector<std::string> keys_of(const std::string& table) {
  try {
    const std::string text = table + "\nno_such_key = 1\n";
    if (table.find("[flow]") == std::string::npos)
      parse_scene(camera + text, "x", "");
    else
      parse_flow(text, "x", "");
  } catch (const Error& e) {
    const std::string what = e.what();
    const std::string before = "expected one of ";
    const std::size_t begin = what.find(before);
    const std::size_t end = std::min(what.size(), what.find(" (nearest"));
    INFO(what);
    REQUIRE(begin != std::string::npos);
    std::string list = what.substr(begin + before.size(), end - begin - before.size());
    list.erase(std::remove(list.begin(), list.end(), ' '), list.end());
    std::vector<std::string> keys;
    std::istringstream parts(list);
    for (std::string key; std::getline(parts, key, ',');) keys.push_back(key);
    return keys;
  }
  FAIL("an unknown key was accepted in " + table);
  return {};
}

}  // namespace

TEST_CASE("every example of the format's documentation loads", "[load]") {
  const std::vector<std::string> all = examples();
  REQUIRE(all.size() >= 18);
  for (const std::string& example : all) {
    INFO(example);
    if (example.find("[flow]") != std::string::npos) {
      CHECK(parse_flow(example, "example", root + "/experiments/scenes").hash.size() == 32);
      continue;
    }
    const bool whole = example.find("[camera]") != std::string::npos;
    Scene scene;
    CHECK_NOTHROW(scene = parse_scene(whole ? example : camera + example, "example", root + "/experiments/scenes"));
    CHECK(scene.hash.size() == 32);
  }
}

TEST_CASE("every kind has an example in the documentation", "[load]") {
  std::string all;
  for (const std::string& example : examples()) all += example;
  for (const char* kind : {"perspective", "orthographic", "point",     "spot",         "directional",
                           "environment", "homogeneous",  "gaussians", "grid",         "mesh",
                           "sphere",      "box",          "plane",     "height_field", "displaced_sphere",
                           "torus",       "tube",         "prism",     "teapot",       "city",
                           "lambert",     "phong",        "tabulated", "rayleigh",     "hg",
                           "hazy",        "murky",        "slab",      "fogmap",       "legendre",
                           "disc",        "sheet"}) {
    INFO(kind);
    CHECK(all.find("type = \"" + std::string(kind) + "\"") != std::string::npos);
  }
}

TEST_CASE("the documentation names every key that the loader knows", "[load]") {
  const std::string text = readme(), flow = "[flow]\nduration = 1\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }\n";
  const std::vector<std::string> tables = {
      "[film]",
      "[[light]]\ntype = 'point'",
      "[[light]]\ntype = 'spot'",
      "[[light]]\ntype = 'directional'",
      "[[light]]\ntype = 'environment'",
      "[[medium]]\ntype = 'homogeneous'",
      "[[medium]]\ntype = 'gaussians'",
      "[[medium]]\ntype = 'gaussians'\n[[medium.gaussians]]",
      "[[medium]]\ntype = 'legendre'",
      "[[medium]]\ntype = 'grid'",
      "[[medium]]\ntype = 'fitted'",
      "[[medium]]\ntype = 'homogeneous'\n[medium.phase]\ntype = 'hg'",
      "[[medium]]\ntype = 'homogeneous'\n[medium.region]\ntype = 'box'",
      "[[medium]]\ntype = 'homogeneous'\n[medium.region]\ntype = 'sphere'",
      "[[medium]]\ntype = 'homogeneous'\n[medium.region]\ntype = 'slab'",
      "[[surface]]\ntype = 'mesh'",
      "[[surface]]\ntype = 'sphere'",
      "[[surface]]\ntype = 'box'",
      "[[surface]]\ntype = 'plane'",
      "[[surface]]\ntype = 'height_field'",
      "[[surface]]\ntype = 'displaced_sphere'",
      "[[surface]]\ntype = 'torus'",
      "[[surface]]\ntype = 'tube'",
      "[[surface]]\ntype = 'prism'",
      "[[surface]]\ntype = 'teapot'",
      "[[surface]]\ntype = 'city'",
      "[[surface]]\ntype = 'plane'\npoint = [0, 0, 0]\n[surface.material]\ntype = 'lambert'",
      "[[surface]]\ntype = 'plane'\npoint = [0, 0, 0]\n[surface.material]\ntype = 'phong'",
      "[[surface]]\ntype = 'plane'\npoint = [0, 0, 0]\n[surface.material]\ntype = 'tabulated'",
      "[flow]",
      flow + "[sides]",
      flow + "[sides.top]\ntype = 'moving'",
      flow + "[sides.top]\ntype = 'inflow'",
      flow + "[fluid]",
      flow + "[start]",
      flow + "[start.velocity]\ntype = 'taylor_green'",
      flow + "[start.velocity]\ntype = 'rotation'",
      flow + "[[start.blob]]",
      flow + "[start.wave]",
      flow + "[[source]]",
      flow + "[[force]]",
      flow + "[[particles]]",
      "[backdrop]",
      "[[particles]]\ntype = 'disc'",
      "[[particles]]\ntype = 'sheet'",
  };
  for (const std::string& table : tables)
    for (const std::string& key : keys_of(table)) {
      CAPTURE(table, key);
      const bool named = text.find("`" + key + "`") != std::string::npos ||
                         text.find(key + " = ") != std::string::npos || text.find("{ " + key) != std::string::npos ||
                         text.find(", " + key) != std::string::npos;
      CHECK(named);
    }
}

TEST_CASE("every scene of the experiments loads", "[load][slow]") {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root + "/experiments/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    CHECK_NOTHROW(load_scene(entry.path().string()));
    ++count;
  }
  CHECK(count >= 7);
}

TEST_CASE("every flow of the experiments loads", "[load][flow]") {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root + "/experiments/flows")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path().string());
    CHECK_NOTHROW(load_flow(entry.path().string()));
    ++count;
  }
  CHECK(count >= 8);
}

}  // namespace readme_test
