#include "scene/camera.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/base/error.h"
#include "scene/camera_rays.h"

namespace camera_test {

using namespace airlight;
using namespace airlight::scene;

// Tolerances here: a handful of roundings of numbers near 1, 1e-15 each.

TEST_CASE("a camera is a right-handed frame whose up is upwards", "[camera]") {
  for (const Vec3& target : {Vec3(0, 0, 0), Vec3(3, -2, 7), Vec3(-1e-3, 5, 2), Vec3(1e200, 1, -1e200)}) {
    const Camera camera = look_at({1, 2, 3}, target, {0, 2, 0});
    Mat3 frame;
    frame << camera.right, camera.up, -camera.forward;
    CHECK((frame.transpose() * frame - Mat3::Identity()).norm() < 1e-14);
    CHECK(frame.determinant() == Approx(1).epsilon(1e-14));
    CHECK(camera.up[1] > 0);
    CHECK(std::abs(camera.right[1]) < 1e-15);
  }
  CHECK_THROWS_AS(look_at({1, 2, 3}, {1, 2, 3}, {0, 1, 0}), Error);
  CHECK_THROWS_AS(look_at({1, 2, 3}, {1, 5, 3}, {0, -4, 0}), Error);
  CHECK_THROWS_AS(look_at({1, 2, 3}, {1, 5, 3}, {0, 0, 0}), Error);
}

TEST_CASE("perspective rays span the vertical field of view", "[camera]") {
  Camera camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  camera.vertical_fov = 0.8;
  const int width = 200, height = 100;
  CHECK((camera_ray(camera, 100, 50, width, height).direction - Vec3(0, 0, -1)).norm() < 1e-15);
  // The middle of the top edge is half the field of view above the axis; the right edge has tan = aspect * tan(fov /
  // 2).
  const Vec3 top = camera_ray(camera, 100, 0, width, height).direction;
  CHECK(std::atan2(top[1], -top[2]) == Approx(0.4).epsilon(1e-14));
  const Vec3 right = camera_ray(camera, 200, 50, width, height).direction;
  CHECK(right[0] / -right[2] == Approx(2 * std::tan(0.4)).epsilon(1e-14));
  // The centre of the top left pixel.
  const Vec3 first = camera_ray(camera, 0.5, 0.5, width, height).direction;
  CHECK(first[0] < 0);
  CHECK(first[1] > 0);
  CHECK(first[0] / first[2] == Approx(0.995 * 2 * std::tan(0.4)).epsilon(1e-14));
  CHECK(first.norm() == Approx(1).epsilon(1e-15));
}

TEST_CASE("orthographic rays are parallel and as far apart as the film is large", "[camera]") {
  Camera camera = look_at({1, 2, 3}, {1, 2, -3}, {0, 1, 0});
  camera.kind = Camera::Kind::orthographic;
  camera.height = 4;
  const Ray top_left = camera_ray(camera, 0, 0, 30, 20);
  const Ray bottom_right = camera_ray(camera, 30, 20, 30, 20);
  CHECK(top_left.direction == Vec3(0, 0, -1));
  CHECK(bottom_right.direction == Vec3(0, 0, -1));
  CHECK((top_left.origin - Point3(-2, 4, 3)).norm() < 1e-14);
  CHECK((bottom_right.origin - Point3(4, 0, 3)).norm() < 1e-14);
}

TEST_CASE("film positions are where the rays of cameras begin", "[camera]") {
  Camera camera = look_at({1, 2, 3}, {0.5, 1, -3}, {0, 1, 0});
  camera.height = 4;
  for (const Camera::Kind kind : {Camera::Kind::perspective, Camera::Kind::orthographic}) {
    camera.kind = kind;
    for (const double t : {0.1, 7.0}) {
      const Ray ray = camera_ray(camera, 3.5, 17.25, 30, 20);
      const Vec3 place = film_position(camera, ray.at(t), 30, 20);
      CHECK(place[0] == Approx(3.5).epsilon(1e-13));
      CHECK(place[1] == Approx(17.25).epsilon(1e-13));
      CHECK(place[2] == Approx(t * ray.direction.dot(camera.forward)).epsilon(1e-13));
    }
  }
}

}  // namespace camera_test
