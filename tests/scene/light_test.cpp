#include "scene/light/light.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/scene.h"

namespace light_test {

using namespace airlight;
using namespace airlight::scene;

TEST_CASE("a point light falls off with the square of the distance", "[light]") {
  const Light light = PointLight{{1, 2, 3}, {4, 8, 12}, 0.1};
  CHECK(is_delta(light));
  CHECK(light_name(light) == "point");
  const Incident at = incident(light, {1, 2, 1});
  CHECK(at.distance == 2);
  CHECK(at.to_light == Vec3(0, 0, 1));
  CHECK((at.irradiance == Rgb(1, 2, 3)).all());
  CHECK(ball(light)->radius == 0.1);
  CHECK(std::isinf(incident(light, {1, 2, 3}).irradiance[0]));
}

TEST_CASE("a directional light is the same everywhere", "[light]") {
  const Light light = DirectionalLight{{0, 1, 0}, {1, 2, 3}};
  const Incident at = incident(light, {5, -7, 1});
  CHECK(at.to_light == Vec3(0, 1, 0));
  CHECK(std::isinf(at.distance));
  CHECK((at.irradiance == Rgb(1, 2, 3)).all());
  CHECK_FALSE(ball(light));
  CHECK(is_delta(light));
}

TEST_CASE("a spot light has a full cone, a dark outside and a smooth edge", "[light]") {
  SpotLight spot;
  spot.axis = {0, -1, 0};
  spot.inner_angle = 0.3;
  spot.outer_angle = 0.5;
  spot.intensity = Rgb::Constant(2);
  const auto at_angle = [&](double angle) {
    return intensity_towards(spot, Vec3(std::sin(angle), -std::cos(angle), 0))[0];
  };
  CHECK(at_angle(0) == 2);
  CHECK(at_angle(0.299) == 2);
  CHECK(at_angle(0.501) == 0);
  CHECK(at_angle(3.1) == 0);
  // Halfway in the cosine the smoothstep is 1/2.
  const double middle = std::acos(0.5 * (std::cos(0.3) + std::cos(0.5)));
  CHECK(at_angle(middle) == Approx(1).epsilon(1e-13));
  // A quarter and three quarters of the way 3/16 - 2/64 = 5/32, and 27/32: no straight line, which has 1/4 and 3/4.
  const auto at_share = [&](double t) {
    return at_angle(std::acos(std::cos(0.5) + t * (std::cos(0.3) - std::cos(0.5))));
  };
  CHECK(at_share(0.25) == Approx(2 * 5.0 / 32).epsilon(1e-12));
  CHECK(at_share(0.75) == Approx(2 * 27.0 / 32).epsilon(1e-12));
  double last = 2;
  for (double angle = 0.3; angle <= 0.5; angle += 0.01) {
    CHECK(at_angle(angle) <= last);
    last = at_angle(angle);
  }
  // A sharp edge is no division by zero; a cone of pi is a point light.
  spot.inner_angle = spot.outer_angle = 0.5;
  CHECK(at_angle(0.499) == 2);
  CHECK(at_angle(0.501) == 0);
  spot.inner_angle = spot.outer_angle = pi;
  CHECK(at_angle(pi) == 2);
  // Light that reaches a point: intensity over distance squared, nothing outside the cone.
  spot.inner_angle = 0.3;
  spot.outer_angle = 0.5;
  CHECK(incident(spot, {0, -2, 0}).irradiance[0] == Approx(0.5).epsilon(1e-15));
  CHECK(incident(spot, {2, 0, 0}).irradiance[0] == 0);
}

TEST_CASE("rays end on the nearest ball of a light", "[light]") {
  Scene scene;
  scene.lights = {PointLight{{0, 0, -5}, Rgb::Ones(), 0.5}, SpotLight{{0, 0, -3}},
                  PointLight{{0, 0, -9}, Rgb::Ones(), 2}, DirectionalLight{}};
  const Vec3 ahead(0, 0, -1);
  const RayEnd end = ray_end(scene, {{0, 0, 0}, ahead});
  CHECK(end.on_ball);
  CHECK_FALSE(end.hit);
  CHECK(end.t == Approx(4.5).epsilon(1e-15));
  // 0.6 off the axis: past the first ball, on the second at 9 - sqrt(4 - 0.36).
  CHECK(ray_end(scene, {{0.6, 0, 0}, ahead}).t == Approx(9 - std::sqrt(3.64)).epsilon(1e-15));
  CHECK_FALSE(ray_end(scene, {{2.1, 0, 0}, ahead}).on_ball);
  CHECK(std::isinf(ray_end(scene, {{0, 0, 0}, -ahead}).t));
  // Grazing from 1e6 away: the distance from the centre is known to about 1e-10, so 0.5 -+ 1e-9 are told apart.
  CHECK(ray_end(scene, {{0.5 - 1e-9, 0, 1e6}, ahead}).t == Approx(1e6 + 5).epsilon(1e-9));
  scene.lights.pop_back();
  scene.lights.pop_back();
  CHECK_FALSE(ray_end(scene, {{0.5 + 1e-9, 0, 1e6}, ahead}).on_ball);
}

}  // namespace light_test
