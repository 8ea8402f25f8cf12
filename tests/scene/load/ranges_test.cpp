// No number of a scene file leaves its range, whichever key it stands under, and the documentation says the ranges.
#include "scene/load/ranges.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "scene/film/film.h"
#include "scene/scene.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"

namespace ranges_test {

using namespace airlight;
using namespace airlight::scene;
using Catch::Contains;
using test::camera;
using test::message;

namespace {

// A table of a scene with @ in place of one number; whether 0 may stand there, and what is small (-: any number may
// be).
struct Key {
  std::string table;
  bool zero = false, small = false;
};

const std::vector<Key>& keys() {
  static const std::vector<Key> all = [] {
    const std::string point = "[[light]]\ntype = 'point'\n", spot = "[[light]]\ntype = 'spot'\n",
                      media = "[[medium]]\ntype = ", surface = "[[surface]]\ntype = ",
                      inline_grid = media + "'grid'\nsize = [1, 1, 1]\n",
                      field = surface + "'height_field'\nsize = [2, 2]\n",
                      blob = surface + "'displaced_sphere'\nsize = [8, 5]\n";
    std::vector<Key> k = {
        {"ambient_in_scatter = @\n", true},
        {point + "position = [@, 0, 0]\nintensity = 1", true},
        {point + "position = [0, 0, 0]\nintensity = @", true},
        {point + "position = [0, 0, 0]\nintensity = [1, @, 1]", true},
        {point + "position = [0, 0, 0]\nintensity = 1\nradius = @", true},
        {spot + "position = [0, 0, 0]\ntarget = [0, @, 0]\nintensity = 1\nouter_angle = 0.4"},
        {spot + "position = [0, 0, 0]\naxis = [0, 1, 0]\nintensity = @\nouter_angle = 0.4", true},
        {"[[light]]\ntype = 'directional'\nto_light = [0, 1, 0]\nirradiance = @", true},
        {"[[light]]\ntype = 'environment'\nradiance = @", true},
        {"[[light]]\ntype = 'environment'\nsh = [[1, @, 1]]", true},
        {"[[light]]\ntype = 'environment'\nsh = [[1, 1, 1]]\nscale = @", true},
        {media + "'homogeneous'\nsigma_t = @", true},
        {media + "'homogeneous'\ndensity = @", true},
        {media + "'homogeneous'\nregion = { type = 'sphere', center = [0, 0, 0], radius = @ }"},
        {media + "'homogeneous'\nregion = { type = 'sphere', center = [0, @, 0], radius = 1 }", true},
        {media + "'homogeneous'\nregion = { type = 'box', lo = [0, 0, 0], hi = [1, @, 1] }"},
        {media + "'homogeneous'\nregion = { type = 'slab', lo = 0, hi = @ }"},
        {media + "'homogeneous'\nphase = { type = 'hg', g = @ }", true, true},
        {media + "'gaussians'\ngaussians = []\nconstant = @", true},
        {media + "'gaussians'\ngaussians = []\ncutoff = @"},
        {media + "'gaussians'\ngaussians = [{ center = [@, 0, 0], width = 1, amplitude = 1 }]", true},
        {media + "'gaussians'\ngaussians = [{ center = [0, 0, 0], width = @, amplitude = 1 }]"},
        {media + "'gaussians'\ngaussians = [{ center = [0, 0, 0], width = 1, amplitude = @ }]", true},
        {inline_grid + "origin = [0, 0, 0]\nvalues = [1]\nvoxel_size = @"},
        {inline_grid + "origin = [@, 0, 0]\nvalues = [1]\nvoxel_size = 1", true},
        {inline_grid + "origin = [0, 0, 0]\nvalues = [@]\nvoxel_size = 1", true, true},
        {inline_grid + "origin = [0, 0, 0]\nvalues = [1]\nvoxel_size = 1\ntransform = { scale = @ }"},
        {surface + "'sphere'\ncenter = [0, 0, 0]\nradius = @"},
        {surface + "'plane'\npoint = [0, @, 0]", true},
        {surface + "'box'\nlo = [0, 0, 0]\nhi = [1, 1, @]"},
        {surface + "'box'\nlo = [0, 0, 0]\nhi = [1, 1, 1]\ntransform = { scale = @ }"},
        {surface + "'box'\nlo = [0, 0, 0]\nhi = [1, 1, 1]\ntransform = { translation = [@, 0, 0] }", true},
        {surface + "'plane'\npoint = [0, 0, 0]\nmaterial = { type = 'phong', exponent = @ }", true, true},
        {field + "spacing = [1, @]\nheights = [0, 0, 0, 0]"},
        {field + "spacing = [1, 1]\nheights = [0, @, 0, 0]", true},
        {field + "spacing = [1, 1]\nwaves = [{ amplitude = @, wave_vector = [1, 0] }]", true},
        {blob + "radius = @"},
        {blob + "radii = [1, 1, @]"},
        {blob + "radius = 1\nbumps = [{ direction = [0, 1, 0], width = @, height = 0.5 }]"},
        {surface + "'torus'\nsize = [8, 8]\nradius = 1\ntube_radius = @"},
        {surface + "'tube'\nsize = [8, 8]\npath = [[0, 0, 0], [1, 0, 0]]\nradius = @"},
        {surface + "'tube'\nsize = [8, 8]\npath = [[0, 0, 0], [1, @, 0]]\nradius = 1", true},
        {surface + "'prism'\nsides = 5\nradius = 1\nheight = @"},
        {surface + "'teapot'\nsize = 3\ntransform = { scale = @ }"},
        {surface + "'city'\nboxes = 2\ncolumns = 2\nlot = @\nstreet = 1\nheights = [1, 2]"},
        {surface + "'city'\nboxes = 2\ncolumns = 2\nlot = 9\nstreet = @\nheights = [1, 2]", true},
    };
    return k;
  }();
  return all;
}

std::string scene_with(const Key& key, const std::string& number) {
  std::string text = key.table;
  text.replace(text.find('@'), 1, number);
  const bool above = key.table.rfind("ambient", 0) == 0;
  return above ? text + camera : camera + text + "\n";
}

}  // namespace

TEST_CASE("numbers beyond their range are refused at their place, whichever key", "[load]") {
  for (const Key& key : keys()) {
    CAPTURE(key.table);
    CHECK(message(scene_with(key, "0.5")) == "");
    for (const char* large : {"1e300", "1e31", "-1e300"}) {
      CAPTURE(large);
      const std::string what = message(scene_with(key, large));
      CHECK_THAT(what, Catch::StartsWith("s.toml:") && Contains("expected"));
      CHECK(what.find('\n') == std::string::npos);
    }
    CHECK((message(scene_with(key, "1e-300")) == "") == key.small);
    CHECK((message(scene_with(key, "0")) == "") == key.zero);
  }
}

TEST_CASE("directions may be of any length", "[load]") {
  for (const char* length : {"1e300", "1e-300"}) {
    const Scene s =
        parse_scene(camera + "up = [0, " + length +
                        ", 0]\n[[light]]\ntype = 'directional'\nirradiance = 1\nto_light = [" + length + ", 0, 0]\n",
                    "s", "");
    CHECK(std::get<DirectionalLight>(s.lights.at(0)).to_light == Vec3::UnitX());
  }
}

// Each number is in its range, their product is not.
TEST_CASE("products beyond the range are refused at their place", "[load]") {
  const std::string medium = camera + "[[medium]]\ntype = ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {medium + "'homogeneous'\nsigma_t = 1e20\ndensity = 1e20",
       "s.toml:6:11: medium 0: sigma_t times the greatest density"},
      {medium + "'homogeneous'\nsigma_t = 1e-20\ndensity = 1e-20", "s.toml:6:11: medium 0: sigma_t times"},
      {medium + "'gaussians'\nsigma_t = 1e20\ngaussians = [{ center = [0, 0, 0], width = 1, amplitude = -1e20 }]",
       "s.toml:6:11: medium 0: sigma_t times"},
      {medium + "'grid'\nsize = [2, 1, 1]\nvoxel_size = 1\norigin = [0, 0, 0]\nvalues = [0, 1e20]\nsigma_t = 1e20",
       "s.toml:10:11: medium 0: sigma_t times"},
      {medium + "'homogeneous'\nsigma_t = 1e9\nregion = { type = 'sphere', center = [0, 0, 0], radius = 1000 }",
       "s.toml:4:1: medium 0: its greatest extinction is 1e+09 1/m, 1000 m from the origin"},
      {medium + "'grid'\nsize = [2000, 1, 1]\nvoxel_size = 1e6\norigin = [0, 0, 0]\nvalues = [" +
           [] {
             std::string v;
             for (int i = 0; i < 2000; ++i) v += "1, ";
             return v;
           }() +
           "]",
       "s.toml:6:8: medium 0: a corner of the grid comes to lie at"},
      {camera + "[[surface]]\ntype = 'box'\nlo = [0, 0, 0]\nhi = [1e6, 1, 1]\ntransform = { scale = 1e6 }",
       "s.toml:8:13: surface 0: vertex"},
      {camera + "[[surface]]\ntype = 'city'\nboxes = 9\ncolumns = 9\nlot = 9e8\nstreet = 0\nheights = [1, 2]",
       "s.toml:4:1: surface 0: vertex"},
  };
  for (const auto& [text, begin] : cases) {
    CAPTURE(begin);
    CHECK_THAT(message(text + "\n"), Catch::StartsWith(begin) && Contains("expected"));
  }
}

