// Frames of a scene of which something moves: the path of a camera, and what becomes of a preparation.
#include "experiments/driver/next_frames.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "experiments/application/renderers.h"
#include "scene/base/error.h"
#include "tests/pictures.h"

namespace next_frames_test {

using namespace airlight;
using namespace airlight::experiments;
using Given = std::map<std::string, std::string>;

namespace {

std::shared_ptr<const scene::Scene> ball(const std::string& more = "") {
  return std::make_shared<const scene::Scene>(scene::parse_scene(R"(film = { width = 24, height = 18 }
[camera]
position = [0.5, 0.4, 3.2]
look_at = [0, 0, 0.2]
[[light]]
type = "directional"
to_light = [1, 2, 1]
irradiance = 3
[[medium]]
type = "gaussians"
albedo = 0.8
gaussians = [{ center = [0, 0, 0.2], width = 0.5, amplitude = 2 }, { center = [0.6, 0.1, -0.3], width = 0.3, amplitude = 3 }]
)" + more,
                                                                 "ball", "."));
}

// Keeps the cameras that it was asked for; its picture is their number.
class Cameras final : public scene::Prepared {
 public:
  std::vector<scene::Stage> stages() const override { return {}; }
  scene::Rendering render(const scene::View& view, const scene::Execution&) const override {
    seen.push_back(view.camera);
    return {scene::Film(view.width, view.height), {}, {{"frames", double(seen.size())}}};
  }
  mutable std::vector<scene::Camera> seen;
};

scene::Film last_frame(const std::string& renderer, const Given& given, const Moving& moving) {
  const scene::Renderer& found = find_renderer(renderer, "next_frames_test");
  const auto scene = ball();
  std::shared_ptr<scene::Prepared> prepared = found.prepare(scene, {found.settings(), given}, {1, {}});
  return NextFrames(prepared, scene, moving).render(view_of(*scene), {1, {}}).film;
}

}  // namespace

TEST_CASE("next frames: a camera turns around the media in equal steps and ends at its own place", "[experiments]") {
  const auto scene = ball();
  const auto cameras = std::make_shared<Cameras>();
  NextFrames frames(cameras, scene, read_moving({{"what", "camera"}, {"frames", "5"}, {"turn", "0.1"}}, "test"));
  CHECK(frames.render(view_of(*scene), {}).counters.at("frames") == 5);
  CHECK((cameras->seen.back().position == scene->camera.position));
  const Point3 middle = unite(bounding_box(scene->media[0]), Box{}).center();
  for (std::size_t i = 0; i < 5; ++i) {
    const scene::Camera& camera = cameras->seen[i];
    CHECK((camera.position - middle).norm() == Approx((scene->camera.position - middle).norm()).epsilon(1e-12));
    CHECK(camera.forward.dot(scene->camera.forward) < 1 + 1e-12);
    CHECK(camera.right.cross(camera.forward).dot(camera.up) == Approx(1).epsilon(1e-12));
    if (i == 0) continue;
    const Vec3 up = scene->camera.up, before = cameras->seen[i - 1].right;
    CHECK(std::atan2(before.cross(camera.right).dot(up), before.dot(camera.right)) == Approx(0.1).epsilon(1e-9));
  }
  // To and fro between the last two.
  for (int run = 0; run < 3; ++run) frames.again(view_of(*scene), {});
  CHECK((cameras->seen[5].position == cameras->seen[3].position));
  CHECK((cameras->seen[6].position == cameras->seen[4].position));
  CHECK((cameras->seen[7].position == cameras->seen[3].position));
}

TEST_CASE("next frames: the last one of a preparation without a memory is the scene as it stands", "[experiments]") {
  const auto scene = ball();
  for (const char* const renderer : {"ray_marcher", "half_resolution_march"}) {
    const Given given{{"steps", "8"}};
    const scene::Renderer& found = find_renderer(renderer, "next_frames_test");
    const auto still = found.prepare(scene, {found.settings(), given}, {1, {}})->render(view_of(*scene), {1, {}}).film;
    CHECK(last_frame(renderer, given, {Moving::What::camera, 3, 0.2}).layers == still.layers);
  }
}

TEST_CASE("next frames: with a memory the last one holds the frames before", "[experiments]") {
  const Given alone{{"steps", "8"}}, going_on{{"steps", "8"}, {"reproject", "true"}};
  const scene::Film truth =
      last_frame("half_resolution_march", {{"steps", "256"}, {"jitter", "none"}}, {Moving::What::camera, 2, 0});
  const auto error = [&](const Given& given, double turn) {
    return test::relative_l2(last_frame("half_resolution_march", given, {Moving::What::camera, 24, turn}), truth,
                             "airlight");
  };
  const double one = error(alone, 0.001), rested = error(going_on, 0), moved = error(going_on, 0.001),
               far = error(going_on, 0.3);
  CAPTURE(one, rested, moved, far);
  CHECK(rested < 0.7 * one);
  CHECK(moved < 0.8 * one);
  CHECK(far > one);
}

