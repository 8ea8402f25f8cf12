// Legendre boxes that tests share.
#pragma once
#include <memory>

#include "scene/math/legendre.h"
#include "scene/math/random.h"
#include "scene/media/legendre_box.h"
#include "scene/media/medium.h"

namespace airlight::test {

// The formula of tests/vectors/references.json: F[i][j][k] = (((7i + 13j + 31k + seed) mod 11) - 5) / (10 (1 + i + j + k)), the first one
// given.
inline Eigen::VectorXd modular_series(int n, int seed, double first) {
  Eigen::VectorXd f(n * n * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        f[(i * n + j) * n + k] = ((7 * i + 13 * j + 31 * k + seed) % 11 - 5) / (10.0 * (1 + i + j + k));
  f[0] = first;
  return f;
}

inline const Box unit_box{Point3::Constant(-1), Point3::Constant(1)};

inline scene::LegendrePointer modular_box(int n, int seed, double first, const Box& box = unit_box) {
  return std::make_shared<const scene::LegendreBox>(box, scene::TensorShape{n, n, n}, modular_series(n, seed, first));
}

// Uniform in [0, 1)^3, the i-th of a sequence.
inline Point3 random_point(std::uint32_t i, std::uint32_t sequence = 0) {
  const RandomBlock a{philox4x32_10({i, 0, sequence, 0}, {0, 0})}, b{philox4x32_10({i, 1, sequence, 0}, {0, 0})};
  return {a.fine(0), a.fine(1), b.fine(0)};
}

}  // namespace airlight::test