TEST_CASE("a map too bright by its scale is refused", "[load]") {
  const TemporaryFolder folder;
  Film map(4, 2);
  for (float& v : map.add("mean")) v = 1e20f;
  write_exr(folder.file("map.exr"), map);
  const auto load = [&](const std::string& scale) {
    parse_scene(camera + "[[light]]\ntype = 'environment'\nfile = 'map.exr'\nscale = " + scale + "\n", "s.toml",
                folder.path().string());
  };
  CHECK_NOTHROW(load("1e9"));
  CHECK_THROWS_WITH(load("1e12"), Contains("s.toml:6:8: light 0: scale times the brightest texel"));
}

TEST_CASE("a table of Gaussians has the ranges of the scene file", "[load]") {
  const TemporaryFolder folder;
  const auto load = [&](const std::string& row) {
    folder.write("g.csv", "center_x,center_y,center_z,width,amplitude\n" + row + "\n");
    parse_scene(camera + "[[medium]]\ntype = 'gaussians'\nfile = 'g.csv'\n", "s.toml", folder.path().string());
  };
  CHECK_NOTHROW(load("0,0,0,1,1"));
  CHECK_THROWS_WITH(load("1e10,0,0,1,1"), Contains("g.csv:2:1: center_x = 1e10, expected 0 or a number"));
  CHECK_THROWS_WITH(load("0,0,0,1e-10,1"), Contains("g.csv:2:7: width = 1e-10, expected a number in"));
  CHECK_THROWS_WITH(load("0,0,0,1,1e31"), Contains("g.csv:2:9: amplitude = 1e31, expected 0 or a number"));
}

