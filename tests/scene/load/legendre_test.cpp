// The keys of a Legendre box, and its tables of coefficients.
#include "scene/math/legendre.h"

#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"

namespace legendre_test {

using namespace airlight;
using namespace airlight::scene;
using test::camera;
using test::message;

namespace {

const std::string box = camera + "[[medium]]\ntype = 'legendre'\nlo = [-1, 0, 2]\nhi = [1, 3, 4]\nsize = [2, 3, 1]\n";

}  // namespace

TEST_CASE("a Legendre box lies where it says, coefficients in order", "[load][legendre]") {
  const Scene scene = parse_scene(box + "coefficients = [8, 1, 0, 0, 0, 2]\n", "s.toml", "");
  const auto& field = *std::get<LegendrePointer>(scene.media.at(0).field);
  CHECK(field.box().lo == Point3(-1, 0, 2));
  CHECK(field.box().hi == Point3(1, 3, 4));
  CHECK(field.shape() == TensorShape{2, 3, 1});
  // 8 and 1 along y; 2 of degree 1 along x, 2 along y. In the middle of the box L_2 is -sqrt(2.5)/2.
  const double flat = std::sqrt(0.5);
  CHECK(field.value({0, 0, 0}) == Approx(8 * flat * flat * flat));
  CHECK(field.value({1, 0, 0.7}) == Approx(8 * flat * flat * flat - 2 * std::sqrt(1.5) * std::sqrt(2.5) / 2 * flat));
  CHECK(density(scene.media[0], {1, 1.5, 3.7}) == Approx(field.value({1, 0, 0.7})));
}

TEST_CASE("a table of coefficients is the same as in the scene", "[load][legendre]") {
  const TemporaryFolder folder;
  folder.write("c.csv", "i,j,k,coefficient\n# the last one first\n1, 2, 0, 2\n\n0,0,0,8\n0,1,0,1.0\n");
  const Scene file = parse_scene(box + "file = 'c.csv'\n", "s.toml", folder.path().string());
  const Scene here = parse_scene(box + "coefficients = [8, 1, 0, 0, 0, 2]\n", "s.toml", "");
  CHECK(file.hash == here.hash);
  for (const char* const other : {"coefficients = [8, 1, 0, 0, 0, 2.5]", "coefficients = [8, 1, 0, 0, 2, 0]",
                                  "coefficients = [8, 1, 1e-20, 0, 0, 2]"})
    CHECK(parse_scene(box + other + "\n", "s.toml", "").hash != here.hash);
  CHECK(parse_scene(box + "coefficients = [8, 1, 0, 0, 0, 2]\n", "s.toml", "", {{"medium.0.hi", "[1, 3, 4.5]"}}).hash !=
        here.hash);
  CHECK(parse_scene(box + "coefficients = [8, 1, 0, 0, 0, 2]\n", "s.toml", "", {{"medium.0.size", "[3, 2, 1]"}}).hash !=
        here.hash);
}

TEST_CASE("bad Legendre boxes name their place", "[load][legendre]") {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "s.toml:4:1: medium 0: missing key, expected exactly one of coefficients, file"},
      {"coefficients = [1, 2]\n",
       "s.toml:9:16: medium 0: coefficients has 2 numbers, expected 6 = 2 x 3 x 1, z fastest"},
      {"coefficients = [1, 2, 3, 4, 5, 1e-21]\n", "s.toml:9:"},
      {"coefficients = [1, 2, 3, 4, 5, nan]\n", "s.toml:9:"},
      {"coefficients = [1, 2, 3, 4, 5, 1e12]\n", "s.toml:4:1: medium 0: sigma_t times the greatest density"},
      {"transform = 3\n", "s.toml:9:1: medium 0: unknown key 'transform'"},
  };
  for (const auto& [text, expected] : cases) {
    CAPTURE(text, message(box + text));
    CHECK(message(box + text).rfind(expected, 0) == 0);
  }
  const std::string sized =
      camera + "[[medium]]\ntype = 'legendre'\nlo = [0, 0, 0]\nhi = [1, 1, 1]\ncoefficients = [1]\n";
  CHECK(message(sized + "size = [33, 1, 1]\n").rfind("s.toml:9:9: ", 0) == 0);
  CHECK(message(sized + "size = [0, 1, 1]\n").rfind("s.toml:9:9: ", 0) == 0);
  CHECK(message(camera +
                "[[medium]]\ntype = 'legendre'\nlo = [0, 0, 0]\nhi = [1, 0, 1]\nsize = [1, 1, 1]\ncoefficients = [1]\n")
            .rfind("s.toml:7:6: medium 0: hi = [1, 0, 1], expected a corner", 0) == 0);
}

TEST_CASE("bad tables of coefficients name their line and column", "[load][legendre]") {
  const TemporaryFolder folder;
  const std::string header = "i,j,k,coefficient\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"i,j,coefficient\n", ":1:1: found 'i,j,coefficient', expected the header i,j,k,coefficient"},
      {header + "0,0,0\n", ":2:6: found 3 values, expected 4: i,j,k,coefficient"},
      {header + "0,0,0,1,1\n", ":2:8: found more than 4 values"},
      {header + "0,3,0,1\n", ":2:3: j = 3, expected a number in [0, 2]"},
      {header + "-1,0,0,1\n", ":2:1: i = -1, expected a number in [0, 1]"},
      {header + "0,0.5,0,1\n", ":2:3: j = 0.5, expected an integer"},
      {header + "0,0,0,x\n", ":2:7: coefficient = x, expected 0 or a number of either sign"},
      {header + "0,1,0,1\n\n0,1,0,2\n", ":4:1: found the same indices a second time"},
  };
  for (const auto& [content, expected] : cases) {
    folder.write("c.csv", content);
    const std::string what = message(box + "file = 'c.csv'\n", folder.path().string());
    CAPTURE(content, what);
    CHECK(what.find("c.csv" + expected) != std::string::npos);
  }
}

}  // namespace legendre_test
