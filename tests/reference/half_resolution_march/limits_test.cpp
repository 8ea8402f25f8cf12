// Refusals, and reasons for a scene.
#include "reference/half_resolution_march/limits.h"

#include <catch2/catch.hpp>

#include "scene/base/limits.h"
#include "tests/reference/half_resolution_march/fog_scenes.h"

namespace half_limits_test {

using namespace airlight;
using namespace airlight::half_resolution_march;
using Catch::Contains;

namespace {

std::vector<std::string> reasons(const scene::Scene& scene, const Given& given) {
  const HalfResolutionMarch march;
  return march.supports(scene, {march.settings(), given});
}

std::map<std::string, std::string> stages(const std::shared_ptr<const scene::Scene>& scene, const Given& given,
                                          bool kept) {
  const HalfResolutionMarch march;
  std::map<std::string, std::string> found;
  for (const scene::Stage& stage : march.prepare(scene, {march.settings(), given}, {})->stages())
    if (stage.kept == kept) found[stage.name] = stage.reason;
  return found;
}

}  // namespace

TEST_CASE("half-resolution march: settings that nothing reads are refused", "[half_resolution_march]") {
  const HalfResolutionMarch march;
  for (const Given& given :
       {Given{{"jitter", "none"}, {"frames", "2"}}, Given{{"divide", "1"}, {"depth", "centre"}},
        Given{{"divide", "1"}, {"upsample", "bilinear"}}, Given{{"divide", "1"}, {"edge", "1"}},
        Given{{"upsample", "bilinear"}, {"edge", "1"}}, Given{{"self_shadow", "none"}, {"map_size", "64"}},
        Given{{"reproject", "true"}, {"frames", "2"}}, Given{{"clamp", "neighbourhood"}},
        Given{{"history_weight", "0.5"}}, Given{{"history_depth", "end"}}, Given{{"steps", "0"}},
        Given{{"divide", "65"}}})
    CHECK_THROWS_AS(scene::Settings(march.settings(), given), Error);
  CHECK_NOTHROW(scene::Settings(march.settings(), {{"divide", "1"}, {"blur", "bilateral"}, {"edge", "1"}}));
  CHECK_NOTHROW(scene::Settings(march.settings(), {{"edge", "1"}}));
}

TEST_CASE("half-resolution march: too much work and scenes beyond arithmetic are refused", "[half_resolution_march]") {
  const SlabOfFog fog;
  const auto refused = [&](const scene::Scene& scene, const Given& given, const std::string& part) {
    const auto found = reasons(scene, given);
    CAPTURE(part);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Contains(part));
    CHECK(found[0].find('\n') == std::string::npos);
  };
  const auto scene = fog.scene(16384, 16384);
  CHECK(reasons(*scene, {}).empty());
  refused(*scene, {{"steps", "65536"}},
          "6.71e+07 rays of 65536 steps in 1 frames under 1 lights are 8.8e+12 evaluations, expected at most 1e+12");
  refused(*scene, {{"frames", "4096"}}, "6.71e+07 rays of 16 steps in 4096 frames");
  refused(*fog.scene(), {{"map_encoding", "fourier"}, {"map_coefficients", "8"}}, "map_coefficients = 8 is even");
  auto sky = std::make_shared<scene::Scene>(*fog.scene());
  sky->lights.emplace_back(scene::make_constant_environment(Rgb::Ones()));
  finish(*sky);
  refused(*sky, {{"environment_directions", "4096"}, {"map_size", "4096"}, {"map_steps", "4096"}},
          "maps of 4.1e+03 lights with 4096^2 texels of 4096 steps in 1 media");
  auto endless = std::make_shared<scene::Scene>(*fog.scene());
  endless->media[0].region = scene::Unbounded{};
  endless->media[0].name = "haze";
  endless->media[0].sigma_t = Rgb(0, 1e-120, 1);
  finish(*endless);
  refused(*endless, {}, "medium 'haze' has no end and an extinction of 1e-120 1/m, expected 0, or 1e-100 1/m or more");
  endless->media[0].sigma_t = Rgb(0, 1e-99, 1);
  finish(*endless);
  CHECK(reasons(*endless, {}).empty());
  CHECK(test::all_finite(picture(endless, {})));
  refused(*SlabOfFog{Rgb::Constant(1e14)}.scene(), {}, "a medium is so thick that the rounding of places changes");
}

TEST_CASE("half-resolution march: a picture beyond the memory allowed is refused", "[half_resolution_march]") {
  const SlabOfFog fog;
  const HalfResolutionMarch march;
  const auto scene = fog.scene();
  const auto prepared = march.prepare(scene, {march.settings(), {}}, {});
  scene::set_limit("1GiB");
  CHECK_THROWS_WITH(prepared->render({scene->camera, 16384, 16384}, {}), Contains("a picture of this size"));
  scene::reset_limits();
}

TEST_CASE("half-resolution march: stages say what a scene needs, and times are theirs", "[half_resolution_march]") {
  const HalfResolutionMarch march;
  for (const auto& [name, scene] : ray_marcher::assorted_scenes()) {
    INFO(name);
    const Given given{{"environment_directions", "4"}, {"map_size", "16"}};
    const auto prepared = march.prepare(scene, {march.settings(), given}, {});
    std::vector<std::string> kept, timed;
    for (const scene::Stage& stage : prepared->stages()) {
      CHECK(!stage.reason.empty());
      if (stage.kept) kept.push_back(stage.name);
    }
    for (const scene::StageTime& time : prepared->render(ray_marcher::small_view(), {}).times) {
      timed.push_back(time.name);
      CHECK(std::count(kept.begin(), kept.end(), time.name) == 1);
    }
    const bool fog = !scene->media.empty(), maps = std::count(kept.begin(), kept.end(), "light_maps") == 1;
    CHECK((std::count(timed.begin(), timed.end(), "march") == 1) == fog);
    CHECK((prepared->prepare_times().size() == 2) == maps);
    CHECK((std::count(timed.begin(), timed.end(), "surfaces") == 1) ==
          (bool(scene->geometry) || name == std::string("grid under the sky")));
  }
  const auto grid = ray_marcher::assorted_scenes()[6].second;
  CHECK_THAT(stages(grid, {{"map_size", "16"}}, true)["light_maps"], Catch::StartsWith("2 lights: slices, 33 floats"));
  CHECK(stages(grid, {{"self_shadow", "none"}}, false)["light_maps"] ==
        "self_shadow = none: media do not dim light on its way");
  CHECK(stages(grid, {}, false)["blur"] == "blur = none");
  CHECK(stages(grid, {{"blur", "bilateral"}}, true)["blur"] == "11 x 11 marched pixels; no edges of depth");
  CHECK(stages(grid, {{"divide", "1"}}, true)["composition"] == "full resolution");
  CHECK(stages(grid, {{"frames", "5"}, {"steps", "8"}}, true)["march"] ==
        "a ray for each 2x2 pixels, 8 steps, offsets by noise, analytic, 5 frames");
}

}  // namespace half_limits_test
