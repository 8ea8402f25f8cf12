// Values of Legendre series at points, on vectors.
#include "methods/legendre_fluids/point_values.h"

#include <hwy/highway.h>

#include <catch2/catch.hpp>
#include <random>

namespace point_values_test {

using namespace airlight;
using namespace airlight::legendre_fluids;

namespace {

struct Series {
  scene::TensorShape shape;
  Eigen::VectorXd coefficients;
  std::vector<Vec3> points;
};

// Every count of rows that is left over, points at corners and walls among them.
std::vector<Series> series() {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Series> all;
  for (const scene::TensorShape& shape :
       {scene::TensorShape{1, 1, 1}, {6, 6, 6}, {17, 6, 6}, {6, 17, 6}, {2, 3, 4}, {3, 7, 1}, {1, 9, 2}, {32, 5, 32}}) {
    Series s{shape, Eigen::VectorXd(scene::tensor_size(shape)), {}};
    for (double& c : s.coefficients) c = uniform(random);
    for (int i = 0; i < 21; ++i) s.points.emplace_back(uniform(random), i % 4 == 0 ? 1 : uniform(random), i % 5 - 2);
    for (Vec3& x : s.points) x = x.cwiseMax(-1).cwiseMin(1);
    all.push_back(s);
  }
  return all;
}

std::vector<Eigen::VectorXd> values_of_all() {
  std::vector<Eigen::VectorXd> all;
  for (const Series& s : series()) all.push_back(series_values(s.shape, s.coefficients.data(), s.points));
  return all;
}

}  // namespace

// A sum of that many products of |L| <= sqrt(k + 1/2), each rounded to 53 bits, the functions by a recurrence of as many steps.
TEST_CASE("legendre light: series at eight points are those at each", "[legendre_fluids][light]") {
  for (const Series& s : series()) {
    const Eigen::VectorXd got = series_values(s.shape, s.coefficients.data(), s.points);
    double most = 1;
    for (const int n : s.shape) most *= std::sqrt(n) * n;
    for (std::size_t i = 0; i < s.points.size(); ++i) {
      CAPTURE(s.shape[0], s.shape[1], s.shape[2], i);
      CHECK(got[Eigen::Index(i)] ==
            Approx(series_value(s.shape, s.coefficients.data(), s.points[i])).margin(2e-16 * most).epsilon(0));
    }
  }
}

TEST_CASE("legendre light: series have the same bits by AVX2 and by what this machine has",
          "[legendre_fluids][light]") {
  const std::vector<Eigen::VectorXd> widest = values_of_all();
  hwy::SetSupportedTargetsForTest(HWY_AVX2);
  hwy::GetChosenTarget().DeInit();
  const std::vector<Eigen::VectorXd> narrow = values_of_all();
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  for (std::size_t i = 0; i < widest.size(); ++i) CHECK((widest[i].array() == narrow[i].array()).all());
}

}  // namespace point_values_test
