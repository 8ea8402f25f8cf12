#include "scene/convert/fit_gauss_newton.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "scene/convert/fit_normal_matrix.h"

namespace airlight::scene {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int conjugate_gradients = 30;  // at most, a step
constexpr double forcing = 0.05;         // the step's residual over the gradient

// (M + damping diag(M)) x = b among the free variables: those that are held have rows and columns of 0 but for a 1.
class Step {
 public:
  Step(const NormalMatrix& matrix, const std::vector<char>& held, double damping)
      : matrix_(matrix), held_(held), damping_(damping), own_(matrix.size()) {
    for (std::size_t i = 0; i < matrix.size(); ++i) {
      Matrix5 m = matrix.diagonal(i);
      m.diagonal() *= 1 + damping;
      for (int v = 0; v < 5; ++v) {
        if (!held[5 * i + std::size_t(v)]) continue;
        m.row(v).setZero();
        m.col(v).setZero();
        m(v, v) = 1;
      }
      own_[i].compute(m);
    }
  }

  VectorXd solve(const VectorXd& b) const {
    VectorXd x = VectorXd::Zero(b.size()), r = b, z = precondition(r), p = z, q(b.size());
    double rz = r.dot(z);
    const double enough = forcing * forcing * rz;
    for (int k = 0; k < conjugate_gradients && rz > enough; ++k) {
      apply(p, q);
      const double step = rz / p.dot(q);
      if (!(step > 0 && std::isfinite(step))) break;
      x += step * p;
      r -= step * q;
      z = precondition(r);
      const double next = r.dot(z);
      p = z + next / rz * p;
      rz = next;
    }
    return x;
  }

 private:
  void apply(const VectorXd& x, VectorXd& y) const {
    matrix_.multiply(x, y);
    for (std::size_t i = 0; i < matrix_.size(); ++i)
      for (int v = 0; v < 5; ++v) {
        const Index at = Index(5 * i) + v;
        if (held_[std::size_t(at)])
          y[at] = 0;
        else
          y[at] += damping_ * matrix_.diagonal(i)(v, v) * x[at];
      }
  }
  VectorXd precondition(const VectorXd& r) const {
    VectorXd z(r.size());
    for (std::size_t i = 0; i < matrix_.size(); ++i)
      z.segment<5>(Index(5 * i)) = own_[i].solve(r.segment<5>(Index(5 * i)));
    return z;
  }

  const NormalMatrix& matrix_;
  const std::vector<char>& held_;
  double damping_;
  std::vector<Eigen::LLT<Matrix5>> own_;
};

// Half the gradient's opposite, among the free variables. Held are variables at a bound that the gradient pushes them against.
VectorXd right_side(const std::vector<Gaussian>& gaussians, const VectorXd& gradient, const FitBounds& bounds,
                    bool weights_only, std::vector<char>& held) {
  VectorXd b = -0.5 * gradient;
  for (std::size_t i = 0; i < gaussians.size(); ++i)
    for (int v = 0; v < 5; ++v) {
      const std::size_t at = 5 * i + std::size_t(v);
      const double x = variable(gaussians[i], v), slope = gradient[Index(at)];
      held[at] = (weights_only && v < 4) || (x <= bounds.lo(v) && slope > 0) || (x >= bounds.hi(v) && slope < 0);
      if (held[at]) b[Index(at)] = 0;
    }
  return b;
}

void take(const VectorXd& step, const FitBounds& bounds, const std::vector<Gaussian>& from, std::vector<Gaussian>& to) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    to[i] = from[i];
    for (int v = 0; v < 5; ++v) variable(to[i], v) += step[Index(5 * i) + v];
    clamp_to(bounds, to[i]);
  }
}

// By how much the quadratic model says that the objective falls on the way.
double foretold(const NormalMatrix& matrix, const VectorXd& gradient, const std::vector<Gaussian>& from,
                const std::vector<Gaussian>& to) {
  VectorXd taken(gradient.size()), product(gradient.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (int v = 0; v < 5; ++v) taken[Index(5 * i) + v] = variable(to[i], v) - variable(from[i], v);
  matrix.multiply(taken, product);
  return -gradient.dot(taken) - taken.dot(product);
}

}  // namespace

Minimization minimize_gauss_newton(FitObjective<float>& objective, const FitBounds& bounds,
                                   std::vector<Gaussian>& gaussians, const MinimizerOptions& options,
                                   bool weights_only) {
  const std::size_t n = gaussians.size();
  VectorXd gradient(Index(5 * n)), trial_gradient(Index(5 * n));
  Minimization result;
  result.value = objective.value(gaussians, gradient.data());
  if (n == 0) return result;
  std::vector<char> held(5 * n);
  double damping = 0.01, raise = 2;
  tbb::task_arena arena(objective.threads());
  std::vector<Gaussian> trial(n);
  for (; result.iterations < options.iterations; ++result.iterations) {
    if (options.check) options.check();
    const VectorXd b = right_side(gaussians, gradient, bounds, weights_only, held);
    const double before = result.value;
    arena.execute([&] {
      const NormalMatrix matrix(gaussians);
      // A step that does not lower the objective is tried shorter.
      for (int attempt = 0; attempt < 6; ++attempt) {
        take(Step(matrix, held, damping).solve(b), bounds, gaussians, trial);
        const double value = objective.value(trial, trial_gradient.data());
        if (value < result.value) {
          // Nielsen's rule judges the damping by what the quadratic model foretold.
          const double expected = foretold(matrix, gradient, gaussians, trial);
          const double quality = std::clamp((result.value - value) / std::max(expected, 1e-300), 0.0, 1.0);
          result.value = value;
          gaussians.swap(trial);
          gradient.swap(trial_gradient);
          damping = std::max(damping * std::max(1.0 / 3, 1 - std::pow(2 * quality - 1, 3)), 1e-6);
          raise = 2;
          return;
        }
        damping *= raise;
        raise *= 2;
      }
    });
    if (!(before - result.value > options.tolerance * before)) {
      result.converged = true;
      break;
    }
  }
  return result;
}

}  // namespace airlight::scene
