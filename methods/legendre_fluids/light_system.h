// Light along one direction as a linear system: (omega.grad + sigma r) E = q with E given where the light comes in, in n coefficients along
// each axis. Gupta and Narasimhan 2007, equations 22 and 23; the closures are ours, since the paper's equations lack the inflow.
//
//   upwind         tested with every function of the basis, plus the integral over inflow faces of |omega.n| (E - E_in): definite where the
//                  density is positive, so always solvable
//   least_squares  the coefficients of the equation and, times a weight, those of E - E_in on inflow faces
//
// Coordinates are those of [-1, 1]^3; a direction is its rate there, per metre of path. Axes along which it is 0 have no inflow.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "scene/math/dense.h"
#include "scene/math/legendre.h"
#include "scene/math/types.h"

namespace airlight::legendre_fluids {

enum class Closure { least_squares, upwind };
enum class LightTruncation { l2, chebyshev };

// Fields of the shape n times one density, cut off to n coefficients again: the matrix T M_R without the matrix, O(n^4).
class DensityProduct {
 public:
  // Chebyshev's T needs a density of at most n coefficients along an axis.
  DensityProduct(const Eigen::VectorXd& density, const scene::TensorShape& density_shape, const scene::TensorShape& n,
                 LightTruncation);
  const scene::TensorShape& shape() const { return n_; }
  Eigen::VectorXd operator()(const Eigen::VectorXd& field) const;

  // Matrices of the system along each axis: values of a field, and of the density, at the points;
  // coefficients from values there.
  struct Matrices {
    std::array<Eigen::MatrixXd, 3> values, of_density, analysis;
  };
  const Matrices& matrices() const { return matrices_; }
  const scene::TensorShape& points() const { return points_; }
  const Eigen::VectorXd& density() const { return density_; }  // there

 private:
  scene::TensorShape n_, points_;
  Matrices matrices_;
  Eigen::VectorXd density_;  // at the points
};

struct LightSolver {
  Closure closure = Closure::upwind;
  double weight = 3;         // of least_squares: of the inflow, for a box with half sizes 1
  bool dense = true;         // else GMRES, of upwind alone
  double tolerance = 1e-10;  // of GMRES: residual over right side
};

// Parts of a system along each axis, without the density.
struct LightAxes {
  LightAxes(const scene::TensorShape& n, const Vec3& rate, const LightSolver&);
  std::array<Eigen::MatrixXd, 3> along;  // of the derivative, of upwind with its inflow
  std::array<Eigen::VectorXd, 3> end;    // the basis at the inflow end; empty along an axis that has none
  Vec3 weight;                           // of the square of what is missing on an inflow face
};

class LightSystem {
 public:
  static constexpr int most_dense = 1728;  // unknowns

  // The product outlives this. Throws Error for a dense system that is too large, and for least_squares that is not dense.
  LightSystem(const DensityProduct&, const Vec3& rate, double sigma, const LightSolver&);

  // Coefficients of E where `inflow` comes in everywhere; adds to the iterations of GMRES. Throws Error where that does not converge.
  Eigen::VectorXd solve(const Eigen::VectorXd& q, double inflow, int* iterations = nullptr) const;
  Eigen::VectorXd apply(const Eigen::VectorXd& e) const;  // the left side, of upwind with its inflow

 private:
  Eigen::VectorXd inflow_side(double inflow) const;

  const DensityProduct& product_;
  Vec3 rate_;
  double sigma_;
  LightSolver solver_;
  LightAxes axes_;
  // Where it is dense: the factors of upwind; the equation and the factors of the normal equations of least_squares.
  std::optional<scene::SquareFactors> factors_;
  Eigen::MatrixXd equation_;
  std::optional<scene::DefiniteFactors> normal_;
};

}  // namespace airlight::legendre_fluids
