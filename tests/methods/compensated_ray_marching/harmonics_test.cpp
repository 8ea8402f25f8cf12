// Exponentials of depths in spherical harmonics: what each approximation is worth, and tables of families against the oracle's.
// `airlight verify` compares the functions themselves with the oracle.
#include <catch2/catch.hpp>

#include "methods/compensated_ray_marching/gaussian_depth.h"
#include "methods/compensated_ray_marching/harmonic_exponential.h"
#include "methods/compensated_ray_marching/ordinate_directions.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"
#include "tests/oracle_vectors.h"

namespace harmonics_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::compensated_ray_marching;

namespace {

double distance(const Harmonics& a, const Harmonics& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / (4 * pi));  // RMS over the sphere
}

}  // namespace

TEST_CASE("harmonics of the publication: angles of distances, and back", "[compensated_ray_marching]") {
  for (const json& v : vectors_of("compensated_ray_marching", "theta_of_d")) {
    const double d = number(v.at("input").at("d"));
    CHECK(distance_of_angle(angle_of_distance(d)) == Approx(d).epsilon(1e-14).margin(1e-15));
  }
}

TEST_CASE("depth tables: the errors that the spacings are known to have", "[compensated_ray_marching]") {
  for (const auto& [spacing, samples, bound] :
       {std::tuple(DepthTable::Spacing::paper, 256, 1.7e-4), std::tuple(DepthTable::Spacing::paper, 1024, 1.1e-5),
        std::tuple(DepthTable::Spacing::even, 256, 9e-5)}) {
    const DepthTable table(4, spacing, samples);
    double worst = 0, far = 0;
    for (int i = 0; i < 4000; ++i) {
      const double d = std::pow(10, -3 + 5 * (i + 0.5) / 4000);
      const std::vector<double> exact = zonal_depth(4, d);
      std::array<double, 4> got;
      table.zonal(d, got.data());
      for (std::size_t l = 0; l < 4; ++l) worst = std::max(worst, std::abs(got[l] - exact[l]));
      if (d > 30) far = std::max(far, std::abs(got[0] / exact[0] - 1));
    }
    CAPTURE(samples, worst, far);
    CHECK(worst < bound);
    if (spacing == DepthTable::Spacing::even) CHECK(far < 1e-3);
  }
  // At the centre, infinitely far away, and where the map turns, to either side.
  const DepthTable table(4, DepthTable::Spacing::paper);
  for (const double d :
       {0.0, std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.0, 2.0), 3.0, std::nextafter(3.0, 4.0), 1e300}) {
    std::array<double, 4> depth;
    table.zonal(d, depth.data());
    for (const double value : depth) CHECK(std::isfinite(value));
  }
}

TEST_CASE("exponentials of depths", "[compensated_ray_marching]") {
  const LinearExponential linear(depth_family(4, {1, 2, 4, 16, 64}, 40));
  for (const json& v : vectors_of("compensated_ray_marching", "sh_exponential")) {
    const Harmonics depth = numbers(v.at("expected").at("minus_depth_vector")), exact = exact_exponential(depth);
    CAPTURE(v.at("id").get<std::string>());
    const double once = distance(linear(depth), exact),
                 often = distance(squared_exponential(depth, linear, 0.1), exact);
    CAPTURE(once, often);
    CHECK(once < 0.15);
    CHECK(often <= once + 1e-12);
    CHECK(often < 0.02);
    CHECK(distance(series_exponential(depth), exact) < 0.02);
  }
}

