// Maps of lights instead of shadow rays.
#include <hwy/targets.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/base/limits.h"
#include "tests/pictures.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace map_test {

using namespace airlight;
using namespace airlight::ray_marcher;
using airlight::test::relative_l2;

namespace {

const char* const encodings[] = {"slices", "avsm", "fourier", "beer"};

Given map_settings(const char* encoding, const char* size = "64") {
  return {{"steps", "30"},    {"environment_directions", "8"},
          {"shadow", "map"},  {"map_encoding", encoding},
          {"map_size", size}, {"map_steps", "96"}};
}

Given exact_settings() { return {{"steps", "30"}, {"environment_directions", "8"}, {"shadow", "exact"}}; }

std::vector<std::string> reasons(const scene::Renderer& renderer, const scene::Scene& scene, const Given& given) {
  return renderer.supports(scene, {renderer.settings(), given});
}

}  // namespace

// Maps have 64^2 texels and 96 steps. The bounds are one and a half times the greatest error over all these scenes, for
// light from media and from surfaces behind them. The greatest errors are those of a rotated grid cut off by a box, and
// of smoke under the sky. Homogeneous media need no map and have exact shadows.
TEST_CASE("ray marcher: pictures with maps are near those with exact shadows", "[ray_marcher][light_map]") {
  const std::map<std::string, double> bounds = {{"slices", 0.016}, {"avsm", 0.066}, {"fourier", 0.045}, {"beer", 0.4}};
  for (const auto& [name, scene] : assorted_scenes()) {
    const scene::Film exact = render(scene, small_view(), exact_settings()).film;
    const bool varies = std::any_of(scene->media.begin(), scene->media.end(),
                                    [](const auto& m) { return !homogeneous_density(m.field); });
    for (const char* encoding : encodings) {
      const auto mapped = render(scene, small_view(), map_settings(encoding));
      INFO(name << ", " << encoding);
      CHECK(relative_l2(mapped.film, exact) < (varies ? bounds.at(encoding) : 1e-5));
      CHECK(relative_l2(mapped.film, exact, "surface") < (varies ? bounds.at(encoding) : 1e-5));
      CHECK(mapped.film.layer("transmittance") == exact.layer("transmittance"));
      CHECK(mapped.counters.at("shadow_steps") == 0);
      CHECK(mapped.counters.at("shadow_rays") == 0);
      CHECK((mapped.counters.at("look_ups") > 0) == !scene->media.empty());
    }
  }
}

// Texels of half the side, twice the steps and the slices: order 2 in smooth smoke. Measured over the two octaves from
// 32^2 texels on: 2.0 under the sun, 1.9 beside a lamp.
TEST_CASE("ray marcher: pictures with maps converge to exact shadows", "[ray_marcher][light_map]") {
  scene::GaussianSum sum;
  sum.gaussians = {{Point3(0.1, 0.2, 0), 0.3, 2.0}, {Point3(-0.4, 0, 0.3), 0.2, 3.0}};
  for (const scene::Light& light : {scene::Light(scene::DirectionalLight{Vec3(1, 2, 1).normalized(), Rgb(2, 2, 2)}),
                                    scene::Light(scene::PointLight{Point3(1, 1.5, 1), Rgb(3, 2, 1), 0})}) {
    const auto scene = make_scene({make_medium(sum, scene::Unbounded{}, Rgb(2, 3, 4), Rgb(0.9, 0.7, 0.5))}, {light});
    const scene::Film exact = render(scene, small_view(), exact_settings()).film;
    std::vector<double> errors;
    for (const int n : {32, 64, 128}) {
      Given given = map_settings("slices", std::to_string(n).c_str());
      given["map_steps"] = std::to_string(2 * n);
      given["map_slices"] = std::to_string(n);
      errors.push_back(relative_l2(render(scene, small_view(), given).film, exact));
    }
    CAPTURE(light_name(light), errors[0], errors[1], errors[2]);
    CHECK(0.5 * std::log2(errors[0] / errors[2]) == Approx(2).margin(0.2));
    CHECK(errors[2] < 2e-3);
  }
}

// Densities of maps, and lookups, are in float or in double: relative errors of about 1e-7, as measured.
// Such a difference can decide which node of avsm is removed, if two are nearly equal. The texel's error
// then differs, but is not larger. In two of these scenes it does, and the pictures change by 5.6e-5 and
// 1.6e-4, a hundredth of avsm's error.
TEST_CASE("ray marcher: look-ups by kernels agree with the plain path", "[ray_marcher][light_map]") {
  for (const auto& [name, scene] : assorted_scenes())
    for (const char* encoding : encodings) {
      Given given = map_settings(encoding);
      const auto fast = render(scene, small_view(), given);
      given["kernel"] = "scalar";
      const auto slow = render(scene, small_view(), given);
      INFO(name << ", " << encoding);
      const double most = encoding == std::string("avsm") ? 3e-4 : 1e-6;
      CHECK(relative_l2(fast.film, slow.film) < most);
      CHECK(relative_l2(fast.film, slow.film, "surface") < most);
      CHECK(fast.counters.at("steps") == slow.counters.at("steps"));
    }
}

