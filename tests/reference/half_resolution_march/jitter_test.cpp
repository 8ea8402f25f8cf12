// Offsets of steps: the ordered matrix, and noise.
#include "reference/half_resolution_march/jitter.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace half_jitter_test {

using namespace airlight::half_resolution_march;

namespace {

// Greatest distance between the share of values below x and x, over x in [0, 1].
double discrepancy(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double n = double(values.size());
  double most = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    most = std::max({most, std::abs(values[i] - double(i) / n), std::abs(values[i] - double(i + 1) / n)});
  return most;
}

}  // namespace

TEST_CASE("half-resolution march: Bayer's matrix by its recursion", "[half_resolution_march]") {
  // M(2n) = 4 M(n) + {0, 2; 3, 1} by quadrant.
  const int quadrant[2][2] = {{0, 2}, {3, 1}};
  std::vector<std::vector<int>> matrix = {{0}};
  for (int n = 1; n < 8; n *= 2) {
    std::vector<std::vector<int>> next(2 * n, std::vector<int>(2 * n));
    for (int y = 0; y < 2 * n; ++y)
      for (int x = 0; x < 2 * n; ++x) next[y][x] = 4 * matrix[y % n][x % n] + quadrant[y / n][x / n];
    matrix = next;
  }
  CHECK(matrix[0] == std::vector<int>{0, 32, 8, 40, 2, 34, 10, 42});  // as printed everywhere
  std::vector<int> all;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      CHECK(bayer(x, y) == matrix[y][x]);
      CHECK(bayer(x + 8, y + 16) == matrix[y][x]);
      all.push_back(bayer(x, y));
    }
  std::sort(all.begin(), all.end());
  for (int i = 0; i < 64; ++i) CHECK(all[i] == i);
}

// Requirement of dithering: neighbours share the range equally, for any position of the window.
TEST_CASE("half-resolution march: any 2 x 2 and 4 x 4 offsets of Bayer's matrix are equally spread",
          "[half_resolution_march]") {
  for (const int side : {2, 4, 8})
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        std::vector<int> count(side * side, 0);
        for (int j = 0; j < side; ++j)
          for (int i = 0; i < side; ++i)
            ++count[std::size_t(step_offset(Jitter::bayer, x + i, y + j, 0) * side * side)];
        CHECK(std::all_of(count.begin(), count.end(), [](int n) { return n == 1; }));
      }
}

// 9 values equally spaced have a discrepancy of 0.06 or more, random ones 0.29 in the mean.
TEST_CASE("half-resolution march: any 3 x 3 offsets of noise are well spread, and all of them are even",
          "[half_resolution_march]") {
  double sum = 0;
  std::vector<double> all;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      std::vector<double> near;
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) near.push_back(step_offset(Jitter::noise, x + i, y + j, 0));
      sum += discrepancy(near);
      all.push_back(near[0]);
    }
  CHECK(sum / 1e4 < 0.2);
  CHECK(discrepancy(all) < 0.01);  // 0.0087 are expected of as many random values
}

TEST_CASE("half-resolution march: offsets of frames fill a step, whatever their number", "[half_resolution_march]") {
  CHECK(step_offset(Jitter::none, 3, 5, 7) == 0.5);
  for (const Jitter jitter : {Jitter::bayer, Jitter::noise})
    for (const int frames : {1, 2, 5, 16, 100, 1000}) {
      std::vector<double> values;
      for (int f = 0; f < frames; ++f) values.push_back(step_offset(jitter, 3, 5, f));
      CHECK(*std::min_element(values.begin(), values.end()) > 0);
      CHECK(*std::max_element(values.begin(), values.end()) < 1);
      // Bound of the golden ratio's sequence: N D < 1.25 + 1.04 log N (Niederreiter 1992, theorem 3.3 and its corollary, rounded up).
      if (frames > 1) CHECK(discrepancy(values) * frames < 1.25 + 1.04 * std::log(frames) + 1);
    }
}

}  // namespace half_jitter_test
