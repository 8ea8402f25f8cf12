// The layer (1, 0) beside a surface that reflects: light reflected and then scattered, (1, 1), must not be in it.
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "reference/deterministic/renderer.h"
#include "reference/path_tracer/renderer.h"
#include "tests/reference/path_tracer/scenes.h"

namespace airlight_layer_test {

using namespace airlight;

namespace {

double mean_of(const std::vector<float>& layer) {
  return std::accumulate(layer.begin(), layer.end(), 0.0) / double(layer.size());
}

}  // namespace

// Sixteen independent repeats against the quadrature: Student's t with 15 degrees of freedom, |t| > 7.5 at a
// false-alarm rate of 2e-6. The fault that this guards against was 20 % of the layer, and the smallest bias that it
// sees is printed by CAPTURE.
TEST_CASE("the airlight layer beside a reflecting floor is the quadrature's", "[path_tracer]") {
  auto world = path_tracer::test::scene_of(
      {path_tracer::test::medium(Box{Point3(-2, -1, -2), Point3(2, 2, 2)}, 0.5, 0.9)},
      {scene::PointLight{Point3(0.2, -0.2, 0), Rgb::Ones(), 0}},
      {{"floor", scene::Plane{Point3(0, -0.5, 0), Vec3::UnitY()}, scene::Lambert{Rgb::Constant(0.9)}}});
  world->camera = scene::look_at(Point3(0, 0.5, 5), Point3(0, 0, 0), Vec3::UnitY());
  world->width = 8;
  world->height = 6;
  scene::finish(*world);
  const auto layer = [&](const scene::Renderer& renderer, const std::map<std::string, std::string>& given) {
    const scene::Settings settings(renderer.settings(), given);
    return mean_of(renderer.prepare(world, settings, {})->render(scene::view_of(*world), {}).film.layer("airlight"));
  };
  const double truth = layer(*deterministic::make_renderer(), {});
  const int repeats = 16;
  double sum = 0, squares = 0;
  for (int i = 0; i < repeats; ++i) {
    const double x = layer(path_tracer::PathTracer(), {{"samples", "512"}, {"seed", std::to_string(i + 1)}});
    sum += x;
    squares += x * x;
  }
  const double mean = sum / repeats;
  const double error = std::sqrt((squares / repeats - mean * mean) / (repeats - 1));
  CAPTURE(truth, mean, error, (7.5 + 1.645) * error / truth);
  CHECK(error < 0.01 * truth);
  CHECK(std::abs(mean - truth) < 7.5 * error);
}

}  // namespace airlight_layer_test
