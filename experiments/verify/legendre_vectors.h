// Arrays of coefficients in vectors.
#pragma once
#include <Eigen/Core>

#include "experiments/verify/check.h"
#include "scene/math/legendre.h"

namespace airlight::experiments::verification {

// Nested lists of up to three dimensions, flat with index order [x][y][z]; axes that are absent have length 1.
struct Tensor {
  Eigen::VectorXd values;
  scene::TensorShape shape = {1, 1, 1};
};
Tensor tensor_from(const Value&);  // complains where rows differ in length

// One comparison: the entry that differs most, judged by `tolerance` times the largest entry expected.
// Throws Error if there are not as many of both.
std::vector<Comparison> largest_differences(const std::string& name, const Eigen::VectorXd& expected,
                                            const Eigen::VectorXd& got, double tolerance);

}  // namespace airlight::experiments::verification
