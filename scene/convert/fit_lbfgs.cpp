#include "scene/convert/fit_lbfgs.h"

#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <exception>

#include "scene/base/error.h"
#include "scene/convert/fit_normal_matrix.h"

namespace airlight::scene {
namespace {

constexpr double edge = 1e-3;  // of a range: where a variable at its bound starts, since the sigmoid never reaches it

double sigmoid(double q) { return 1 / (1 + std::exp(-q)); }

class Function : public ceres::FirstOrderFunction {
 public:
  Function(FitObjective<float>& objective, const FitBounds& bounds, const std::vector<Gaussian>& start)
      : objective_(objective), bounds_(bounds), now_(start), from_(start.size()), best_(start) {
    scale_ = objective.sum_of_squares() > 0 ? 1 / objective.sum_of_squares() : 1;
    units_.reserve(start.size());
    for (std::size_t i = 0; i < start.size(); ++i) {
      Vector5 slope;
      for (int v = 0; v < 5; ++v) {
        const double range = bounds.hi(v) - bounds.lo(v);
        const double s = std::clamp(range > 0 ? (variable(start[i], v) - bounds.lo(v)) / range : 0.5, edge, 1 - edge);
        from_[i][v] = std::log(s / (1 - s));
        slope[v] = range * std::max(s * (1 - s), 0.01);
      }
      const Matrix5 m = 2 * scale_ * slope.asDiagonal() * overlap_derivatives(start[i], start[i]) * slope.asDiagonal();
      const Matrix5 l = m.llt().matrixL();
      units_.push_back(l.transpose().inverse());
    }
    gradient_.resize(5 * start.size());
    best_value_ = objective.value(start) * scale_;
  }

  bool Evaluate(const double* u, double* cost, double* gradient) const override {
    for (std::size_t i = 0; i < now_.size(); ++i) {
      const Vector5 q = from_[i] + units_[i] * Eigen::Map<const Vector5>(u + 5 * i);
      for (int v = 0; v < 5; ++v)
        variable(now_[i], v) = bounds_.lo(v) + (bounds_.hi(v) - bounds_.lo(v)) * sigmoid(q[v]);
    }
    *cost = scale_ * objective_.value(now_, gradient ? gradient_.data() : nullptr);
    if (!std::isfinite(*cost)) return false;
    if (*cost < best_value_) {
      best_value_ = *cost;
      best_ = now_;
    }
    if (!gradient) return true;
    for (std::size_t i = 0; i < now_.size(); ++i) {
      Vector5 g;
      for (int v = 0; v < 5; ++v) {
        const double range = bounds_.hi(v) - bounds_.lo(v);
        const double s = range > 0 ? (variable(now_[i], v) - bounds_.lo(v)) / range : 0;
        g[v] = scale_ * gradient_[5 * i + std::size_t(v)] * range * s * (1 - s);
      }
      Eigen::Map<Vector5>(gradient + 5 * i) = units_[i].transpose() * g;
    }
    return true;
  }
  int NumParameters() const override { return int(5 * now_.size()); }

  const std::vector<Gaussian>& best() const { return best_; }
  double best_value() const { return best_value_ / scale_; }

 private:
  FitObjective<float>& objective_;
  const FitBounds& bounds_;
  double scale_;
  mutable std::vector<Gaussian> now_;
  std::vector<Vector5> from_;
  std::vector<Matrix5> units_;
  mutable std::vector<Gaussian> best_;
  mutable double best_value_;
  mutable std::vector<double> gradient_;
};

// Ceres is no place for exceptions: one that `check` throws ends it as a refusal, and goes on after it.
class Checked : public ceres::IterationCallback {
 public:
  explicit Checked(const std::function<void()>& check) : check_(check) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    try {
      if (check_) check_();
    } catch (...) {
      thrown = std::current_exception();
      return ceres::SOLVER_ABORT;
    }
    return ceres::SOLVER_CONTINUE;
  }
  std::exception_ptr thrown;

 private:
  const std::function<void()>& check_;
};

}  // namespace

Minimization minimize_lbfgs(FitObjective<float>& objective, const FitBounds& bounds, std::vector<Gaussian>& gaussians,
                            const MinimizerOptions& options) {
  Minimization result;
  if (gaussians.empty() || options.iterations == 0) {
    result.value = objective.value(gaussians);
    return result;
  }
  auto* const function = new Function(objective, bounds, gaussians);  // the problem's
  ceres::GradientProblem problem(function);
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = ceres::LBFGS;
  solver.max_lbfgs_rank = 20;
  solver.max_num_iterations = options.iterations;
  solver.function_tolerance = options.tolerance;
  solver.gradient_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  Checked checked(options.check);
  solver.callbacks.push_back(&checked);
  std::vector<double> u(5 * gaussians.size(), 0.0);
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(solver, problem, u.data(), &summary);
  if (checked.thrown) std::rethrow_exception(checked.thrown);
  // A line search that finds no lower point (FAILURE) is an end like another, where there is any step at all.
  if (summary.termination_type == ceres::FAILURE && !std::isfinite(function->best_value()))
    throw Error("the fit's objective is not finite");
  gaussians = function->best();
  result.value = function->best_value();
  result.iterations = int(summary.iterations.size()) - 1;
  result.converged = summary.termination_type != ceres::NO_CONVERGENCE;
  return result;
}

}  // namespace airlight::scene
