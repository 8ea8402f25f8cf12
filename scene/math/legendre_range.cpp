#include "scene/math/legendre_range.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "scene/math/dense.h"

namespace airlight::scene {
namespace {

constexpr int hull_size = 8;  // degrees up to 7: the Bernstein coefficients of P_7 reach 35, those of P_31 3e8

// Column k: Bernstein coefficients of degree n - 1 of L_k, from those of P_k, (-1)^(k+i) C(k, i) of degree k, raised.
Eigen::MatrixXd to_bernstein(int n) {
  Eigen::MatrixXd matrix(n, n);
  for (int k = 0; k < n; ++k) {
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    double binomial = 1;
    for (int i = 0; i <= k; ++i) {
      b[i] = ((k + i) % 2 == 0 ? 1 : -1) * binomial;
      binomial *= double(k - i) / (i + 1);
    }
    for (int degree = k; degree < n - 1; ++degree) {
      for (int i = degree + 1; i > 0; --i) b[i] = (i * b[i - 1] + (degree + 1 - i) * b[i]) / (degree + 1);
    }
    matrix.col(k) = std::sqrt(k + 0.5) * b;
  }
  return matrix;
}

const Eigen::MatrixXd& bernstein_matrix(int n) {
  static const std::array<Eigen::MatrixXd, hull_size + 1> all = [] {
    std::array<Eigen::MatrixXd, hull_size + 1> matrices;
    for (int n = 1; n <= hull_size; ++n) matrices[std::size_t(n)] = to_bernstein(n);
    return matrices;
  }();
  return all[std::size_t(n)];
}

// The greatest of |L_k|, at the ends; 1 for an absent axis.
double greatest_of(int k, bool present) { return present ? std::sqrt(k + 0.5) : 1; }

template <class Visit>
void for_each(const Eigen::VectorXd& f, const TensorShape& shape, int dimensions, Visit&& visit) {
  Eigen::Index at = 0;
  for (int i = 0; i < shape[0]; ++i)
    for (int j = 0; j < shape[1]; ++j) {
      const double across = greatest_of(i, dimensions > 0) * greatest_of(j, dimensions > 1);
      for (int k = 0; k < shape[2]; ++k) visit(std::max({i, j, k}), f[at++], across * greatest_of(k, dimensions > 2));
    }
}

// A part of [-1, 1]^3, as a series of its own; `size` are its sides as shares of the whole.
struct Part {
  Eigen::VectorXd series;
  Vec3 size = Vec3::Ones();
  Interval range;
  bool operator<(const Part& other) const { return range.hi < other.range.hi; }
};

// Searches for the greatest value by halving the part that may hold it.
class Search {
 public:
  Search(const Eigen::VectorXd& series, const TensorShape& shape) : shape_(shape) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      halves_[axis] = {legendre_restriction(shape[axis], -1, 0), legendre_restriction(shape[axis], 0, 1)};
      looked_at_[axis] = legendre_values(shape[axis], Eigen::Vector3d(-1, 0, 1));
    }
    add({series, Vec3::Ones(), {}});
  }

  GreatestValue result() const { return {found_, parts_.top().range.hi}; }
  void halve() {
    const Part part = parts_.top();
    parts_.pop();
    std::size_t axis = 0;
    const auto variation = [&](std::size_t a) { return part.size[Eigen::Index(a)] * (shape_[a] - 1); };
    for (const std::size_t a : {1u, 2u})
      if (variation(a) > variation(axis)) axis = a;
    Vec3 size = part.size;
    size[Eigen::Index(axis)] /= 2;
    for (const Eigen::MatrixXd& half : halves_[axis]) add({along_axis(int(axis), half, part.series, shape_), size, {}});
  }

 private:
  void add(Part part) {
    part.range = legendre_range(part.series, shape_);
    found_ = std::max(found_, along_axes(looked_at_[0], looked_at_[1], looked_at_[2], part.series, shape_).maxCoeff());
    parts_.push(std::move(part));
  }

  TensorShape shape_;
  std::array<std::array<Eigen::MatrixXd, 2>, 3> halves_;
  std::array<Eigen::MatrixXd, 3> looked_at_;  // ends and middle
  double found_ = -infinity;
  std::priority_queue<Part> parts_;
};

constexpr int most_halvings = 400;

}  // namespace

Eigen::MatrixXd legendre_restriction(int n, double lo, double hi) {
  const LegendrePoints& points = legendre_points(n);
  const Eigen::VectorXd there = (0.5 * (lo + hi) + 0.5 * (hi - lo) * points.node.array()).matrix();
  Eigen::MatrixXd restriction = product(points.analysis, legendre_values(n, there));
  restriction.triangularView<Eigen::StrictlyLower>().setZero();  // what it is but for rounding
  return restriction;
}

Interval legendre_range(const Eigen::VectorXd& f, const TensorShape& shape, int dimensions) {
  std::array<Eigen::MatrixXd, 3> matrix;
  TensorShape low = shape;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(shape[axis], hull_size);
    matrix[axis] = int(axis) < dimensions ? bernstein_matrix(low[axis]) : Eigen::MatrixXd::Ones(1, 1);
  }
  Eigen::VectorXd first(tensor_size(low));
  Eigen::Index count = 0;
  double rest = 0;
  for_each(f, shape, dimensions, [&](int degree, double c, double greatest) {
    if (degree < hull_size)
      first[count++] = c;
    else
      rest += std::abs(c) * greatest;
  });
  const Eigen::VectorXd hull = along_axes(matrix[0], matrix[1], matrix[2], first, low);
  return {hull.minCoeff() - rest, hull.maxCoeff() + rest};
}

Interval legendre_range(const Eigen::VectorXd& series) {
  using Hull = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, hull_size, 1>;
  const int low = std::min(int(series.size()), hull_size);
  const Hull hull = bernstein_matrix(low).lazyProduct(series.head(low));
  double rest = 0;
  for (int k = low; k < int(series.size()); ++k) rest += std::abs(series[k]) * greatest_of(k, true);
  return {hull.minCoeff() - rest, hull.maxCoeff() + rest};
}

double legendre_bound(const Eigen::VectorXd& f, const TensorShape& shape, int dimensions) {
  double bound = 0;
  for_each(f, shape, dimensions, [&](int, double c, double greatest) { bound += std::abs(c) * greatest; });
  return bound;
}

GreatestValue legendre_greatest(const Eigen::VectorXd& f, const TensorShape& shape,
                                const std::function<bool(const GreatestValue&)>& enough) {
  Search search(f, shape);
  for (int n = 0; n < most_halvings && !enough(search.result()); ++n) search.halve();
  return search.result();
}

}  // namespace airlight::scene
