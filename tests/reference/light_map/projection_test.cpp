// A map's texels and the points that they stand for.
#include "reference/light_map/projection.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace projection_test {

using namespace airlight;
using namespace airlight::light_map;

namespace {

const Box box{Point3(-1, 0, -0.5), Point3(0.5, 3, 0.7)};

scene::Light spot(const Point3& at, const Vec3& axis, double angle) {
  scene::SpotLight light;
  light.position = at;
  light.axis = axis.normalized();
  light.outer_angle = angle;
  return light;
}

std::vector<scene::Light> lights() {
  return {scene::DirectionalLight{Vec3(2, 2, 1).normalized(), Rgb::Ones()},
          scene::DirectionalLight{Vec3::UnitY(), Rgb::Ones()},
          scene::DirectionalLight{-Vec3::UnitZ(), Rgb::Ones()},
          scene::PointLight{Point3(-0.2, 1, 0.1), Rgb::Ones(), 0},  // inside the box
          scene::PointLight{Point3(4, 5, 3), Rgb::Ones(), 0},       // outside
          scene::PointLight{Point3(0.51, 1, 0.1), Rgb::Ones(), 0},  // so near a face that it sees half a sphere
          spot(Point3(-0.2, 2, 0.1), Vec3(0, -1, 0.3), 0.4),
          spot(Point3(4, 5, 3), Vec3(-4, -4, -3), 0.1)};
}

Point3 random_point(std::mt19937& random, const Box& in) {
  std::uniform_real_distribution<double> uniform(0, 1);
  return in.lo + Vec3(uniform(random), uniform(random), uniform(random)).cwiseProduct(in.size());
}

}  // namespace

TEST_CASE("light map: the ray of a texel meets points that lie on its centre", "[light_map]") {
  for (const scene::Light& light : lights()) {
    const Projection p = fit(light, box, 16);
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 16; ++i) {
        const Ray ray = texel_ray(p, i, j);
        CHECK(ray.direction.norm() == Approx(1));
        for (const double share : {0.1, 0.5, 1.0}) {
          const Place at = place(p, ray.at(p.depth.lo + share * p.depth.length()));
          CHECK(at.x == Approx(i + 0.5));
          CHECK(at.y == Approx(j + 0.5));
          CHECK(at.depth == Approx(share));
        }
      }
  }
}

TEST_CASE("light map: a map covers the box, and begins and ends with it", "[light_map]") {
  std::mt19937 random(1);
  for (const scene::Light& light : lights()) {
    if (std::holds_alternative<scene::SpotLight>(light)) continue;
    const Projection p = fit(light, box, 64);
    double least_x = 64, greatest_x = 0, least = 1, greatest = 0;
    for (int i = 0; i < 20000; ++i) {
      const Place at = place(p, random_point(random, box));
      const Point3 x = random_point(random, box);
      least_x = std::min(least_x, at.x), greatest_x = std::max(greatest_x, at.x);
      least = std::min(least, at.depth), greatest = std::max(greatest, at.depth);
      CHECK((place(p, x).depth > 0));  // 0: beside the map, or before it
    }
    CAPTURE(light_name(light), least_x, greatest_x);
    CHECK(least < 0.1);
    CHECK(greatest > 0.85);
    // An octahedron's square has corners that a cap leaves empty; the box of a cone is not the cone.
    CHECK(greatest_x - least_x > (std::holds_alternative<scene::DirectionalLight>(light) ? 60 : 24));
  }
}

// A box seen along an axis takes the whole rectangle; with a slanted sun no rectangle along an edge is smaller.
TEST_CASE("light map: parallel light has the least rectangle along an edge", "[light_map]") {
  const Projection p = fit(scene::DirectionalLight{Vec3::UnitY(), Rgb::Ones()}, box, 8);
  CHECK(p.across[0].length() * p.across[1].length() == Approx(1.5 * 1.2));
  CHECK(p.depth.length() == Approx(3));
}

// Spots light no more than their cone: the map's square is as small.
TEST_CASE("light map: the map of a spot is its cone", "[light_map]") {
  const Projection p = fit(spot(Point3(-0.2, 2, 0.1), Vec3(0, -1, 0), 0.4), box, 64);
  CHECK(p.reach == Approx(std::tan(0.4) / (1 + std::tan(0.4))));
  CHECK(place(p, Point3(-0.2, 1, 0.1)).depth > 0);
  CHECK(place(p, Point3(-0.2, 2.5, 0.1)).depth == 0);  // behind
}

TEST_CASE("light map: beside and before the box nothing is between a point and the light", "[light_map]") {
  const Projection sun = fit(scene::DirectionalLight{Vec3::UnitY(), Rgb::Ones()}, box, 8);
  CHECK(place(sun, Point3(0, 4, 0)).depth == 0);
  CHECK(place(sun, Point3(2, 1, 0)).depth == 0);
  CHECK(place(sun, Point3(0, -7, 0)).depth == 1);
  const Projection lamp = fit(scene::PointLight{Point3(4, 5, 3), Rgb::Ones(), 0}, box, 8);
  CHECK(place(lamp, Point3(4, 5, 3)).depth == 0);
  CHECK(place(lamp, Point3(3.9, 4.9, 2.9)).depth == 0);
  CHECK(place(lamp, Point3(8, 9, 6)).depth == 0);
}

}  // namespace projection_test