TEST_CASE("linear exponentials of families", "[compensated_ray_marching]") {
  for (const json& v : vectors_of("compensated_ray_marching", "ol_table")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    const std::vector<double> sizes = numbers(in.at("s"));
    CAPTURE(v.at("id").get<std::string>());
    if (in.contains("unit_vectors")) {
      std::vector<Harmonics> family;
      for (const json& h : in.at("unit_vectors")) family.push_back(numbers(h));
      const LinearExponential linear(family, 8, 160);
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        CHECK(linear.constant(sizes[i]) == Approx(number(expected.at("a")[i])).epsilon(1e-8));
        CHECK(linear.slope(sizes[i]) == Approx(number(expected.at("b")[i])).epsilon(1e-8));
      }
    } else if (in.contains("counts")) {
      // By own samples: within four standard errors, of which this has sqrt(50000 / 100) times the oracle's.
      const LinearExponential linear(depth_family(4, {1, 2, 4, 16, 64}, 100), 8, 160);
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        CHECK(std::abs(linear.constant(sizes[i]) - number(expected.at("a")[i])) <
              4 * 22.4 * number(v.at("stderr").at("a")[i]));
        CHECK(std::abs(linear.slope(sizes[i]) - number(expected.at("b")[i])) <
              4 * 22.4 * number(v.at("stderr").at("b")[i]));
      }
    } else {
      // One Gaussian: the axis does not matter, distances by quadrature in their logarithm on either side of the cut.
      const scene::GaussLegendre rule = scene::gauss_legendre(24);
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        double a = 0, b = 0;
        for (const auto& [lo, hi] : {std::pair(std::log(0.3), std::log(3.0)), std::pair(std::log(3.0), std::log(10.0))})
          for (std::size_t k = 0; k < rule.node.size(); ++k) {
            Harmonics h =
                about_axis(zonal_depth(4, std::exp(lo + 0.5 * (hi - lo) * (1 + rule.node[k]))), Vec3(0, 0, 1));
            h[0] = 0;
            const double size = distance(h, Harmonics(16, 0.0)) * std::sqrt(4 * pi);
            for (double& value : h) value /= size;
            const LinearExponential one({h}, sizes[i], 1);
            const double share = 0.5 * rule.weight[k] * (hi - lo) / std::log(10 / 0.3);
            a += share * one.constant(sizes[i]);
            b += share * one.slope(sizes[i]);
          }
        CHECK(a == Approx(number(expected.at("a")[i])).epsilon(1e-6));
        CHECK(b == Approx(number(expected.at("b")[i])).epsilon(1e-6));
      }
    }
  }
}

TEST_CASE("exponentials of depths of a thousand are finite", "[compensated_ray_marching]") {
  const LinearExponential linear(depth_family(4, {1, 2, 4, 16, 64}, 8));
  const Harmonics one = about_axis(zonal_depth(4, 0.7), Vec3(0, 0.6, 0.8));
  for (const double scale : {1e-6, 1.0, 600.0, 1e5}) {
    Harmonics depth = one;
    for (double& value : depth) value *= -scale;
    for (const Harmonics& e : {linear(depth), squared_exponential(depth, linear), series_exponential(depth)})
      for (const double value : e) CHECK(std::isfinite(value));
  }
}

// Against a rule of twice as many levels.
TEST_CASE("tables of the linear exponential are exact up to their longest size", "[compensated_ray_marching]") {
  const std::vector<Harmonics> family = depth_family(4, {1, 2, 4, 16, 64}, 4);
  const LinearExponential linear(family, 40, 8);
  const std::vector<Ordinate> directions = ordinate_directions(80, 160, false);
  for (const double size : {5., 10., 15., 20., 30., 40.}) {
    double constant = 0, slope = 0;
    for (const Ordinate& d : directions) {
      const std::vector<double> harmonics = scene::evaluate_sh(4, d.direction);
      for (const Harmonics& h : family) {
        double value = 0;
        for (std::size_t k = 0; k < h.size(); ++k) value += h[k] * harmonics[k];
        constant += d.weight * std::exp(-size * value) / (4 * pi * double(family.size()));
        slope -= d.weight * std::exp(-size * value) * value / (size * double(family.size()));
      }
    }
    CAPTURE(size);
    CHECK(linear.constant(size) == Approx(constant).epsilon(1e-8));
    CHECK(linear.slope(size) == Approx(slope).epsilon(1e-8));
  }
}

}  // namespace harmonics_test
