// Sun et al.'s form of light scattered onto surfaces against quadrature over directions.
#include "methods/fogshop/sun_reflection.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/surface_psf.h"
#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"
#include "tests/methods/fogshop/exact_reflection.h"

namespace sun_reflection_test {

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::exact_reflection;

namespace {

const Vec3 normal(0, 1, 0);

// Greatest error over depths and light directions, relative to the greatest light of the depth.
double worst_error(const scene::Material& material, double view_angle) {
  const SunReflection sun({{"", scene::Plane{}, material}});
  const Vec3 to_view(-std::sin(view_angle), std::cos(view_angle), 0);
  double worst = 0;
  for (const double T : {0.004, 0.1, 1.0, 5.0, 21.0}) {
    double error = 0, greatest = 0;
    for (const double angle : {0.0, 0.4, 0.9, 1.3, 1.55, 1.7, 2.2, 3.0})
      for (const double turn : {0.0, 1.1, pi}) {
        const Vec3 to_light(std::sin(angle) * std::cos(turn), std::cos(angle), std::sin(angle) * std::sin(turn));
        const double exact = exact_reflection(material, normal, to_view, to_light, T)[0];
        error = std::max(error, std::abs(sun.reflect(material, normal, to_view, to_light, T)[0] - exact));
        greatest = std::max(greatest, exact);
      }
    worst = std::max(worst, error / greatest);
  }
  return worst;
}

}  // namespace

TEST_CASE("Sun et al.'s form on a Lambert surface is the exact integral", "[fogshop]") {
  const double worst = worst_error(scene::Lambert{Rgb::Constant(0.7)}, 0.3);
  CAPTURE(worst);
  CHECK(worst < 1e-3);
}

// Exact but for the part of the lobe that dips below the horizon: small for sharp lobes seen from above.
TEST_CASE("Sun et al.'s form on a Phong surface", "[fogshop]") {
  const double sharp = worst_error(scene::Phong{Rgb::Zero(), Rgb::Constant(0.8), 50}, 0.5);
  const double broad = worst_error(scene::Phong{Rgb::Constant(0.3), Rgb::Constant(0.5), 5}, 0.3);
  const double grazing = worst_error(scene::Phong{Rgb::Constant(0.3), Rgb::Constant(0.5), 5}, 1.2);
  CAPTURE(sharp, broad, grazing);
  CHECK(sharp < 1e-3);
  CHECK(broad < 2e-3);
  CHECK(grazing > broad);  // the stated limit is there
  CHECK(grazing < 0.1);
}

TEST_CASE("Sun et al.'s form: exponent 0 is Lambert", "[fogshop]") {
  const Vec3 to_view = Vec3(0.2, 1, 0.1).normalized(), to_light = Vec3(0.5, 0.6, -0.2).normalized();
  const scene::Material flat = scene::Phong{Rgb::Constant(0.25), Rgb::Constant(0.5), 0};
  const scene::Material lambert = scene::Lambert{Rgb::Constant(0.75)};
  const SunReflection sun({{"", scene::Plane{}, flat}, {"", scene::Plane{}, lambert}});
  CHECK(sun.reflect(flat, normal, to_view, to_light, 0.8)[0] ==
        Approx(sun.reflect(lambert, normal, to_view, to_light, 0.8)[0]).epsilon(1e-12));
  CHECK((sun.reflect(lambert, normal, -to_view, to_light, 0.8) == 0).all());
}

}  // namespace sun_reflection_test