TEST_CASE("next frames: what cannot move is told", "[experiments]") {
  const auto scene = ball();
  const auto reason = [](const auto& job) -> std::string {
    try {
      job();
    } catch (const scene::NotSupported& refused) {
      return refused.reason;
    }
    return "";
  };
  CHECK(reason([&] {
          NextFrames(std::make_shared<Cameras>(), scene, {Moving::What::fog, 2, 0});
        }) == "the scene has no fog that could move");
  NextFrames lights(std::make_shared<Cameras>(), scene, {Moving::What::lights, 2, 0});
  CHECK(reason([&] { lights.render(view_of(*scene), {}); }) == "its lights cannot move: every frame is prepared anew");
  CHECK_THROWS_WITH(read_moving({{"what", "clouds"}}, "file:3:1"),
                    Catch::Contains("file:3:1") && Catch::Contains("camera"));
  CHECK_THROWS_WITH(read_moving({{"what", "lights"}, {"turn", "0.1"}}, "file:3:1"), Catch::Contains("turn"));
}

TEST_CASE("next frames: media of every form move by a millimetre", "[experiments]") {
  // A picture of what moved is that of a camera which moved the other way.
  for (
      const char* const medium :
      {"type = \"gaussians\"\ngaussians = [{ center = [0.3, 0, 0], width = 0.4, amplitude = 2 }]",
       "type = \"homogeneous\"\nregion = { type = \"sphere\", center = [0, 0, 0], radius = 0.8 }",
       "type = \"homogeneous\"\nregion = { type = \"box\", lo = [-0.8, -1, -1], hi = [0.7, 1, 1] }",
       "type = \"grid\"\nsize = [2, 2, 2]\nvoxel_size = 0.7\norigin = [-0.5, -0.5, -0.5]\nvalues = [1, 2, 3, 4, 5, 6, 7, 8]",
       "type = \"legendre\"\nlo = [-1, -1, -1]\nhi = [1, 1, 1]\nsize = [2, 1, 1]\ncoefficients = [3, 1]"}) {
    CAPTURE(medium);
    const auto scene = [&](double x) {
      return std::make_shared<const scene::Scene>(
          scene::parse_scene("film = { width = 6, height = 6 }\n[camera]\nposition = [" + std::to_string(x) +
                                 ", 0.2, 4]\nlook_at = [" + std::to_string(x) +
                                 ", 0, 0]\n[[light]]\ntype = \"directional\"\nto_light = [1, 1, 1]\nirradiance = 3\n"
                                 "[[medium]]\nsigma_t = 0.7\n" +
                                 medium + "\n",
                             "moved", "."));
    };
    const scene::Renderer& quadrature = find_renderer("deterministic", "next_frames_test");
    const auto drawn = [&](const std::shared_ptr<const scene::Scene>& of) {
      return test::picture(quadrature, of, {{"relative_tolerance", "1e-8"}});
    };
    const scene::Film still = drawn(scene(0)), moved = drawn(moved_back(*scene(0), {Moving::What::media})),
                      aside = drawn(scene(-1e-3));
    CHECK(test::relative_l2(moved, aside, "airlight") < 1e-6);
    CHECK(test::relative_l2(moved, still, "airlight") > 1e-5);
  }
}

TEST_CASE("next frames: lights of every kind move", "[experiments]") {
  for (const char* const light :
       {"type = \"point\"\nintensity = 1\nposition = [1, 2, 3]",
        "type = \"spot\"\nintensity = 1\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\nouter_angle = 0.5",
        "type = \"directional\"\nirradiance = 1\nto_light = [1, 1, 1]",
        "type = \"environment\"\nsh = [[1, 1, 1], [0.1, 0.1, 0.1], [0.2, 0.2, 0.2], [0.3, 0.3, 0.3]]"}) {
    CAPTURE(light);
    const auto scene = std::make_shared<const scene::Scene>(scene::parse_scene(
        "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n[[light]]\n" + std::string(light) + "\n", "lit", "."));
    const auto moved = moved_back(*scene, {Moving::What::lights});
    CHECK(moved->light_hash != scene->light_hash);
    CHECK(moved->matter_hash == scene->matter_hash);
  }
}

TEST_CASE("next frames: the time after something moved, and whether all was prepared anew", "[experiments]") {
  const auto scene = ball();
  const auto after = [&](const char* renderer, Moving::What what, const Given& given) {
    const scene::Renderer& found = find_renderer(renderer, "next_frames_test");
    return frame_after(what, found, {found.settings(), given}, scene, view_of(*scene), {1, {}}, 0.05);
  };
  const Given steps{{"steps", "4"}}, map{{"steps", "4"}, {"shadow", "map"}, {"map_size", "256"}};
  const auto camera = after("ray_marcher", Moving::What::camera, map),
             light = after("ray_marcher", Moving::What::lights, map);
  REQUIRE(camera);
  REQUIRE(light);
  CHECK((!camera->anew && camera->seconds > 0));
  CHECK((!light->anew && light->seconds > camera->seconds));    // the map is made again, and nothing else
  CHECK_FALSE(after("ray_marcher", Moving::What::fog, steps));  // there is no fogmap
  const auto traced = after("path_tracer", Moving::What::lights, {{"samples", "1"}});
  REQUIRE(traced);
  CHECK(traced->anew);
  const auto kept = after("compensated_ray_marching", Moving::What::lights, {{"cells", "8"}});
  REQUIRE(kept);
  CHECK_FALSE(kept->anew);
}

}  // namespace next_frames_test
