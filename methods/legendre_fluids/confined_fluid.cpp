#include "methods/legendre_fluids/confined_fluid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/flow.h"

namespace airlight::legendre_fluids {
namespace {

// Of Runge-Kutta, dt n |u| at most: its limit is 2.83, at a spectral radius of at most .8 n |u|.
constexpr double step_rule = 2.5;
// dt n^2 |u| at most where air comes in: the operator is not normal.
constexpr double inflow_rule = 2;

Array values_on(const Array& x, const Array& y, const Array& z, const std::function<double(const Vec3&)>& f) {
  Array values(x.size() * y.size() * z.size());
  Eigen::Index at = 0;
  for (const double px : x)
    for (const double py : y)
      for (const double pz : z) values[at++] = f(Vec3(px, py, pz));
  return values;
}

}  // namespace

int runge_kutta_steps(double dt, int n, double speed, bool air_comes_in) {
  const double rule = std::max(n / step_rule, air_comes_in ? n * n / inflow_rule : 0);
  const double steps = std::ceil(dt * speed * rule * (1 - 1e-9));
  if (!(steps <= 1e6))
    throw scene::Unstable(
        fmt::format("a greatest speed of {:.3g} half boxes a second, too much for steps of {:g} s", speed, dt));
  return std::max(1, int(steps));
}

ConfinedFluid::ConfinedFluid(int dimensions, int n, const Vec3& half, const Material& material,
                             const ConfinedOptions& options, std::optional<Wind> wind)
    : Fluid(dimensions, n, half, material), options_(options), wind_(std::move(wind)) {
  velocity = Array::Zero(space_.size());
  if (!wind_) return;
  const Array& x = space_.nodes();
  const Array last = dimensions == 3 ? x : Array(Array::Zero(1));
  for (int a = 0; a < dimensions; ++a) {
    const auto speed = [&](const Vec3& p) { return wind_->velocity(a, p); };
    wind_at_points_[a] = values_on(x, x, last, speed);
    // The confined part is 0 on the sides.
    for (int side = 0; side < 2; ++side) {
      std::array<Array, 3> at{x, x, last};
      at[a] = Array::Constant(1, side ? 1 : -1);
      wind_on_sides_[a][side] = values_on(at[0], at[1], at[2], speed);
    }
  }
}

void ConfinedFluid::begin(const VelocityFunction& u) {
  if (confined()) velocity = space_.project(space_.from_function(u));
  last_rate_ = Array();
}

Components ConfinedFluid::carrying(const Array& u) const {
  if (!wind_) return space_.at_points(u);
  Components w = wind_at_points_;
  if (!wind_->added) return w;
  const Components own = space_.at_points(u);
  for (int a = 0; a < space_.dimensions(); ++a) w[a] += own[a];
  return w;
}
Components ConfinedFluid::at_points() const { return carrying(velocity); }

Array ConfinedFluid::sampled(int component, const Components& positions) const {
  Array values = space_.sampled(velocity, component, positions);
  if (!wind_) return values;
  const Array last = space_.dimensions() == 3 ? positions[2] : Array(Array::Zero(1));
  const Array wind =
      values_on(positions[0], positions[1], last, [&](const Vec3& x) { return wind_->velocity(component, x); });
  return confined() ? Array(values + wind) : wind;
}

Array ConfinedFluid::sampled_slope(int component, int axis, const Components& positions) const {
  Array slopes = space_.sampled_slope(velocity, component, axis, positions);
  if (!wind_) return slopes;
  // Of a wind that is at most linear a difference is its slope.
  const Vec3 step = Vec3::Unit(axis);
  const double slope = 0.5 * (wind_->velocity(component, step) - wind_->velocity(component, -step));
  return slopes.array() + slope;
}

double ConfinedFluid::at(int component, const Vec3& x) const {
  double value =
      confined() && space_.n() > 1 ? value_at(space_, space_.component(velocity, component), component, x) : 0;
  return wind_ ? value + wind_->velocity(component, x) : value;
}

Array ConfinedFluid::carried_rate(const Components& w, const Array& r, const BySide& incoming) const {
  Array rate = space_.scalar_advected(w, r);
  for (int a = 0; wind_ && a < space_.dimensions(); ++a)
    for (int side = 0; side < 2; ++side)
      rate += space_.scalar_inflow(a, side, wind_on_sides_[a][side], r, incoming[a][side]);
  return rate;
}

void ConfinedFluid::diffuse(double dt) {
  if (material_.viscosity > 0 && material_.moves && confined())
    velocity = space_.project(space_.diffused(velocity, material_.viscosity * dt));
  if (!(material_.diffusivity > 0)) return;
  for (Array* r : {&density, &temperature})
    if (r->size()) *r = space_.scalar_diffused(*r, material_.diffusivity * dt);
}

// The velocity and what it carries together: stages of one see stages of the other.
void ConfinedFluid::advect_by_runge_kutta(double dt) {
  const int count = runge_kutta_steps(dt, space_.n(), greatest_speed(), wind_.has_value());
  const Eigen::Index nu = velocity.size(), nd = density.size(), nt = temperature.size();
  Array y(nu + nd + nt);
  y.head(nu) = velocity, y.segment(nu, nd) = density, y.tail(nt) = temperature;
  const auto rate = [&](const Array& now) {
    Array change = Array::Zero(now.size());
    const Components w = carrying(now.head(nu));
    if (material_.moves && confined()) {
      const Components own = wind_ ? space_.at_points(now.head(nu)) : w;
      change.head(nu) = space_.project(space_.advected(own, now.head(nu)));
    }
    if (nd) change.segment(nu, nd) = carried_rate(w, now.segment(nu, nd), wind_ ? wind_->density : BySide{});
    if (nt) change.tail(nt) = carried_rate(w, now.tail(nt), wind_ ? wind_->temperature : BySide{});
    return change;
  };
  for (int i = 0; i < count; ++i) y = runge_kutta_4(y, dt / count, rate);
  substeps_ += count;
  velocity = y.head(nu), density = y.segment(nu, nd), temperature = y.tail(nt);
}

Array ConfinedFluid::krylov(const Array& y, double dt, const SkewOperator& a) {
  if (y.size() == 0) return y;
  const auto function = options_.time_step == TimeStep::exponential ? SkewFunction::exponential : SkewFunction::cayley;
  const KrylovStep step = krylov_step(a, y, dt, function, options_.krylov, options_.tolerance);
  vectors_ += step.dimensions;
  greatest_estimate_ = std::max(greatest_estimate_, step.estimate);
  return step.y;
}

// The velocity that carries is that of the middle of the step, by what advection did in the last one: second order beside diffusion, where
// 1.5 u - 0.5 of the last u would count half a step of diffusion twice.
void ConfinedFluid::advect_by_krylov(double dt) {
  const Array now = velocity;
  const auto skew = [&](const Components& w) {
    return SkewOperator{[this, w](const Array& v) { return space_.project(space_.advected(w, v)); },
                        [this](const Array& v) { return space_.weighted(v); }};
  };
  Array middle = now;
  if (material_.moves) {
    if (last_rate_.size() == now.size())
      middle += 0.5 * dt * last_rate_;
    else
      middle = krylov(now, 0.5 * dt, skew(space_.at_points(now)));
  }
  const Components w = space_.at_points(middle);
  if (material_.moves) velocity = krylov(now, dt, skew(w));
  const SkewOperator carried{[&](const Array& r) { return space_.scalar_advected(w, r); },
                             [](const Array& r) { return r; }};
  for (Array* r : {&density, &temperature}) {
    if (!r->size()) continue;
    // The mean moves by itself: without it, that of the rest stays 0 whatever the tolerance.
    const double mean = (*r)[0];
    (*r)[0] = 0;
    *r = krylov(*r, dt, carried);
    (*r)[0] = mean;
  }
  last_rate_ = (velocity - now) / dt;
  ++substeps_;
}

// Equal factors for coefficients of equal index keep div u = 0: there they add.
void ConfinedFluid::filter(double dt) {
  const int n = space_.n();
  const auto damped = [&](const Array& c, int component, double rate) {
    const TensorShape s = space_.shape(component);
    Array result = c;
    int at = 0;
    for (int i = 0; i < s[0]; ++i)
      for (int j = 0; j < s[1]; ++j)
        for (int k = 0; k < s[2]; ++k, ++at) {
          std::array<int, 3> index{i, j, k};
          if (component >= 0) ++index[component];
          double sum = 0;
          for (const int m : index) sum += std::pow(double(m) / (n - 1), options_.filter_order);
          result[at] *= std::exp(-rate * dt * sum);
        }
    return result;
  };
  if (n == 1) return;
  if (options_.filter_velocity > 0 && material_.moves) {
    const double before = space_.inner(velocity, velocity);
    Components parts;
    for (int a = 0; a < space_.dimensions(); ++a)
      parts[a] = damped(space_.component(velocity, a), a, options_.filter_velocity);
    velocity = space_.joined(parts);
    filtered_ += 0.5 * (before - space_.inner(velocity, velocity));
  }
  if (!(options_.filter_carried > 0)) return;
  for (Array* r : {&density, &temperature})
    if (r->size()) *r = damped(*r, -1, options_.filter_carried);
}

void ConfinedFluid::advance(double dt) {
  diffuse(0.5 * dt);
  if (options_.time_step == TimeStep::runge_kutta)
    advect_by_runge_kutta(dt);
  else
    advect_by_krylov(dt);
  diffuse(0.5 * dt);
}

void ConfinedFluid::push(const Components& change) {
  if (confined()) velocity += space_.project(space_.from_scalars(change));
}

std::map<std::string, double> ConfinedFluid::counters() const {
  std::map<std::string, double> counters{{"coefficients of velocity", double(space_.size())}};
  if (options_.time_step == TimeStep::runge_kutta) {
    counters["Runge-Kutta steps"] = substeps_;
  } else {
    counters["Krylov vectors"] = vectors_;
    counters["greatest Krylov estimate"] = greatest_estimate_;
  }
  if (options_.filter_velocity > 0) counters["energy filtered"] = filtered_;
  return counters;
}

}  // namespace airlight::legendre_fluids
