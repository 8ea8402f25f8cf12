#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "scene/scene.h"
#include "tests/texts.h"

namespace load_scene_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

const std::string fog = R"(
ambient_in_scatter = [0.1, 0.2, 0.3]
[film]
width = 32
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
[[light]]
type = "point"
position = [0, 1, 0]
intensity = 3
[[medium]]
type = "gaussians"
sigma_t = [1, 2, 4]
constant = 0.1
gaussians = [{ center = [0, 0, 0], width = 1, amplitude = 0.5 }]
)";

std::string error_of(const std::string& text, const Overrides& overrides = {}) {
  return test::message_of([&] { parse_scene(text, "fog.toml", "", overrides); });
}

}  // namespace

TEST_CASE("a scene of Gaussians and a point light is what its file says", "[load]") {
  const Scene scene = parse_scene(fog, "folder/fog.toml", "");
  CHECK(scene.name == "fog");
  CHECK(scene.width == 32);
  CHECK(scene.height == 120);
  CHECK(scene.camera.forward.isApprox(-Vec3::UnitZ()));
  CHECK(scene.ambient_in_scatter[2] == 0.3);
  CHECK(std::get<PointLight>(scene.lights.at(0)).intensity[1] == 3);
  const Medium& medium = scene.media.at(0);
  CHECK(medium.sigma_t[2] == 4);
  const auto& sum = std::get<GaussianSum>(medium.field);
  CHECK(sum.constant == 0.1);
  CHECK(sum.cutoff == infinity);
  CHECK(sum.gaussians.at(0).amplitude == 0.5);
}

TEST_CASE("an override with a star changes every entry of a list", "[load]") {
  const std::string sphere = R"([[surface]]
name = "ball"
type = "sphere"
center = [0, 0, 0]
radius = 1
material = { type = "lambert", albedo = 0.5 }
)";
  const std::string camera = "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n";
  const auto scene = parse_scene(camera + sphere + sphere, "s.toml", "", {{"surface.*.material.albedo", "0"}});
  REQUIRE(scene.surfaces.size() == 2);
  for (const Surface& surface : scene.surfaces) CHECK(std::get<Lambert>(surface.material).albedo.isZero());
  CHECK_THROWS_WITH(parse_scene(camera, "s.toml", "", {{"camera.*", "0"}}), Catch::Contains("expected a list for '*'"));
  CHECK_THROWS_WITH(parse_scene(camera + sphere, "s.toml", "", {{"surface.*.colour.r", "0"}}),
                    Catch::Contains("there is no 'surface.0.colour'"));
}

TEST_CASE("overrides change values before they are read", "[load]") {
  const Scene scene = parse_scene(fog, "fog.toml", "",
                                  {{"film.width", "64"},
                                   {"medium.0.sigma_t", "[3, 2, 1]"},
                                   {"medium.0.gaussians.0.width", "2"},
                                   {"medium.0.cutoff", "3"},
                                   {"camera.position.1", "1.5"}});
  CHECK(scene.width == 64);
  CHECK(scene.media[0].sigma_t[0] == 3);
  const auto& sum = std::get<GaussianSum>(scene.media[0].field);
  CHECK(sum.gaussians[0].width == 2);
  CHECK(sum.cutoff == 3);
  CHECK(scene.camera.position[1] == 1.5);

  CHECK(error_of(fog, {{"medium.0.sigma_t", "-1"}}) ==
        "override medium.0.sigma_t = -1 of fog.toml: medium 0: sigma_t = -1, expected 0 or a number in [1e-30, 1e+30]");
  CHECK(
      error_of(fog, {{"light.0.type", "spot"}}) ==
      "override light.0.type = spot of fog.toml: Error while parsing value: could not determine value type; expected a "
      "TOML value, texts in quotes");
  CHECK(error_of(fog, {{"film.width", "1\nheight = 2"}}) ==
        "override film.width = 1 height = 2 of fog.toml: expected one TOML value");
  CHECK(error_of(fog, {{"film..width", "1"}}).find("empty part") != std::string::npos);
  CHECK(error_of(fog, {{"camera.position.3", "1"}}).find("expected an index below 3") != std::string::npos);
  CHECK(error_of(fog, {{"film.width.x", "1"}}).find("'film.width' is 32, expected a table or a list") !=
        std::string::npos);
  CHECK(error_of(fog, {{"medium.0.sigma", "1"}}) ==
        "override medium.0.sigma = 1 of fog.toml: medium 0: unknown key 'sigma', expected one of name, type, sigma_t, "
        "albedo, phase, region, constant, cutoff, gaussians, file, frame (nearest: sigma_t)");
  CHECK(error_of(fog, {{"medium.1.sigma_t", "1"}}) ==
        "override medium.1.sigma_t = 1 of fog.toml: 'medium' is a list of 1, found '1', expected an index below 1");
  CHECK(
      error_of(fog, {{"mediun.0.sigma_t", "1"}}) ==
      "override mediun.0.sigma_t = 1 of fog.toml: there is no 'mediun'; the file has ambient_in_scatter, camera, film, "
      "light, medium (nearest: medium)");
}

TEST_CASE("the hash is of the content", "[load]") {
  const std::string hash = parse_scene(fog, "a.toml", "").hash;
  CHECK(hash.size() == 32);
  CHECK(parse_scene("# a comment\nname = \"other\"" + fog, "b.toml", "").hash == hash);
  CHECK(parse_scene(fog, "a.toml", "", {{"light.0.radius", "0"}, {"light.0.intensity", "[3.0, 3, 3]"}}).hash == hash);
  CHECK(parse_scene(fog, "a.toml", "", {{"light.0.radius", "0.1"}}).hash != hash);
  CHECK(parse_scene(fog, "a.toml", "", {{"medium.0.phase", "{type = 'rayleigh'}"}}).hash != hash);
}

}  // namespace load_scene_test
