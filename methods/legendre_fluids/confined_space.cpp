#include "methods/legendre_fluids/confined_space.h"

#include <algorithm>
#include <cmath>

#include "scene/math/dense.h"

namespace airlight::legendre_fluids {
namespace {

using Eigen::MatrixXd;
using scene::along_axis;
using scene::product;
using scene::tensor_size;

double factor(double rate_amount, ConfinedSpace::Diffusion kind) {
  return kind == ConfinedSpace::Diffusion::exact ? std::exp(-rate_amount) : 1 / (1 + rate_amount);
}

// body(flat index, indices) over all entries.
template <class Body>
void each(const TensorShape& shape, const Body& body) {
  int at = 0;
  for (int i = 0; i < shape[0]; ++i)
    for (int j = 0; j < shape[1]; ++j)
      for (int k = 0; k < shape[2]; ++k) body(at++, std::array<int, 3>{i, j, k});
}

}  // namespace

ConfinedSpace::ConfinedSpace(int dimensions, int n, const Vec3& half)
    : d_(dimensions), n_(n), half_(half), points_(mirrored(scene::legendre_points(n + 1, (3 * n + 1) / 2))) {
  for (int a = 0; a < d_; ++a) offset_[a + 1] = offset_[a] + tensor_size(shape(a));
  phi_ = scene::legendre_integral(n).rightCols(n - 1);
  mass_ = product(phi_.transpose(), phi_);
  wall_rates_.resize(n - 1);
  free_modes_ = pressure_modes_ = MatrixXd::Identity(n, n);
  free_rates_ = Array::Zero(n);
  if (n > 1) {
    const scene::SymmetricModes wall = scene::symmetric_modes(mass_);
    wall_modes_ = wall.vectors;
    wall_rates_ = wall.values.cwiseInverse();
    inverse_ = product(wall_modes_ * wall_rates_.asDiagonal(), wall_modes_.transpose());
    pressure_modes_.bottomRightCorner(n - 1, n - 1) = wall_modes_;
    // The constant is a mode to the last bit, so that diffusion keeps the mass.
    const MatrixXd derivative = scene::legendre_derivative(n);
    const scene::SymmetricModes free =
        scene::symmetric_modes(product(derivative.transpose(), derivative).bottomRightCorner(n - 1, n - 1));
    free_modes_.bottomRightCorner(n - 1, n - 1) = free.vectors;
    free_rates_.tail(n - 1) = free.values;
  }
  to_wall_modes_ = wall_modes_.transpose();
  to_free_modes_ = free_modes_.transpose();
  to_pressure_modes_ = pressure_modes_.transpose();
  lifted_ = MatrixXd::Zero(n - 1, n);
  lifted_.rightCols(n - 1) = wall_modes_ * wall_rates_.asDiagonal();
  pressure_.resize(scalars());
  each(shape(), [&](int at, const std::array<int, 3>& i) {
    double rate = 0;
    for (int a = 0; a < d_; ++a)
      if (i[a] > 0) rate += wall_rates_[i[a] - 1] / (half_[a] * half_[a]);
    pressure_[at] = rate > 0 ? -1 / rate : 0;
  });
  at_points_ = {points_.values.leftCols(n), product(points_.values, phi_)};
  from_points_[0] = points_.analysis.topRows(n);
  if (n == 1) return;
  from_points_[1] = product(product(inverse_, phi_.transpose()), points_.analysis);
  from_scalar_ = product(inverse_, phi_.topRows(n).transpose());
  const int m = int(points_.node.size());
  slope_at_points_ = {points_.slopes.leftCols(n), points_.values.middleCols(1, n - 1)};
  kernel_ = AdvectionKernel(d_, {n, m, at_points_[0], slope_at_points_[0], from_points_[0]},
                            {n - 1, m, at_points_[1], slope_at_points_[1], from_points_[1]});
}

TensorShape ConfinedSpace::shape() const { return {n_, n_, d_ == 3 ? n_ : 1}; }
TensorShape ConfinedSpace::shape(int component) const {
  TensorShape s = shape();
  if (component >= 0) s[component] = n_ - 1;
  return s;
}
TensorShape ConfinedSpace::points_shape() const {
  const int m = int(points_.node.size());
  return {m, m, d_ == 3 ? m : 1};
}

Array ConfinedSpace::joined(const Components& parts) const {
  Array u(size());
  for (int a = 0; a < d_; ++a) u.segment(offset_[a], offset_[a + 1] - offset_[a]) = parts[a];
  return u;
}

Array ConfinedSpace::transformed(const Array& c, TensorShape s, const std::array<const MatrixXd*, 3>& matrix) const {
  Array result = c;
  for (int a = d_ - 1; a >= 0; --a) {
    result = along_axis(a, *matrix[a], result, s);
    s[a] = int(matrix[a]->rows());
  }
  return result;
}

Array ConfinedSpace::divergence(const Array& u) const {
  Array sum = Array::Zero(scalars());
  const TensorShape all = shape();
  for (int a = 0; a < d_ && n_ > 1; ++a)
    each(shape(a), [&](int at, std::array<int, 3> i) {
      ++i[a];  // phi_i' = L_i, i from 1
      sum[(i[0] * all[1] + i[1]) * all[2] + i[2]] += u[offset_[a] + at];
    });
  return sum;
}

Array ConfinedSpace::project(const Array& u) const {
  if (n_ == 1) return u;
  const std::array<const MatrixXd*, 3> to{&to_pressure_modes_, &to_pressure_modes_, &to_pressure_modes_};
  const Array p = transformed(divergence(u), shape(), to).cwiseProduct(pressure_);
  Array result = u;
  for (int a = 0; a < d_; ++a) {
    std::array<const MatrixXd*, 3> matrix{&pressure_modes_, &pressure_modes_, &pressure_modes_};
    matrix[a] = &lifted_;
    result.segment(offset_[a], offset_[a + 1] - offset_[a]) += transformed(p, shape(), matrix) / (half_[a] * half_[a]);
  }
  return result;
}

Array ConfinedSpace::weighted(const Array& u) const {
  Array result(u.size());
  const double volume = half_.head(d_).prod();
  for (int a = 0; a < d_ && n_ > 1; ++a)
    result.segment(offset_[a], offset_[a + 1] - offset_[a]) =
        volume * half_[a] * half_[a] * along_axis(a, mass_, component(u, a), shape(a));
  return result;
}

double ConfinedSpace::inner(const Array& u, const Array& v) const { return weighted(u).dot(v); }

Array ConfinedSpace::diffused_part(const Array& c, int component, double amount, Diffusion kind) const {
  std::array<const MatrixXd*, 3> to{&to_free_modes_, &to_free_modes_, &to_free_modes_};
  std::array<const MatrixXd*, 3> from{&free_modes_, &free_modes_, &free_modes_};
  std::array<const Array*, 3> rates{&free_rates_, &free_rates_, &free_rates_};
  if (component >= 0) {
    to[component] = &to_wall_modes_;
    from[component] = &wall_modes_;
    rates[component] = &wall_rates_;
  }
  const TensorShape s = shape(component);
  Array modes = transformed(c, s, to);
  each(s, [&](int at, const std::array<int, 3>& i) {
    double rate = 0;
    for (int a = 0; a < d_; ++a) rate += (*rates[a])[i[a]] / (half_[a] * half_[a]);
    modes[at] *= factor(rate * amount, kind);
  });
  return transformed(modes, s, from);
}

Array ConfinedSpace::diffused(const Array& u, double amount, Diffusion kind) const {
  if (n_ == 1) return u;
  Components parts;
  for (int a = 0; a < d_; ++a) parts[a] = diffused_part(component(u, a), a, amount, kind);
  return joined(parts);
}
Array ConfinedSpace::scalar_diffused(const Array& r, double amount, Diffusion kind) const {
  return diffused_part(r, -1, amount, kind);
}

Components ConfinedSpace::at_points(const Array& u) const {
  Components values;
  for (int a = 0; a < d_; ++a) {
    values[a] = Array::Zero(tensor_size(points_shape()));
    if (n_ == 1) continue;
    std::array<const MatrixXd*, 3> matrix{&at_points_[0], &at_points_[0], &at_points_[0]};
    matrix[a] = &at_points_[1];
    values[a] = transformed(component(u, a), shape(a), matrix);
  }
  return values;
}

Array ConfinedSpace::scalar_at_points(const Array& r) const {
  return transformed(r, shape(), {&at_points_[0], &at_points_[0], &at_points_[0]});
}

double ConfinedSpace::integral(const Array& values) const {
  const MatrixXd weights = points_.weight.transpose();
  return half_.head(d_).prod() * transformed(values, points_shape(), {&weights, &weights, &weights})[0];
}

Array ConfinedSpace::scalar_from_points(const Array& values) const {
  return transformed(values, points_shape(), {&from_points_[0], &from_points_[0], &from_points_[0]});
}

Array ConfinedSpace::from_points(const Components& values) const {
  if (n_ == 1) return Array();
  Components parts;
  for (int a = 0; a < d_; ++a) {
    std::array<const MatrixXd*, 3> matrix{&from_points_[0], &from_points_[0], &from_points_[0]};
    matrix[a] = &from_points_[1];
    parts[a] = transformed(values[a], points_shape(), matrix);
  }
  return joined(parts);
}

void ConfinedSpace::advected_together(const double* u, bool moves, const Components& wind,
                                      const std::vector<const double*>& scalars, double* u_rate,
                                      const std::vector<double*>& rates) const {
  if (n_ == 1) {
    for (double* rate : rates) *rate = 0;
    return;
  }
  std::vector<AdvectionKernel::Field> fields;
  for (int a = 0; a < d_ && u; ++a) fields.push_back({a, u + offset_[a], moves ? u_rate + offset_[a] : nullptr, true});
  for (std::size_t i = 0; i < scalars.size(); ++i) fields.push_back({-1, scalars[i], rates[i], false});
  std::array<const double*, 3> at{};
  for (int a = 0; a < d_; ++a) at[a] = wind[a].size() ? wind[a].data() : nullptr;
  kernel_(fields, at);
}

Array ConfinedSpace::advected(const Components& w, const Array& u) const {
  if (n_ == 1) return u;
  Array rate(u.size());
  std::vector<AdvectionKernel::Field> fields;
  for (int a = 0; a < d_; ++a) fields.push_back({a, u.data() + offset_[a], rate.data() + offset_[a], false});
  kernel_(fields, {w[0].data(), w[1].data(), d_ == 3 ? w[2].data() : nullptr});
  return rate;
}

Array ConfinedSpace::scalar_advected(const Components& w, const Array& r) const {
  Array rate(r.size());
  advected_together(nullptr, false, w, {r.data()}, nullptr, {rate.data()});
  return rate;
}

Array ConfinedSpace::scalar_inflow(int axis, int side, const Array& speed, const Array& r, double r_in) const {
  const MatrixXd end = scene::legendre_values(n_, Array::Constant(1, side ? 1 : -1)), back = end.transpose();
  std::array<const MatrixXd*, 3> to{&at_points_[0], &at_points_[0], &at_points_[0]};
  std::array<const MatrixXd*, 3> from{&from_points_[0], &from_points_[0], &from_points_[0]};
  to[axis] = &end;
  from[axis] = &back;
  const Array inwards = (side ? Array(-speed) : speed).cwiseMax(0);
  const Array excess = transformed(r, shape(), to) - Array::Constant(speed.size(), r_in);
  TensorShape face = points_shape();
  face[axis] = 1;
  return transformed(-inwards.cwiseProduct(excess), face, from);
}

Array ConfinedSpace::from_scalars(const Components& scalars) const {
  if (n_ == 1) return Array();
  Components parts;
  for (int a = 0; a < d_; ++a) parts[a] = along_axis(a, from_scalar_, scalars[a], shape());
  return joined(parts);
}

}  // namespace airlight::legendre_fluids