TEST_CASE("ray marcher: with maps the same bits whatever the threads and the instruction set",
          "[ray_marcher][light_map]") {
  const RayMarcher marcher;
  for (const auto& [name, one] : assorted_scenes())
    for (const char* encoding : encodings) {
      INFO(name << ", " << encoding);
      const auto& scene = one;
      const Given given = map_settings(encoding, "32");
      const auto drawn = [&](int threads) {
        return marcher.prepare(scene, {marcher.settings(), given}, {threads, {}})
            ->render(small_view(), {threads, {}})
            .film.layers;
      };
      const auto one = drawn(1);
      CHECK(one == drawn(2));
      hwy::SetSupportedTargetsForTest(HWY_AVX2);
      hwy::GetChosenTarget().DeInit();
      const auto narrow = drawn(1);
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().DeInit();
      CHECK(one == narrow);
    }
}

TEST_CASE("ray marcher: maps are a stage of preparation, where they are needed", "[ray_marcher][light_map]") {
  const RayMarcher marcher;
  const auto all = assorted_scenes();
  for (const auto& [name, scene] : all) {
    const auto prepared = marcher.prepare(scene, {marcher.settings(), map_settings("slices", "16")}, {});
    const bool varies = std::any_of(scene->media.begin(), scene->media.end(),
                                    [](const auto& m) { return !homogeneous_density(m.field); });
    INFO(name);
    bool kept = false, timed = false;
    for (const scene::Stage& stage : prepared->stages()) kept = kept || (stage.name == "light_maps" && stage.kept);
    for (const scene::StageTime& time : prepared->prepare_times())
      timed = timed || (time.name == "light_maps" && time.seconds > 0);
    CHECK(kept == varies);
    if (varies) CHECK(timed);
  }
  for (const scene::StageTime& time : marcher.prepare(all[6].second, {marcher.settings(), {}}, {})->prepare_times())
    CHECK(time.name == "prepare");
  const auto stages = marcher.prepare(all[6].second, {marcher.settings(), map_settings("avsm", "16")}, {})->stages();
  const auto maps = std::find_if(stages.begin(), stages.end(), [](const auto& s) { return s.name == "light_maps"; });
  CHECK_THAT(maps->reason, Catch::StartsWith("2 lights: avsm, 16 floats a texel, 16^2 texels of 96 steps"));
}

TEST_CASE("ray marcher: settings of maps that nothing reads, and maps that cannot be made, are refused",
          "[ray_marcher][light_map]") {
  const auto scene = assorted_scenes()[6].second;
  const RayMarcher marcher;
  for (const Given& given :
       {Given{{"map_size", "64"}}, Given{{"map_encoding", "beer"}}, Given{{"shadow", "exact"}, {"map_steps", "64"}},
        Given{{"shadow", "map"}, {"map_nodes", "4"}}, Given{{"shadow", "map"}, {"shadow_steps", "8"}},
        Given{{"shadow", "map"}, {"map_encoding", "avsm"}, {"map_slices", "4"}}})
    CHECK_THROWS_AS(scene::Settings(marcher.settings(), given), Error);
  const auto refused = [&](const Given& given, const std::string& part) {
    const auto found = reasons(marcher, *scene, given);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Catch::Contains(part));
    CHECK(found[0].find('\n') == std::string::npos);
  };
  refused({{"shadow", "map"}, {"map_encoding", "fourier"}, {"map_coefficients", "8"}}, "map_coefficients = 8 is even");
  refused({{"shadow", "map"}, {"map_size", "4096"}, {"map_slices", "1024"}}, "expected at most 2147483647");
  CHECK(reasons(marcher, *scene, {{"shadow", "map"}}).empty());
  // 257 maps of 258^2 texels with 33 floats: 2.3 GB.
  scene::set_limit("1GiB");
  const auto sky = assorted_scenes()[9].second;
  CHECK_THROWS_WITH(marcher.prepare(sky, {marcher.settings(), {{"shadow", "map"}}}, {}),
                    Catch::Contains("ray_marcher: maps of 257 lights"));
  scene::reset_limits();
}

}  // namespace map_test
