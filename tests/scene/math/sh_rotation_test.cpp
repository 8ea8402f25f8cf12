// Harmonics turned in space against the function itself, looked up at turned directions.
#include "scene/math/sh_rotation.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/base/error.h"
#include "scene/math/spherical_harmonics.h"

namespace sh_rotation_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

std::vector<Rgb> some_function(int order) {
  std::vector<Rgb> f;
  for (int i = 0; i < order * order; ++i)
    f.emplace_back(std::sin(1.3 * i + 1), std::cos(2.1 * i), std::sin(0.7 * i * i));
  return f;
}

void check(int order, const Mat3& rotation) {
  const std::vector<Rgb> f = some_function(order), g = turned_sh(f, rotation);
  for (int i = 0; i < 20; ++i) {
    const double z = -0.95 + 0.1 * i, s = std::sqrt(1 - z * z);
    const Vec3 w(s * std::cos(2.4 * i), s * std::sin(2.4 * i), z);
    CHECK(((evaluate_sh(g, rotation * w) - evaluate_sh(f, w)).abs() < 1e-12).all());
  }
}

}  // namespace

TEST_CASE("turned harmonics are the function turned", "[math]") {
  const Vec3 axis = Vec3(0.3, -0.5, 0.8).normalized();
  for (const int order : {1, 2, 4, 6, 12}) {
    for (const double angle : {0.0, 1e-9, 0.4, 1.7, pi, 4.9})
      for (const Vec3& about : {axis, Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
        CAPTURE(order, angle, about);
        check(order, Eigen::AngleAxisd(angle, about).toRotationMatrix());
      }
  }
}

TEST_CASE("a quarter turn of harmonics is orthogonal and sparse", "[math]") {
  const ShQuarterTurn& turn = sh_quarter_turn(12);
  for (int i = 0; i < 144; ++i) {
    double length = 0;
    for (int k = turn.first[i]; k < turn.first[i + 1]; ++k) length += turn.value[k] * turn.value[k];
    CHECK(length == Approx(1).epsilon(1e-13));
  }
  CHECK(turn.column.size() < 2300 / 3);  // of 2300 in full blocks
  CHECK_THROWS_AS(turned_sh(std::vector<Rgb>(7, Rgb::Zero()), Mat3::Identity()), Error);
  CHECK_THROWS_AS(turned_sh(std::vector<Rgb>(169, Rgb::Zero()), Mat3::Identity()), Error);
}

}  // namespace sh_rotation_test
