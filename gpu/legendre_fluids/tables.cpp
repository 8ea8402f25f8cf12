#include "gpu/legendre_fluids/tables.h"

#include <cmath>

#include "scene/math/dense.h"

namespace airlight::gpu::legendre_fluids {
namespace {

using Eigen::MatrixXd;

// With a row, a column, or both of zeros in front, for phi_0.
MatrixXd widened(const MatrixXd& m, bool row, bool column) {
  MatrixXd result = MatrixXd::Zero(m.rows() + row, m.cols() + column);
  result.bottomRightCorner(m.rows(), m.cols()) = m;
  return result;
}
MatrixXd widened(const Array& rates) { return widened(rates.transpose(), false, true); }

}  // namespace

void Tables::begin(const std::string& name) { definitions_["TABLE_" + name] = std::to_string(values_.size() / 4); }

void Tables::rows(const MatrixXd& m) {
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    for (Eigen::Index c = 0; c < (m.cols() + 3) / 4 * 4; ++c) values_.push_back(c < m.cols() ? float(m(r, c)) : 0);
}

Tables::Tables(const ConfinedSpace& space, double filter_order) {
  const int n = space.n(), points = space.points_shape()[0];
  const auto number = [&](const char* name, int value) { definitions_[name] = std::to_string(value); };
  number("D", space.dimensions());
  number("N", n);
  number("NZ", space.shape()[2]);
  number("POINTS", points);
  number("POINTS_Z", space.points_shape()[2]);
  number("ROW", (points + 3) / 4 * 4);
  number("SQUARE_ROW", (n + 3) / 4 * 4);
  const ConfinedSpace::Matrices m = space.matrices();
  // Matrices for L, then for phi; functions by rows, points by columns.
  begin("VALUES");
  rows(m.at_points[0].transpose());
  rows(widened(m.at_points[1].transpose(), true, false));
  begin("SLOPES");
  rows(m.points.slopes.leftCols(n).transpose());
  rows(widened(m.points.values.middleCols(1, n - 1).transpose(), true, false));  // phi_i' = L_i
  begin("FROM_POINTS");
  rows(m.from_points[0]);
  rows(widened(m.from_points[1], true, false));
  begin("PRESSURE_MODES");
  rows(m.pressure_modes);
  begin("LIFT");  // to the gradient: inverse mass times what the pressure has from index 1 on
  rows(widened(m.wall_modes * m.wall_rates.asDiagonal(), true, true));
  begin("WALL_MODES");
  rows(widened(m.wall_modes, true, true));
  begin("FREE_MODES");
  rows(m.free_modes);
  begin("FROM_SCALAR");
  rows(widened(m.from_scalar, true, false));
  begin("WALL_RATES");
  rows(widened(m.wall_rates));
  begin("FREE_RATES");
  rows(m.free_rates.transpose());
  begin("POWERS");
  rows((Array::LinSpaced(n, 0, 1).array().pow(filter_order)).matrix().transpose());
  // Along an axis of a wind: the points; from values there to those at both ends; from a value at an end to the values at the points of the
  // polynomial whose projection has the basis at that end.
  const MatrixXd ends = scene::legendre_values(n, Array::LinSpaced(2, -1, 1));
  begin("NODES");
  rows(m.points.node.transpose());
  begin("TO_ENDS");
  rows(scene::product(ends, m.from_points[0]));
  begin("FROM_ENDS");
  rows(scene::product(ends, m.at_points[0].transpose()));
  number("MATRICES", int(values_.size() / 4));
}

namespace {

template <class Body>
void each(const ConfinedSpace& space, int component, const Body& body) {
  const scene::TensorShape all = space.shape();
  std::array<int, 3> i{};
  for (i[0] = 0; i[0] < all[0]; ++i[0])
    for (i[1] = 0; i[1] < all[1]; ++i[1])
      for (i[2] = 0; i[2] < all[2]; ++i[2]) body(component < 0 || i[component] > 0);
}

}  // namespace

void put_field(const ConfinedSpace& space, int component, const Array& c, std::vector<float>& at_end) {
  Eigen::Index next = 0;
  each(space, component, [&](bool there) { at_end.push_back(there ? float(c[next++]) : 0); });
}

Array take_field(const ConfinedSpace& space, int component, const float* from) {
  Array c(scene::tensor_size(space.shape(component)));
  Eigen::Index next = 0;
  each(space, component, [&](bool there) {
    if (there) c[next++] = *from;
    ++from;
  });
  return c;
}

}  // namespace airlight::gpu::legendre_fluids
