// GMRES without restart: the least residual in the Krylov space of a linear map that is only applied.
#pragma once
#include <Eigen/Core>
#include <functional>

namespace airlight::legendre_fluids {

struct GmresResult {
  Eigen::VectorXd x;
  int iterations;
  double residual;  // over the right side
};
// From x = 0. `most` vectors at most are kept.
GmresResult gmres(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& apply, const Eigen::VectorXd& right,
                  double tolerance, int most);

}  // namespace airlight::legendre_fluids