TEST_CASE("the documentation states the ranges of the loader", "[load]") {
  const std::string text = read_bytes(std::string(AIRLIGHT_SOURCE_DIR) + "/scene/README.md");
  const auto plain = [](double x) {  // 1e-09 as 1e-9
    std::string s = fmt::format("{:g}", x);
    for (const char* zero : {"e-0", "e+0"})
      if (const std::size_t at = s.find(zero); at != std::string::npos) s.replace(at, 3, zero[1] == '-' ? "e-" : "e");
    if (const std::size_t plus = s.find("e+"); plus != std::string::npos) s.erase(plus + 1, 1);
    return s;
  };
  const auto from_to = [&](const load::Range& r) { return plain(r.least) + " to " + plain(r.greatest); };
  CHECK_THAT(text, Contains("| *coordinate* | 0, or " + from_to(load::coordinate) + " m"));
  CHECK_THAT(text, Contains("| *length* | " + from_to(load::length) + " m"));
  CHECK_THAT(text, Contains("| *amount* | 0, or " + from_to(load::amount)));
  CHECK_THAT(text, Contains("| *density* | 0, or " + from_to(load::density_range)));
  CHECK_THAT(text, Contains("0 or " + from_to(load::extinction_range) + " per metre"));
  CHECK_THAT(text, Contains("bounds is at most " + plain(load::greatest_depth)));
  CHECK_THAT(text, Contains("`g` from " + from_to(load::anisotropy)));
  CHECK_THAT(text, Contains("`exponent` n from 0 to 1e6"));
  CHECK(load::exponent_range.greatest == 1e6);
}

}  // namespace ranges_test
