#include "methods/legendre_fluids/confined_fluid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/legendre_fluids/point_values.h"
#include "scene/flow/flow.h"

namespace airlight::legendre_fluids {
namespace {

// Stability limit of Runge-Kutta: dt n |u| at most. Theory allows 2.83, for a spectral radius of at most .8 n |u|.
constexpr double step_rule = 2.5;
// Limit of dt n^2 |u| where air comes in: the operator is not normal there.
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
    const auto speed = [&](const Vec3& p) { return wind_->velocity(p)[a]; };
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
}

Vec3 ConfinedFluid::gust(double at) const {
  return wind_ ? Vec3(std::sin(2 * pi * wind_->frequency * at) * wind_->gust) : Vec3(Vec3::Zero());
}

Components ConfinedFluid::wind_at(double at) const {
  Components w = wind_at_points_;
  for (int a = 0; wind_ && a < space_.dimensions(); ++a) w[a].array() += gust(at)[a];
  return w;
}

Components ConfinedFluid::at_points() const {
  if (!confined()) return wind_at(time);
  Components w = space_.at_points(velocity);
  const Components wind = wind_at(time);
  for (int a = 0; wind_ && a < space_.dimensions(); ++a) w[a] += wind[a];
  return w;
}

Array ConfinedFluid::sampled(int component, const Components& positions) const {
  Array values = space_.sampled(velocity, component, positions);
  if (!wind_) return values;
  const Array last = space_.dimensions() == 3 ? positions[2] : Array(Array::Zero(1));
  const Array wind = values_on(positions[0], positions[1], last,
                               [&](const Vec3& x) { return wind_->velocity(x)[component] + gust(time)[component]; });
  return confined() ? Array(values + wind) : wind;
}

Array ConfinedFluid::sampled_gradient(int component, int axis, const Components& positions) const {
  Array gradient = space_.sampled_gradient(velocity, component, axis, positions);
  if (!wind_) return gradient;
  // The wind is at most linear in space, so this central difference is its exact gradient.
  const Vec3 step = Vec3::Unit(axis);
  const double of_wind = 0.5 * (wind_->velocity(step) - wind_->velocity(-step))[component];
  return gradient.array() + of_wind;
}

double ConfinedFluid::at(int component, const Vec3& x) const {
  double value =
      confined() && space_.n() > 1 ? value_at(space_, space_.component(velocity, component), component, x) : 0;
  return wind_ ? value + wind_->velocity(x)[component] + gust(time)[component] : value;
}

Array ConfinedFluid::at(int component, const std::vector<Vec3>& x) const {
  Array values = Array::Zero(Eigen::Index(x.size()));
  if (confined() && space_.n() > 1) {
    TensorShape shape = space_.shape(component);
    const Array series = scene::along_axis(component, space_.phi(), space_.component(velocity, component), shape);
    shape[component] = space_.n() + 1;
    values = series_values(shape, series.data(), x);
    if (space_.dimensions() == 2) values *= std::sqrt(2.0);  // no L_0 along z
  }
  if (!wind_) return values;
  const double blows = gust(time)[component];
  for (std::size_t i = 0; i < x.size(); ++i) values[Eigen::Index(i)] += wind_->velocity(x[i])[component] + blows;
  return values;
}

void ConfinedFluid::add_inflow(double at, const Array& r, std::size_t which, Array& rate) const {
  for (int a = 0; a < space_.dimensions(); ++a)
    for (int side = 0; side < 2; ++side) {
      const Array speed = wind_on_sides_[a][side].array() + gust(at)[a];
      rate += space_.scalar_inflow(a, side, speed, r, wind_->incoming[which][a][side]);
    }
}

void ConfinedFluid::diffuse(double dt) {
  if (material_.viscosity > 0 && material_.moves && confined())
    velocity = space_.project(space_.diffused(velocity, material_.viscosity * dt));
  if (!(material_.diffusivity > 0)) return;
  for (Array* r : carried())
    if (r->size()) *r = space_.scalar_diffused(*r, material_.diffusivity * dt);
}

// The velocity, what it carries, and the time: stages of one see stages of the other.
Array ConfinedFluid::joined_state() {
  Eigen::Index size = velocity.size() + 1;
  for (const Array* r : carried()) size += r->size();
  Array y(size);
  Eigen::Index begin = velocity.size();
  y.head(begin) = velocity;
  for (const Array* r : carried()) y.segment(begin, r->size()) = *r, begin += r->size();
  y[begin] = time;
  return y;
}

Array ConfinedFluid::state_rate(const Array& y) {
  Array rate = Array::Zero(y.size());
  const double at = y[y.size() - 1];
  std::vector<const double*> scalars;
  std::vector<double*> rates;
  std::vector<std::size_t> which;
  const std::vector<Array*> all = carried();
  Eigen::Index begin = velocity.size();
  for (std::size_t i = 0; i < all.size(); begin += all[i++]->size())
    if (all[i]->size()) {
      scalars.push_back(y.data() + begin), rates.push_back(rate.data() + begin);
      which.push_back(i);
    }
  // A wind that is added carries what it carries, not the velocity beside it: that would leave by the sides.
  const bool moves = material_.moves && confined();
  if (moves && wind_) space_.advected_together(y.data(), true, {}, {}, rate.data(), {});
  space_.advected_together(confined() ? y.data() : nullptr, moves && !wind_, wind_at(at), scalars, rate.data(), rates);
  if (moves) rate.head(velocity.size()) = space_.project(rate.head(velocity.size()));
  for (std::size_t i = 0; i < which.size() && wind_; ++i) {
    Array change = Eigen::Map<Array>(rates[i], all[which[i]]->size());
    add_inflow(at, Eigen::Map<const Array>(scalars[i], change.size()), which[i], change);
    Eigen::Map<Array>(rates[i], change.size()) = change;
  }
  rate[y.size() - 1] = 1;
  return rate;
}

// Speeds may rise on the way: what is left is divided anew after each part.
void ConfinedFluid::advect(double dt) {
  const double gusts = wind_ ? wind_->gust.norm() : 0;
  for (double left = dt; left > 0;) {
    const int steps = runge_kutta_steps(left, space_.n(), greatest_speed() + gusts, wind_.has_value());
    const double part = left / steps;
    runge_kutta_part(part);
    left = steps > 1 ? left - part : 0;
    ++substeps_;
  }
}

void ConfinedFluid::runge_kutta_part(double dt) {
  const Array y = runge_kutta_4(joined_state(), dt, [&](const Array& now) { return state_rate(now); });
  Eigen::Index begin = velocity.size();
  velocity = y.head(begin);
  for (Array* r : carried()) *r = y.segment(begin, r->size()), begin += r->size();
  time = y[begin];
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
  for (Array* r : carried())
    if (r->size()) *r = damped(*r, -1, options_.filter_carried);
}

void ConfinedFluid::advance(double dt) {
  diffuse(0.5 * dt);
  advect(dt);
  diffuse(0.5 * dt);
}

void ConfinedFluid::push(const Components& change) {
  if (confined()) velocity += space_.project(space_.from_scalars(change));
}

std::map<std::string, double> ConfinedFluid::counters() const {
  std::map<std::string, double> counters{{"coefficients of velocity", double(space_.size())},
                                         {"Runge-Kutta steps", substeps_}};
  if (options_.filter_velocity > 0) counters["energy filtered"] = filtered_;
  return counters;
}

}  // namespace airlight::legendre_fluids
