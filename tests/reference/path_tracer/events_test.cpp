// A cap on scatterings and reflections together (setting `max_events`): against paths told apart by the albedo of the floor.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/path_tracer/unsupported.h"
#include "tests/reference/path_tracer/scenes.h"

namespace events_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

const Vec3 up(0, 1, 0);
constexpr std::uint64_t samples = 1 << 17;

// Fog over a floor, under a sky and a lamp that is close enough to be connected.
std::shared_ptr<const scene::Scene> scene_with(double floor_albedo) {
  return scene_of({medium(scene::Sphere{Point3(0, 1.2, 0), 0.8}, 1.5, 0.7)},
                  {white(), scene::PointLight{Point3(0.4, 2.2, 0.3), Rgb::Constant(5), 0}},
                  {{"floor", scene::Plane{Point3::Zero(), up}, scene::Lambert{Rgb::Constant(floor_albedo)}}});
}

RadianceEstimate estimate(double floor_albedo, int max_order, int max_events, std::uint32_t index) {
  Options options;
  options.max_order = max_order;
  options.max_events = max_events;
  const Ray ray = ray_of({0.2, 1.3, 2.5}, {0, -0.6, -2.5});  // through the fog, to the floor
  return radiance(World(scene_with(floor_albedo), options), ray, samples, {}, index);
}

bool agree(double got, double expected, double error, double z) { return std::abs(got - expected) < z * error; }

}  // namespace

TEST_CASE("one event: scattered once by the medium, or reflected once", "[path_tracer]") {
  const RadianceEstimate once = estimate(0.6, -1, 1, 7);
  const Estimate scattered = estimate(0, 1, -1, 8).orders[1];    // by the medium alone: the floor is black
  const Estimate reflected = estimate(0.6, 0, -1, 9).orders[0];  // a plane does not see itself
  const double expected = scattered.mean[0] + reflected.mean[0];
  const double error = std::hypot(scattered.error[0], reflected.error[0], once.total.error[0]);
  CAPTURE(once.total.mean[0], expected, error);
  CHECK(agree(once.total.mean[0], expected, error, threshold(1e-6, 1)));
  CHECK(error < 0.005 * expected);
  CHECK(std::abs(once.total.mean[0] - once.airlight[0] - once.surface[0]) < 1e-12 * expected);
  // Light that a cap on scatterings alone adds can be told from it: the floor lit by the fog, the fog by the floor.
  const Estimate capped = estimate(0.6, 1, -1, 10).total;
  CHECK(capped.mean[0] - expected > 10 * std::hypot(error, capped.error[0]));
}

TEST_CASE("two events: one reflection of what is scattered once", "[path_tracer]") {
  const Estimate none = estimate(0, -1, 2, 11).orders[1], some = estimate(0.4, -1, 2, 12).orders[1],
                 more = estimate(0.8, -1, 2, 13).orders[1];
  const double second = more.mean[0] - 2 * some.mean[0] + none.mean[0];  // what two reflections would bring
  const double error = std::hypot(more.error[0], 2 * some.error[0], none.error[0]);
  CAPTURE(none.mean[0], some.mean[0], more.mean[0], second, error);
  CHECK(agree(second, 0, error, threshold(1e-6, 2)));
  CHECK(more.mean[0] - none.mean[0] > 20 * error);
  const RadianceEstimate twice = estimate(0, -1, 2, 14);
  const Estimate scattered = estimate(0, 2, -1, 15).total;
  CHECK(agree(twice.total.mean[0], scattered.mean[0], std::hypot(twice.total.error[0], scattered.error[0]),
              threshold(1e-6, 2)));
  CHECK(twice.orders[3].mean[0] == 0);
}

TEST_CASE("paths = scattered: all light but what is seen through the medium", "[path_tracer]") {
  const auto scene = scene_with(0.6);
  const Ray ray = ray_of({0.2, 1.3, 2.5}, {0, -0.6, -2.5}), beyond{ray.at(3.6), ray.direction};
  REQUIRE(scene::density(scene->media[0], beyond.origin) == 0);
  Options options;
  const RadianceEstimate all = radiance(World(scene, options), ray, samples, {}, 21);
  const RadianceEstimate behind = radiance(World(scene, options), beyond, samples, {}, 22);
  options.paths = Options::Paths::scattered;
  const RadianceEstimate scattered = radiance(World(scene, options), ray, samples, {}, 23);
  const double passed = scene::transmittance(scene->media, ray, {0, 3.6})[0];
  const double expected = all.total.mean[0] - passed * behind.total.mean[0];
  const double error = std::hypot(all.total.error[0], passed * behind.total.error[0], scattered.total.error[0]);
  CAPTURE(scattered.total.mean[0], expected, error, passed);
  CHECK(agree(scattered.total.mean[0], expected, error, threshold(1e-6, 1)));
  CHECK(error < 0.01 * expected);
  CHECK(passed * behind.total.mean[0] > 20 * error);
  CHECK(scattered.orders[0].mean[0] == 0);
  CHECK(radiance(World(scene, options), beyond, 64).total.mean[0] == 0);
}

TEST_CASE("a cap on events and paths of a lit surface exclude one another", "[path_tracer]") {
  Options options;
  options.max_events = 1;
  CHECK(unsupported(*scene_with(0.5), options).empty());
  options.paths = Options::Paths::lit_surface;
  CHECK_THAT(unsupported(*scene_with(0.5), options).at(0), Catch::Contains("max_events"));
}

}  // namespace events_test
