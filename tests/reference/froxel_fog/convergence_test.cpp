// The orders at which froxel fog reaches quadrature: in slices, in the cell's side, in frames.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/deterministic/airlight.h"
#include "tests/reference/froxel_fog/fog_scenes.h"

namespace convergence_test {

using namespace airlight;
using namespace airlight::froxel_fog;

namespace {

constexpr double far = 8;  // [m], of the slices and of the truth

// Endless fog around a lamp that no ray comes close to: smooth, and its depths towards the lamp are exact.
std::shared_ptr<scene::Scene> foggy_lamp(double density, int width, int height, double vertical_fov = 0.9) {
  scene::Camera camera = wide_camera();
  camera.vertical_fov = vertical_fov;
  return fog_scene({make_medium(scene::Homogeneous{density}, scene::Unbounded{}, Rgb(0.3, 0.5, 0.8), Rgb(0.9, 0.7, 0.5),
                                scene::HenyeyGreenstein{0.3})},
                   {scene::PointLight{Point3(0.5, 3, -1), Rgb(30, 20, 10), 0}}, camera, width, height);
}

std::vector<float> truth(const scene::Scene& scene) {
  const deterministic::AirlightIntegrator integrate(scene, {1e-10, 200000});
  std::vector<float> airlight;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const Ray ray = camera_ray(scene.camera, x + 0.5, y + 0.5, scene.width, scene.height);
      const auto exact = integrate(ray, far / ray.direction.dot(scene.camera.forward));
      REQUIRE(exact.converged);
      for (const double value : exact.radiance) airlight.push_back(float(value));
    }
  return airlight;
}

Given with(Given given, const std::string& name, int value) {
  given[name] = std::to_string(value);
  given["far"] = std::to_string(far);
  return given;
}

// log2 of the ratio of errors from one value of a setting to the next.
std::vector<double> orders(const std::vector<double>& errors, double ratio) {
  std::vector<double> result;
  for (std::size_t i = 1; i < errors.size(); ++i)
    result.push_back(std::log(errors[i - 1] / errors[i]) / std::log(ratio));
  return result;
}

}  // namespace

TEST_CASE("froxel fog: order 2 in slices", "[froxel_fog]") {
  const auto scene = foggy_lamp(1, 12, 8);
  const std::vector<float> exact = truth(*scene);
  for (Given given :
       {Given{{"tile", "1"}}, Given{{"tile", "1"}, {"depth", "log"}}, Given{{"tile", "1"}, {"depth", "power"}}}) {
    std::vector<double> errors;
    for (const int slices : {16, 32, 64, 128, 256})
      errors.push_back(test::relative_l2(fog(scene, with(given, "slices", slices)).layer("airlight"), exact));
    CAPTURE(given, errors);
    for (const double order : orders(errors, 2)) CHECK(order == Approx(2).margin(0.1));
    CHECK(errors.back() < 1e-4);
  }
}

// Away from the film's edge, where half a cell lies beyond the outermost middles and nothing is left to interpolate between.
TEST_CASE("froxel fog: order 2 in the cell's side", "[froxel_fog]") {
  const auto scene = foggy_lamp(1, 96, 64);
  const std::vector<float> all = truth(*scene);
  const auto inner = [&](const std::vector<float>& layer) {
    std::vector<float> kept;
    for (int y = 8; y < 56; ++y)
      for (int i = 3 * 8; i < 3 * 88; ++i) kept.push_back(layer[std::size_t(3 * 96 * y + i)]);
    return kept;
  };
  std::vector<double> errors;
  for (const int tile : {16, 8, 4})
    errors.push_back(
        test::relative_l2(inner(fog(scene, with({{"slices", "1024"}}, "tile", tile)).layer("airlight")), inner(all)));
  CAPTURE(errors);
  for (const double order : orders(errors, 2)) CHECK(order == Approx(2).margin(0.2));
}

// In thin fog the mean over frames is a sum over more slices; pixels are so small that only depths matter. Base 5 of the Halton sequence: after 5^m frames its points lie 5^-m apart.
TEST_CASE("froxel fog: order 1 in Halton's frames, and HDRP's seven are seven times the slices", "[froxel_fog]") {
  const auto scene = foggy_lamp(1e-4, 6, 4, 0.01);
  const std::vector<float> exact = truth(*scene);
  std::vector<double> errors;
  for (const int frames : {5, 25, 125})
    errors.push_back(test::relative_l2(
        fog(scene, with({{"tile", "1"}, {"slices", "8"}, {"jitter", "halton"}}, "frames", frames)).layer("airlight"),
        exact));
  CAPTURE(errors);
  for (const double order : orders(errors, 5)) CHECK(order == Approx(1).margin(0.15));
  const scene::Film frames = fog(scene, with({{"tile", "1"}, {"slices", "8"}, {"jitter", "hdrp"}}, "frames", 7));
  const scene::Film slices = fog(scene, with({{"tile", "1"}}, "slices", 56));
  CHECK(test::relative_l2(frames, slices) < 1e-5);
}

}  // namespace convergence_test
