// Gaussians along the rays of a row against their sum, point by point.
#include "methods/compensated_ray_marching/gaussian_row.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

namespace gaussian_row_test {

using namespace airlight;
using namespace airlight::compensated_ray_marching;

TEST_CASE("Gaussians along a row of rays are their density", "[compensated_ray_marching]") {
  const scene::GaussianSum sum{
      {{{0, 0, 0}, 0.4, 1}, {{0.5, 0.2, -0.1}, 0.25, 0.7}, {{-0.3, 0.4, 0.2}, 0.3, 0.9}}, 0, 3};
  const Ray ray{{-2, 0.15, 0.05}, Vec3(1, 0.02, 0.01).normalized()};
  const Vec3 normal = ray.direction.cross(Vec3(0, 0, 1)).normalized();
  const std::vector<Rgb> values{Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1)};
  const GaussianRow row(sum, &values, ray.origin, normal);
  const RaySlices slices{0.1, 0.011, 380};
  std::vector<double> density(380, 0.0);
  std::vector<Rgb> weighted(380, Rgb::Zero());
  row.add(ray, slices, density.data(), weighted.data());
  for (int k = 0; k < slices.count; ++k) {
    const double expected = scene::density(sum, ray.at(slices.middle(k)));
    REQUIRE(std::abs(density[std::size_t(k)] - expected) < 1e-12);
    REQUIRE(std::abs(weighted[std::size_t(k)].sum() - expected) < 1e-12);
  }
}

}  // namespace gaussian_row_test
