// Every mistake a scene file can hold is one line that says where it is, what was found and what was expected.
#include <catch2/catch.hpp>

#include "tests/scene/load/message.h"

namespace bad_input_test {

using namespace airlight;
using namespace airlight::scene;
using test::camera;
using test::message;

namespace {

struct Case {
  std::string text;
  std::string begin;                 // of the message: the position
  std::vector<std::string> parts{};  // in the message
};

void check(const std::vector<Case>& cases, const std::string& before) {
  for (const Case& c : cases) {
    INFO(c.text);
    const std::string what = message(before + c.text);
    INFO(what);
    CHECK(what.rfind(c.begin, 0) == 0);
    for (const std::string& part : c.parts) {
      CAPTURE(part);
      CHECK(what.find(part) != std::string::npos);
    }
    CHECK(what.find('\n') == std::string::npos);
  }
}

const std::string homogeneous = camera + "[[medium]]\ntype = 'homogeneous'\n";  // line 6
const std::string gaussians = camera + "[[medium]]\ntype = 'gaussians'\n";
const std::string grid = camera + "[[medium]]\ntype = 'grid'\n";
const std::string point = camera + "[[light]]\ntype = 'point'\n";
const std::string spot = camera + "[[light]]\ntype = 'spot'\nposition = [0, 0, 0]\nintensity = 1\n";  // line 8
const std::string environment = camera + "[[light]]\ntype = 'environment'\n";

}  // namespace

TEST_CASE("bad files", "[load]") {
  check(
      {
          {"", "s.toml:", {"missing key 'camera'", "a table"}},
          {"[camera]\nposition = [0, 0, 5]\nposition = [0, 0, 6]\n", "s.toml:3:", {"position"}},
          {"name = \"\xff\xfe\"\n", "s.toml:1:", {}},
          {"name = \n", "s.toml:1:", {}},
          {"name = .5\n", "s.toml:1:", {}},
          {std::string("name = 'a\0b'\n", 13), "s.toml: found a zero byte at offset 9", {"expected a text file"}},
          {"name = 3\n" + camera, "s.toml:1:8: name = 3, expected a text in quotes"},
          {"ambient = 3\n" + camera,
           "s.toml:1:1: unknown key 'ambient'",
           {"expected one of name, ambient_in_scatter, film, camera, light, medium, surface"}},
          {"ambient_in_scatter = [1, 2]\n" + camera, "s.toml:1:22: ambient_in_scatter = [1, 2]", {"3 numbers, not 2"}},
          {"camera = 3\n", "s.toml:1:10: camera = 3, expected a table"},
          {"[light]\n" + camera, "s.toml:1:1: light = a table, expected a list of tables, written [[light]]"},
          {"light = [3]\n" + camera, "s.toml:1:10: light 0 = 3, expected a table"},
      },
      "");
}

// Tables in tables are walked and freed by recursion: the depth is bounded before anything is parsed, and what looks
// like depth within strings and comments is none.
TEST_CASE("deep nesting", "[load]") {
  const auto repeated = [](const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  const std::string keys = "found a key of more than 32 parts", levels = "found lists or tables in more than 32 levels";
  check(
      {
          {repeated("a.", 100000) + "a = 1\n" + camera, "s.toml:1:64: " + keys},
          {repeated("\"a\" . ", 100000) + "a = 1\n" + camera, "s.toml:1:", {keys}},
          {camera + "[" + repeated("a.", 100000) + "a]\n", "s.toml:4:65: " + keys},
          {camera + "[[" + repeated("a.", 100000) + "a]]\n", "s.toml:4:66: " + keys},
          {camera + "name = { " + repeated("a.", 40) + "a = 1 }\n", "s.toml:4:", {keys}},
          {"name = " + repeated("[", 33) + repeated("]", 33) + "\n" + camera, "s.toml:1:40: " + levels},
          {"name = " + repeated("[", 100000), "s.toml:1:40: " + levels},
          {"name = " + repeated("{a=", 100000), "s.toml:1:104: " + levels},
          {"name = " + repeated("[{a=", 100000), "s.toml:1:", {levels}},
          // A string that ends early or not at all: the parser's own words.
          {"name = \"" + repeated("[", 100) + "\n" + camera, "s.toml:1:"},
          {"name = \"\"\"" + repeated("[", 100) + "\n" + camera, "s.toml:"},
      },
      "");
  for (const std::string& name :
       {"'" + repeated("[a.", 99) + "'", "\"" + repeated("{\\\"", 99) + "\"", "'''" + repeated("[.\n", 99) + "'''''",
        "\"\"\"\"" + repeated("\"[. ", 99) + "\"\"\""}) {
    INFO(name);
    CHECK(message("name = " + name + " # " + repeated("[.", 99) + "\n" + camera).empty());
  }
  CHECK(message(std::string((1 << 24) + 1, ' ')) == "s.toml: found 16777217 bytes, expected at most 16777216");
}

TEST_CASE("bad film and camera", "[load]") {
  check(
      {
          {"[film]\nwidth = 0\n", "s.toml:5:9: film: width = 0, expected an integer from 1 to 16384"},
          {"[film]\nwidth = 64.5\n", "s.toml:5:9: film: width = 64.5, expected an integer"},
          {"[film]\nwidth = 100000\n", "s.toml:5:9: film: width = 100000"},
          {"[film]\nheigth = 64\n", "s.toml:5:1: film: unknown key 'heigth'", {"(nearest: height)"}},
      },
      camera);
  check(
      {
          {"look_at = [0, 0, 0]\n", "s.toml:1:1: camera: missing key 'position', expected [x, y, z]"},
          {"position = [0, 0]\n", "s.toml:2:12: camera: position = [0, 0], expected [x, y, z]: 3 numbers, not 2"},
          {"position = [0, 'a', 0]\n",
           "s.toml:2:16: camera: position[1] = \"a\", expected 0 or a number of either sign, its size in [1e-30, "
           "1e+09]"},
          {"position = [0, nan, 0]\n",
           "s.toml:2:16: camera: position[1] = nan, expected 0 or a number of either sign, its size in [1e-30, 1e+09]"},
          {"position = [0, 0, -inf]\n",
           "s.toml:2:19: camera: position[2] = -inf, expected 0 or a number of either sign, its size in [1e-30, "
           "1e+09]"},
          {"position = [1, 2, 3]\nlook_at = [1, 2, 3]\n",
           "s.toml:3:11: camera: look_at = [1, 2, 3], expected a point 1e-09 m or more from the camera's position"},
          {"position = [0, 3, 0]\nlook_at = [0, 0, 0]\n", "s.toml:3:11: camera: ", {"up lies along the view"}},
          {"position = [0, 3, 0]\nlook_at = [0, 0, 0]\nup = [0, 2, 0]\n", "s.toml:4:6: ", {"up lies along the view"}},
          {"position = [0, 3, 1]\nlook_at = [0, 0, 0]\nup = [0, 0, 0]\n",
           "s.toml:4:6: camera: up = [0, 0, 0], expected a direction, not zero"},
          {"position = [0, 3, 1]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n",
           "s.toml:4:16: camera: vertical_fov = 40, expected a number in [1e-06, 3.14159]"},
          {"position = [0, 3, 1]\nlook_at = [0, 0, 0]\nvertical_fov = 0\n", "s.toml:4:16: camera: vertical_fov = 0"},
          {"position = [0, 3, 1]\nlook_at = [0, 0, 0]\nheight = 2\n",
           "s.toml:4:1: camera: unknown key 'height'",
           {"vertical_fov"}},
          {"type = 'orthographic'\nposition = [0, 3, 1]\nlook_at = [0, 0, 0]\n",
           "s.toml:1:1: camera: missing key 'height', expected a number in [1e-09, 1e+09]"},
          {"type = 'ortographic'\n", "s.toml:2:8: camera: type = \"ortographic\"", {"(nearest: orthographic)"}},
      },
      "[camera]\n");
}

TEST_CASE("bad lights", "[load]") {
  check(
      {
          {"[[light]]\n", "s.toml:4:1: light 0: missing key 'type'", {"\"point\"", "\"environment\""}},
          {"[[light]]\ntype = 'lamp'\n", "s.toml:5:8: light 0: type = \"lamp\"", {"expected one of"}},
          {"[[light]]\ntype = 3\n", "s.toml:5:8: light 0: type = 3"},
          {"[[light]]\ntype = 'directional'\nto_light = [0, 0, 0]\nirradiance = 1\n",
           "s.toml:6:12: light 0: to_light = [0, 0, 0], expected a direction, not zero"},
          {"[[light]]\ntype = 'directional'\nto_light = [0, 1, 0]\nradiance = 1\n",
           "s.toml:7:1: light 0: unknown key 'radiance'",
           {"(nearest: irradiance)"}},
      },
      camera);
  check(
      {
          {"position = [0, 0, 0]\n",
           "s.toml:4:1: light 0: missing key 'intensity', expected 0 or a number in [1e-30, 1e+30]"},
          {"position = [0, 0, 0]\nintensity = -1\n",
           "s.toml:7:13: light 0: intensity = -1, expected 0 or a number in [1e-30, 1e+30]"},
          {"position = [0, 0, 0]\nintensity = [1, nan, 1]\n", "s.toml:7:17: light 0: intensity[1] = nan"},
          {"position = [0, 0, 0]\nintensity = inf\n", "s.toml:7:13: light 0: intensity = inf"},
          {"position = [0, 0, 0]\nintensity = true\n", "s.toml:7:13: light 0: intensity = true"},
          {"position = [0, 0, 0]\nintensity = 1\nradius = -1\n", "s.toml:8:10: light 0: radius = -1"},
          {"position = [0, 0, 0]\nintensty = 1\n",
           "s.toml:7:1: light 0: unknown key 'intensty'",
           {"(nearest: intensity)"}},
      },
      point);
  check(
      {
          {"outer_angle = 1\n", "s.toml:4:1: light 0: missing key, expected exactly one of axis, target"},
          {"axis = [0, 1, 0]\ntarget = [0, 1, 0]\n", "s.toml:9:10: light 0: found both 'axis' and 'target'"},
          {"target = [0, 0, 0]\n", "s.toml:8:10: light 0: target = [0, 0, 0], expected a point 1e-09 m or more from"},
          {"axis = [0, 1, 0]\nouter_angle = 4\n",
           "s.toml:9:15: light 0: outer_angle = 4, expected a number in [0, 3.14159]"},
          {"axis = [0, 1, 0]\nouter_angle = 1\ninner_angle = 1.5\n",
           "s.toml:10:15: light 0: inner_angle = 1.5, expected at most outer_angle = 1"},
      },
      spot);
  check(
      {
          {"", "s.toml:4:1: light 0: missing key, expected exactly one of file, radiance, sh"},
          {"radiance = 1\nsh = [[1, 1, 1]]\n", "s.toml:7:6: light 0: found both 'radiance' and 'sh'"},
          {"radiance = 1\nrotation = { axis = [0, 1, 0], angle = 1 }\n", "s.toml:7:1: light 0: unknown key 'rotation'"},
          {"sh = [[1, 1, 1], [0, 0]]\n", "s.toml:6:18: light 0: sh[1] = [0, 0], expected [r, g, b]"},
          {"sh = [[1, 1, 1], [0, 0, 0]]\n", "s.toml:6:6: light 0: "},
          {"file = 'nothing.exr'\n", "s.toml:6:8: light 0: file = \"nothing.exr\", expected a file: there is n"},
          {"file = ''\n", "s.toml:6:8: light 0: file = \"\""},
          {"sh = [[1, 1, 1]]\nrotation = { axis = [0, 0, 0], angle = 1 }\n",
           "s.toml:7:21: light 0: rotation: axis = [0, 0, 0], expected a direction"},
          {"sh = [[1, 1, 1]]\nrotation = { axis = [0, 1, 0] }\n",
           "s.toml:7:12: light 0: rotation: missing key 'angle'"},
          {"sh = [[1, 1, 1]]\nrotation = { euler = [0, 1, 0], angle = 1 }\n",
           "s.toml:7:41: light 0: rotation: found 'angle'"},
      },
      environment);
}

TEST_CASE("bad media", "[load]") {
  check(
      {
          {"sigma_t = -1\n", "s.toml:6:11: medium 0: sigma_t = -1, expected 0 or a number in [1e-30, 1e+30]"},
          {"sigma_t = [1, 2, -3]\n",
           "s.toml:6:18: medium 0: sigma_t[2] = -3, expected 0 or a number in [1e-30, 1e+30]"},
          {"sigma_t = [1, 2, 3, 4]\n", "s.toml:6:11: medium 0: sigma_t = [1, 2, 3, 4]", {"3 numbers, not 4"}},
          {"sigma_t = 'thick'\n", "s.toml:6:11: medium 0: sigma_t = \"thick\""},
          {"albedo = 1.5\n", "s.toml:6:10: medium 0: albedo = 1.5, expected a number in [0, 1]"},
          {"density = -0.5\n", "s.toml:6:11: medium 0: density = -0.5"},
          {"name = 1\n", "s.toml:6:8: medium 0: name = 1"},
          {"phase = 'hg'\n", "s.toml:6:9: medium 0: phase = \"hg\", expected a table"},
          {"phase = { type = 'hg' }\n",
           "s.toml:6:9: medium 0: phase: missing key 'g', expected a number in [-0.999999, 0.999999]"},
          {"phase = { type = 'hg', g = 1 }\n",
           "s.toml:6:28: medium 0: phase: g = 1, expected a number in [-0.999999, 0.999999]"},
          {"phase = { type = 'hg', g = -1.0 }\n", "s.toml:6:28: medium 0: phase: g = -1,"},
          {"phase = { type = 'hazy_printed' }\n",
           "s.toml:6:18: medium 0: phase: type = \"hazy_printed\"",
           {"(nearest: hazy)"}},
          {"phase = { type = 'hazy', g = 0 }\n", "s.toml:6:26: medium 0: phase: unknown key 'g'"},
          {"region = { type = 'cube' }\n", "s.toml:6:19: medium 0: region: type = \"cube\""},
          {"region = { type = 'box', lo = [0, 0, 0], hi = [1, 0, 1] }\n",
           "s.toml:6:47: medium 0: region: hi = [1, 0, 1], expected a corner 1e-09 m or more above 'lo'"},
          {"region = { type = 'sphere', center = [0, 0, 0], radius = 0 }\n",
           "s.toml:6:58: medium 0: region: radius = 0"},
          {"region = { type = 'slab', lo = 1, hi = 1 }\n",
           "s.toml:6:40: medium 0: region: hi = 1, expected a number 1e-09 m or more above"},
          {"constant = 1\n", "s.toml:6:1: medium 0: unknown key 'constant'"},
      },
      homogeneous);
  check(
      {
          {"", "s.toml:4:1: medium 0: missing key, expected exactly one of gaussians, file"},
          {"gaussians = []\nconstant = -1\n", "s.toml:7:12: medium 0: constant = -1"},
          {"gaussians = []\ncutoff = 0\n",
           "s.toml:7:10: medium 0: cutoff = 0, expected a number in [1e-09, 1e+09], or inf"},
          {"gaussians = [{ center = [0, 0, 0], width = 0, amplitude = 1 }]\n",
           "s.toml:6:44: medium 0: gaussians 0: width = 0, expected a number in [1e-09, 1e+09]"},
          {"gaussians = [{ center = [0, 0, 0], width = 1 }]\n",
           "s.toml:6:14: medium 0: gaussians 0: missing key 'amplitude'"},
          {"gaussians = [{ centre = [0, 0, 0], width = 1, amplitude = 1 }]\n",
           "s.toml:6:16: medium 0: gaussians 0: unknown key 'centre'",
           {"(nearest: center)"}},
      },
      gaussians);
  const std::string cube = "size = [2, 2, 2]\nvoxel_size = 1\norigin = [0, 0, 0]\n";
  check(
      {
          {"", "s.toml:4:1: medium 0: missing key, expected exactly one of file, values"},
          {"values = [1]\nfile = 'a.vdb'\n", "s.toml:6:10: medium 0: found both 'file' and 'values'"},
          {cube + "values = [1, 2, 3]\n", "s.toml:9:10: medium 0: values has 3 numbers, expected 8 = 2 x 2 x 2"},
          {cube + "values = [1, 2, 3, 4, 5, nan, 7, 8]\n", "s.toml:9:26: medium 0: values[5] = nan"},
          {cube + "values = [1, 2, 3, 4, 5, -6, 7, 8]\n", "s.toml:9:26: medium 0: values[5] = -6"},
          {cube + "values = [1, 2, 3, 4, 5, 1e39, 7, 8]\n", "s.toml:9:26: medium 0: values[5] = 1e+39,"},
          {cube + "values = [1]\ngrid = 'density'\n", "s.toml:10:1: medium 0: unknown key 'grid'"},
          {"size = [2, 2, 0]\nvoxel_size = 1\norigin = [0, 0, 0]\nvalues = []\n", "s.toml:6:15: medium 0: size[2] = 0"},
          {"size = [2, 2, 1]\nvoxel_size = 0\norigin = [0, 0, 0]\nvalues = []\n",
           "s.toml:7:14: medium 0: voxel_size = 0"},
          {"file = 'nothing.vdb'\n", "s.toml:6:8: medium 0: file = \"nothing.vdb\", expected a file: there is n"},
          {"file = 'nothing_##.vdb'\n",
           "s.toml:6:8: medium 0: file = \"nothing_##.vdb\" is a sequence, expected a frame"},
          {"file = 'nothing_##.vdb'\nframe = -1\n", "s.toml:7:9: medium 0: frame = -1"},
          {"file = 'a##_#.vdb'\nframe = 1\n", "s.toml:6:8: medium 0: file = \"a##_#.vdb\", expected the digits"},
          {"file = 'nothing.vdb'\nframe = 1\n", "s.toml:7:9: medium 0: frame has no effect"},
          {cube + "values = [1]\nframe = 1\n", "s.toml:10:1: medium 0: unknown key 'frame'"},
          {cube + "values = [1, 1, 1, 1, 1, 1, 1, 1]\ntransform = { scale = 0 }\n",
           "s.toml:10:23: medium 0: transform: scale = 0, expected a number in [1e-09, 1e+09]"},
          {cube + "values = [1, 1, 1, 1, 1, 1, 1, 1]\ntransform = { scale = [1, 2, 1] }\n",
           "s.toml:10:23: medium 0: transform: scale = [1, 2, 1], expected a number in [1e-09, 1e+09]"},
          {cube + "values = [1, 1, 1, 1, 1, 1, 1, 1]\nclamp_border = 1\n",
           "s.toml:10:16: medium 0: clamp_border = 1, expected true or false"},
      },
      grid);
}

TEST_CASE("bad surfaces", "[load]") {
  check(
      {
          {"type = 'cone'\n", "s.toml:5:8: surface 0: type = \"cone\""},
          {"type = 'mesh'\n", "s.toml:4:1: surface 0: missing key 'file'"},
          {"type = 'mesh'\nfile = 'nothing.off'\n",
           "s.toml:6:8: surface 0: file = \"nothing.off\", expected a file: there is n"},
          {"type = 'sphere'\ncenter = [0, 0, 0]\nradius = -1\n", "s.toml:7:10: surface 0: radius = -1"},
          {"type = 'box'\nlo = [0, 0, 0]\nhi = [1, 1, 0]\n", "s.toml:7:6: surface 0: hi = [1, 1, 0]"},
          {"type = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\n", "s.toml:7:10: surface 0: normal"},
          {"type = 'plane'\npoint = [0, 0, 0]\nmaterial = { type = 'lambert', albedo = 2 }\n",
           "s.toml:7:41: surface 0: material: albedo = 2, expected a number in [0, 1]"},
          {"type = 'plane'\npoint = [0, 0, 0]\nmaterial = { type = 'phong', diffuse = 0.6, specular = [0.3, 0.5, 0.4]"
           "}\n",
           "s.toml:7:56: surface 0: material: diffuse + specular = [",
           {"expected at most 1", "create energy"}},
          {"type = 'plane'\npoint = [0, 0, 0]\nmaterial = { type = 'mirror' }\n",
           "s.toml:7:21: surface 0: material: type = \"mirror\""},
          {"type = 'height_field'\nsize = [1, 2]\nspacing = [1, 1]\nheights = [0, 0]\n",
           "s.toml:6:9: surface 0: size[0] = 1"},
          {"type = 'height_field'\nsize = [2, 2]\nspacing = [1, 1]\nheights = [0, 0]\n",
           "s.toml:8:11: surface 0: heights has 2 numbers, expected 4 = 2 x 2"},
          {"type = 'height_field'\nsize = [2, 2]\nspacing = [1, 1]\n",
           "s.toml:4:1: surface 0: missing key, expected exactly one of heights, waves"},
          {"type = 'height_field'\nsize = [2, 2]\nspacing = [1, 1]\nwaves = [{ amplitude = 1, wave_vector = [1] }]\n",
           "s.toml:8:41: surface 0: waves 0: wave_vector = [1]"},
      },
      camera + "[[surface]]\n");
}

}  // namespace bad_input_test
