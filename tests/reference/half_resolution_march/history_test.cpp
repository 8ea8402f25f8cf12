// Pictures that go on from the last one, whose history is moved to their camera.
#include "reference/half_resolution_march/history.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/geometry/shapes.h"
#include "tests/reference/half_resolution_march/fog_scenes.h"

namespace half_history_test {

using namespace airlight;
using namespace airlight::half_resolution_march;
using test::relative_l2;

namespace {

const Vec3 sun = Vec3(1, 2, 1).normalized();

scene::Camera camera_at(double angle) {
  scene::Camera camera =
      scene::look_at(Point3(3 * std::sin(angle), 0.4, 3 * std::cos(angle)), Point3::Zero(), Vec3::UnitY());
  camera.vertical_fov = 0.9;
  return camera;
}

std::shared_ptr<scene::Scene> smoke(const scene::Camera& camera, bool floor = false, const Vec3& to_sun = sun,
                                    int width = 96, int height = 72) {
  scene::GaussianSum sum;
  sum.gaussians = {{Point3(0.1, 0.2, 0), 0.3, 2.0}, {Point3(-0.4, 0, 0.3), 0.2, 3.0}};
  auto scene =
      ray_marcher::make_scene({ray_marcher::make_medium(sum, scene::Unbounded{}, Rgb(2, 3, 4), Rgb(0.9, 0.7, 0.5))},
                              {scene::DirectionalLight{to_sun, Rgb(2, 2, 2)}});
  if (floor)
    scene->surfaces = {
        {"floor", scene::Plane{Point3(0, -0.5, 0), Vec3::UnitY()}, scene::Lambert{Rgb::Constant(0.5)}},
        {"box", scene::make_box({Point3(0.2, -0.5, 0.4), Point3(0.6, 0.1, 0.7)}), scene::Lambert{Rgb(0.5, 0.4, 0.3)}}};
  scene->camera = camera;
  scene->width = width;
  scene->height = height;
  finish(*scene);
  return scene;
}

Given going_on(Given given = {}) {
  given.insert({{"reproject", "true"}, {"steps", "6"}, {"map_size", "64"}});
  return given;
}

std::unique_ptr<scene::Prepared> prepared(const std::shared_ptr<const scene::Scene>& scene, const Given& given,
                                          int threads = 1) {
  return HalfResolutionMarch().prepare(scene, {HalfResolutionMarch().settings(), given}, {threads, {}});
}

// The last of pictures of these scenes.
template <class SceneAt>
scene::Rendering last_of(int pictures, const SceneAt& scene_at, const Given& given, int threads = 1) {
  const auto frames = prepared(scene_at(0), given, threads);
  scene::Rendering rendering = frames->render(view_of(*scene_at(0)), {threads, {}});
  for (int i = 1; i < pictures; ++i) {
    const auto scene = scene_at(i);
    REQUIRE(frames->next(scene, {threads, {}}));
    rendering = frames->render(view_of(*scene), {threads, {}});
  }
  return rendering;
}

Given alone(Given given) {
  for (const char* setting : {"reproject", "history_weight", "history_depth", "clamp"}) given.erase(setting);
  return given;
}

// A picture of the same scene in so many steps that it counts as the truth.
scene::Film truth(const std::shared_ptr<const scene::Scene>& scene) {
  return picture(scene, {{"steps", "256"}, {"jitter", "none"}, {"map_size", "64"}});
}

void set(LowFilm& film, float value, double depth) {
  for (FogPixel& fog : film.fog) fog.setConstant(value);
  film.depth.assign(film.fog.size(), depth);
}

}  // namespace

// Pictures are linear in their frames, of which the k-th is k times the mean of k less the others. An average's rounding grows with k.
TEST_CASE("half-resolution march: pictures of a camera that rests are a moving average", "[half_resolution_march]") {
  scene::Camera parallel = camera_at(0);
  parallel.kind = scene::Camera::Kind::orthographic;
  parallel.height = 2;
  for (const scene::Camera& camera : {camera_at(0), parallel}) {
    const auto scene = smoke(camera, true);
    for (const char* depth : {"airlight", "end"}) {
      const scene::Film film = last_of(
                                   5, [&](int) { return scene; }, going_on({{"history_depth", depth}}))
                                   .film;
      for (const char* layer : {"airlight", "transmittance", "surface"}) {
        std::vector<float> average, before;
        for (int k = 1; k <= 5; ++k) {
          Given given = alone(going_on());
          given["frames"] = std::to_string(k);
          const std::vector<float> mean = picture(scene, given).layer(layer);
          if (k == 1) average = mean, before.assign(mean.size(), 0);
          for (std::size_t i = 0; i < mean.size(); ++i) {
            const double frame = k * double(mean[i]) - (k - 1) * double(before[i]);
            average[i] = float(0.9 * average[i] + 0.1 * frame);
          }
          before = mean;
        }
        CAPTURE(depth, layer);
        CHECK(relative_l2(film.layer(layer), average) < 1e-6);
      }
    }
  }
}

// The weights of a moving average of 0.9 are those of 19 frames, so that offsets are averaged nearly as by the mean.
TEST_CASE("half-resolution march: a camera that rests converges to the mean of frames", "[half_resolution_march]") {
  const auto scene = smoke(camera_at(0), true);
  const scene::Film film = last_of(
                               48, [&](int) { return scene; }, going_on())
                               .film;
  Given many = alone(going_on());
  const scene::Film one = picture(scene, many);
  many["frames"] = "1024";
  const scene::Film mean = picture(scene, many);
  CAPTURE(relative_l2(film, mean), relative_l2(one, mean));
  CHECK(relative_l2(film, mean) < 0.1 * relative_l2(one, mean));
}

// Around the smoke in steps of 0.003 rad. The error is that to the mean over all offsets.
TEST_CASE("half-resolution march: while the camera moves, a history lowers the error", "[half_resolution_march]") {
  for (const bool floor : {false, true}) {
    const auto at = [&](int i) { return smoke(camera_at(0.003 * i), floor, sun, 128, 96); };
    Given many = alone(going_on());
    many["frames"] = "256";
    const scene::Film exact = picture(at(32), many);
    const auto error = [&](const Given& given) { return relative_l2(last_of(33, at, going_on(given)).film, exact); };
    const double one = relative_l2(picture(at(32), alone(going_on())), exact), moved = error({}),
                 ends = error({{"history_depth", "end"}}), clamped = error({{"clamp", "neighbourhood"}});
    CAPTURE(floor, one, moved, ends, clamped);
    CHECK(moved < 0.5 * one);
    CHECK(clamped < 0.5 * one);
    CHECK(moved < 0.7 * ends);
  }
}

// Eight pictures, then one that they have little to do with: the error is mostly the trail's.
TEST_CASE("half-resolution march: clamping removes trails", "[half_resolution_march]") {
  const auto check = [](const char* what, const auto& scene_at, const Given& more) {
    const scene::Film exact = truth(scene_at(8));
    const auto error = [&](const char* clamp) {
      Given given = going_on({{"clamp", clamp}, {"steps", "32"}});
      given.insert(more.begin(), more.end());
      return relative_l2(last_of(9, scene_at, given).film, exact);
    };
    const double none = error("none"), clamped = error("neighbourhood");
    CAPTURE(what, none, clamped);
    CHECK(clamped < 0.6 * none);
  };
  const Vec3 other_sun = Vec3(-2, 1, 0).normalized();
  check("the sun jumps", [&](int i) { return smoke(camera_at(0), true, i < 8 ? sun : other_sun, 192, 144); }, {});
  check("the camera jumps", [](int i) { return smoke(camera_at(i < 8 ? 0 : 0.4), true, sun, 192, 144); },
        {{"history_depth", "end"}});
}

TEST_CASE("half-resolution march: the first picture has no history, and pictures can be drawn again",
          "[half_resolution_march]") {
  const auto scene = smoke(camera_at(0), true);
  const Given given = going_on({{"clamp", "neighbourhood"}});
  const auto frames = prepared(scene, given);
  const scene::Rendering first = frames->render(view_of(*scene), {1, {}});
  CHECK(first.counters.at("history_used") == 0);
  CHECK(first.counters.at("history_rejected") == 0);
  CHECK(first.film.layers == picture(scene, alone(given)).layers);
  const auto second = test::next_frame(*frames, scene);
  CHECK(second.counters.at("history_used") > 0);
  CHECK(second.counters.at("history_rejected") == 0);
  CHECK(second.counters.at("history_clamped") > 0);
  CHECK(frames->render(view_of(*scene), {2, {}}).film.layers == second.film.layers);
  // A picture of another size has no history either; without reproject there is none.
  scene::View large = view_of(*scene);
  large.width = 100;
  CHECK(frames->render(large, {1, {}}).counters.at("history_used") == 0);
  const auto still = prepared(scene, {});
  const scene::Film one = still->render(view_of(*scene), {1, {}}).film;
  CHECK(test::next_frame(*still, scene).film.layers == one.layers);
}

// State that does not depend on the camera is kept; a light that moved has a map of its own.
TEST_CASE("half-resolution march: maps are made anew where lights moved", "[half_resolution_march]") {
  const Given given = going_on();
  const auto frames = prepared(smoke(camera_at(0), true), given);
  CHECK(frames->next(smoke(camera_at(0.1), true), {1, {}})->empty());
  const auto moved = smoke(camera_at(0.1), true, Vec3(-2, 1, 0).normalized());
  CHECK(frames->next(moved, {1, {}})->size() == 2);
  CHECK(frames->render(view_of(*moved), {1, {}}).film.layers ==
        last_of(
            3, [&](int) { return moved; }, going_on({{"history_weight", "0"}}))
            .film.layers);
}

TEST_CASE("half-resolution march: a moving camera's pictures have the same bits whatever the threads",
          "[half_resolution_march]") {
  const auto at = [](int i) { return smoke(camera_at(0.02 * i), true); };
  const Given given = going_on({{"clamp", "neighbourhood"}});
  CHECK(last_of(4, at, given, 1).film.layers == last_of(4, at, given, 2).film.layers);
}

TEST_CASE("half-resolution march: what the last camera did not see is new", "[half_resolution_march]") {
  const Given given = going_on({{"jitter", "none"}});
  const auto turned = [](double angle) {
    scene::Camera camera = camera_at(0);
    const Mat3 turn = Eigen::AngleAxisd(angle, camera.up).toRotationMatrix();
    camera.forward = turn * camera.forward;
    camera.right = turn * camera.right;
    return smoke(camera);
  };
  const auto away = last_of(
      2, [&](int i) { return turned(i == 0 ? pi : 0); }, given);
  CHECK(away.counters.at("history_used") == 0);
  CHECK(away.film.layers == picture(turned(0), alone(given)).layers);
  const auto some = last_of(
      2, [&](int i) { return turned(i == 0 ? 0.6 : 0); }, given);
  CHECK(some.counters.at("history_used") > 100);
  CHECK(some.counters.at("history_rejected") > 100);
}

// The last picture is 1 everywhere, this one 0; a block counts where it is as far as the ray's end.
TEST_CASE("half-resolution march: the history is that of rays that end as far away", "[half_resolution_march]") {
  History history{LowFilm(8, 8, 2), {}};
  set(history.film, 1, 5);
  for (int y = 0; y < 4; ++y)
    for (int x = 2; x < 4; ++x)
      history.film.fog[history.film.at(x, y)].setConstant(0.5f), history.film.depth[history.film.at(x, y)] = infinity;
  const auto blended = [&](double x, double depth, bool clamp, Counters& counters) {
    LowFilm film(8, 8, 2);
    set(film, 0, depth);
    Options options;
    options.clamp = clamp;
    std::vector<Trace> traces(film.fog.size());
    traces[film.at(1, 1)] = {true, true, x, 3, depth};
    blend(options, history, traces, 0.1, film, {1, {}}, counters);
    CHECK(film.fog[film.at(2, 1)][0] == 0);  // meets no medium
    return film.fog[film.at(1, 1)][0];
  };
  Counters counters;
  CHECK(blended(3, 5, false, counters) == Approx(0.9));
  CHECK(blended(4, 5.05, false, counters) == Approx(0.9));  // between blocks of both depths: the one that fits
  CHECK(blended(4, infinity, false, counters) == Approx(0.45));
  CHECK(blended(1.5, infinity, false, counters) == 0);  // none fits
  CHECK(blended(3, 5.2, false, counters) == 0);
  CHECK((counters.history_used == 3 && counters.history_rejected == 2));
  CHECK(blended(3, 5, true, counters) == 0);  // all around is 0
  CHECK(counters.history_clamped == 1);
}

}  // namespace half_history_test
