// Functions to coefficients, and coefficients to values on lattices.
#include "methods/legendre_fluids/confined_space.h"
#include "scene/math/dense.h"

namespace airlight::legendre_fluids {
namespace {

using Eigen::MatrixXd;
using scene::product;

// Functions are no polynomials: points beyond what products need, so that theirs is not the error.
int points_of_functions(int n) { return 2 * n + 16; }

// body(flat index, point) over the lattice of the nodes.
template <class Body>
void each_point(const Array& node, int dimensions, const Body& body) {
  const int m = int(node.size()), last = dimensions == 3 ? m : 1;
  int at = 0;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      for (int k = 0; k < last; ++k) body(at++, Vec3(node[i], node[j], dimensions == 3 ? node[k] : 0));
}

}  // namespace

Array ConfinedSpace::from_function(const std::function<Vec3(const Vec3&)>& u) const {
  if (n_ == 1) return Array();
  const scene::LegendrePoints& fine = scene::legendre_points(n_ + 1, points_of_functions(n_));
  const MatrixXd free = fine.analysis.topRows(n_), wall = product(product(inverse_, phi_.transpose()), fine.analysis);
  const int m = int(fine.node.size());
  const TensorShape fine_shape{m, m, d_ == 3 ? m : 1};
  Components parts;
  for (int a = 0; a < d_; ++a) parts[a].resize(scene::tensor_size(fine_shape));
  each_point(fine.node, d_, [&](int at, const Vec3& x) {
    const Vec3 v = u(x);
    for (int a = 0; a < d_; ++a) parts[a][at] = v[a];
  });
  for (int a = 0; a < d_; ++a) {
    std::array<const MatrixXd*, 3> matrix{&free, &free, &free};
    matrix[a] = &wall;
    parts[a] = transformed(parts[a], fine_shape, matrix);
  }
  return joined(parts);
}

Array ConfinedSpace::scalar_from_function(const std::function<double(const Vec3&)>& r, int points) const {
  const scene::LegendrePoints& fine = scene::legendre_points(n_, points > 0 ? points : points_of_functions(n_));
  const int m = int(fine.node.size());
  const TensorShape fine_shape{m, m, d_ == 3 ? m : 1};
  Array values(scene::tensor_size(fine_shape));
  each_point(fine.node, d_, [&](int at, const Vec3& x) { values[at] = r(x); });
  return transformed(values, fine_shape, {&fine.analysis, &fine.analysis, &fine.analysis});
}

Array ConfinedSpace::sampled(const Array& c, int component, int gradient_axis, const Components& positions) const {
  std::array<MatrixXd, 3> matrix;
  for (int a = 0; a < d_; ++a) {
    if (a == component)
      matrix[a] = a == gradient_axis ? MatrixXd(scene::legendre_values(n_, positions[a]).rightCols(n_ - 1))
                                     : product(scene::legendre_values(n_ + 1, positions[a]), phi_);
    else
      matrix[a] =
          a == gradient_axis ? scene::legendre_slopes(n_, positions[a]) : scene::legendre_values(n_, positions[a]);
  }
  return transformed(c, shape(component), {&matrix[0], &matrix[1], &matrix[2]});
}

Array ConfinedSpace::sampled(const Array& u, int a, const Components& positions) const {
  return sampled_gradient(u, a, -1, positions);
}
Array ConfinedSpace::sampled_gradient(const Array& u, int a, int axis, const Components& positions) const {
  if (n_ > 1) return sampled(component(u, a), a, axis, positions);
  Eigen::Index count = 1;
  for (int b = 0; b < d_; ++b) count *= positions[b].size();
  return Array::Zero(count);
}
Array ConfinedSpace::scalar_sampled(const Array& r, const Components& positions) const {
  return sampled(r, -1, -1, positions);
}
Array ConfinedSpace::scalar_sampled_gradient(const Array& r, int axis, const Components& positions) const {
  return sampled(r, -1, axis, positions);
}

}  // namespace airlight::legendre_fluids
