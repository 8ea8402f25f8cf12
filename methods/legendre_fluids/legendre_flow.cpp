#include "methods/legendre_fluids/legendre_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/saved_state.h"

namespace airlight::legendre_fluids {

using scene::FlowProblem;

LegendreFlow::LegendreFlow(std::shared_ptr<const FlowProblem> problem, std::unique_ptr<Fluid> fluid, int cells,
                           Mixing mixing)
    : p_(std::move(problem)), box_(*p_), fluid_(std::move(fluid)), cells_(box_, p_->box.lo, cells), mixing_(mixing) {
  begin();
}

void LegendreFlow::begin() {
  const ConfinedSpace& space = fluid_->space();
  fluid_->begin(
      [&](const Vec3& x) -> Vec3 { return scene::start_velocity(*p_, box_.outside(x)).cwiseQuotient(box_.half); });
  begin_densities();
  if (carries_temperature(*p_))
    fluid_->temperature =
        space.scalar_from_function([&](const Vec3& x) { return scene::start_temperature(*p_, box_.outside(x)); });
  for (std::size_t i = 0; i < p_->sources.size(); ++i)
    source_.push_back(region_coefficients(*p_, space, box_, p_->sources[i].region, fmt::format("source {}", i)));
  for (const scene::Push& push : p_->pushes) begin_push(push);
  LegendreFlow::settle();
}

void LegendreFlow::begin_push(const scene::Push& push) {
  push_.push_back(
      region_coefficients(*p_, fluid_->space(), box_, push.region, fmt::format("force {}", pushes_.size())));
  pushes_.push_back(push);
}

void LegendreFlow::add(const scene::Push& push) {
  if (p_->velocity_stays) return scene::Flow::add(push);
  begin_push(push);
}

void LegendreFlow::begin_densities() {
  std::vector<FlowProblem> alone;
  for (int k = 0; k <= int(p_->densities.size()); ++k) alone.push_back(scene::with_density(*p_, k));
  const auto set = [&](Array& r, const std::function<double(const Point3&)>& value) {
    r = fluid_->space().scalar_from_function([&](const Vec3& x) { return value(box_.outside(x)); });
  };
  fluid_->others.resize(p_->densities.size());
  if (mixing_ == Mixing::albedo) {
    const auto sum = [&](const Point3& x) { return start_density(alone[0], x) + start_density(alone[1], x); };
    set(fluid_->density, sum);
    set(fluid_->others[0], [&](const Point3& x) {
      return sum(x) > 0 ? start_density(alone[0], x) / sum(x) : 0.5;  // of nothing, any share
    });
    return;
  }
  for (std::size_t k = 0; k < alone.size(); ++k)
    if (carries_density(alone[k]))
      set(k == 0 ? fluid_->density : fluid_->others[k - 1],
          [&](const Point3& x) { return scene::start_density(alone[k], x); });
}

void LegendreFlow::settle() const {
  fluid_->time = time_;
  if (mixing_ != Mixing::albedo) return;
  const ConfinedSpace& space = fluid_->space();
  products_[0] = scene::legendre_product(fluid_->density, space.shape(), fluid_->others[0], space.shape(),
                                         space.shape(), space.dimensions());
  products_[1] = fluid_->density - products_[0];
}

const Array& LegendreFlow::smoke(int which) const {
  const Fluid& fluid = now();
  if (mixing_ == Mixing::albedo) return products_.at(std::size_t(which));
  return which == 0 ? fluid.density : fluid.others.at(std::size_t(which) - 1);
}

void LegendreFlow::step(double dt) {
  try {
    move(dt);
  } catch (const scene::Unstable& e) {
    throw scene::Unstable(fmt::format("step {}, t = {:.6g} s: {}", steps_ + 1, time_, e.what()));
  }
  // Time after equal steps is computed as a product, because a sum would drift.
  if (dt != last_step_) since_ = time_, equal_steps_ = 0;
  last_step_ = dt;
  time_ = since_ + ++equal_steps_ * dt;
  ++steps_;
  settle();
}

std::array<LegendreFlow::Acting, 2> LegendreFlow::acting(double dt) const {
  const Interval all{time_, time_ + dt}, none{time_, time_};
  if (!fluid_->halves()) return {{{0, all, none}, {dt, none, all}}};
  const double middle = time_ + 0.5 * dt;
  const Interval first{all.lo, middle}, second{middle, all.hi};
  return {{{0.5 * dt, first, first}, {0.5 * dt, second, second}}};
}

void LegendreFlow::move(double dt) {
  const std::array<Acting, 2> halves = acting(dt);
  const Acting &before = halves[0], &after = halves[1];
  timed("sources", [&] {
    fade(before.decay);
    add_sources(before.sources);
  });
  timed("forces", [&] { push(before.pushes); });
  require_finite();
  timed("advection and diffusion", [&] { fluid_->advance(dt); });
  timed("forces", [&] { push(after.pushes); });
  timed("sources", [&] { add_sources(after.sources); });
  timed("projection and filter", [&] { fluid_->finish(dt); });
  require_finite();
  fade(after.decay);
}

void LegendreFlow::fade(double seconds) {
  if (!(p_->decay * seconds > 0)) return;
  const double factor = fluid_->faded(p_->decay * seconds);
  fluid_->density *= factor;
  fluid_->temperature *= factor;
  for (Array& r : fluid_->others)
    if (mixing_ == Mixing::densities) r *= factor;
}

std::vector<double> LegendreFlow::source_seconds(const Interval& time) const {
  std::vector<double> seconds;
  for (const scene::Source& s : p_->sources) {
    const Interval part = intersect(s.time, time);
    seconds.push_back(part.empty() ? 0 : part.length());
  }
  return seconds;
}

std::vector<double> LegendreFlow::push_seconds(const Interval& time) const {
  std::vector<double> seconds;
  for (const scene::Push& force : pushes_) {
    const Interval part = intersect(force.time, time);
    // The integral of cos(2 pi f t) over the part of it.
    const double w = 2 * pi * force.frequency;
    seconds.push_back(part.empty() ? 0 : w > 0 ? (std::sin(w * part.hi) - std::sin(w * part.lo)) / w : part.length());
  }
  return seconds;
}

void LegendreFlow::add_sources(const Interval& time) {
  const std::vector<double> seconds = source_seconds(time);
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const scene::Source& s = p_->sources[i];
    if (!(seconds[i] > 0)) continue;
    Array& density = s.of == 0 ? fluid_->density : fluid_->others[std::size_t(s.of) - 1];
    if (s.density_rate != 0) density += seconds[i] * s.density_rate * source_[i];
    if (s.temperature_rate != 0) fluid_->temperature += seconds[i] * s.temperature_rate * source_[i];
  }
}

void LegendreFlow::push(const Interval& time) {
  const double dt = time.length();
  if (p_->velocity_stays || !(dt > 0)) return;
  const std::vector<double> seconds = push_seconds(time);
  Components change;
  bool any = false;
  for (int a = 0; a < p_->dimensions; ++a) {
    change[a] = Array::Zero(fluid_->space().scalars());
    const double weight = dt * p_->gravity[a] * p_->weight / box_.half[a];
    if (fluid_->density.size()) change[a] += weight * fluid_->density;
    for (const Array& r : fluid_->others)
      if (r.size() && mixing_ == Mixing::densities) change[a] += weight * r;
    if (fluid_->temperature.size())
      change[a] -= dt * p_->gravity[a] * p_->expansion / box_.half[a] * fluid_->temperature;
    for (std::size_t i = 0; i < push_.size(); ++i)
      if (seconds[i] != 0) change[a] += seconds[i] * pushes_[i].acceleration[a] / box_.half[a] * push_[i];
    any |= !change[a].isZero(0);
  }
  if (any) fluid_->push(change);
}

void LegendreFlow::require_finite() const {
  bool finite = fluid_->velocity.allFinite();
  for (const Array* r : fluid_->carried()) finite &= r->allFinite();
  if (!finite) throw scene::Unstable("coefficients are no longer finite");
}

Vec3 LegendreFlow::velocity(const Point3& x) const {
  const Fluid& fluid = now();
  Vec3 u = Vec3::Zero();
  for (int a = 0; a < p_->dimensions; ++a) u[a] = box_.half[a] * fluid.at(a, box_.inside(x));
  return u;
}

std::vector<Vec3> LegendreFlow::velocities(const std::vector<Point3>& points) const {
  std::vector<Vec3> inside, u(points.size(), Vec3::Zero());
  for (const Point3& x : points) inside.push_back(box_.inside(x));
  for (int a = 0; a < p_->dimensions; ++a) {
    const Array values = box_.half[a] * now().at(a, inside);
    for (std::size_t i = 0; i < u.size(); ++i) u[i][a] = values[Eigen::Index(i)];
  }
  return u;
}

double LegendreFlow::carried_at(const Array& r, const Point3& x) const {
  return r.size() ? value_at(fluid_->space(), r, -1, box_.inside(x)) : 0;
}

scene::Frame LegendreFlow::frame() const {
  scene::Frame f = cells_.frame(now());
  f.density = cells_.values(fluid_->space(), smoke(0));
  for (int k = 1; k <= int(p_->densities.size()); ++k)
    f.densities[scene::density_name(*p_, k)] = cells_.values(fluid_->space(), smoke(k));
  return f;
}

scene::Totals LegendreFlow::totals() const {
  scene::Totals t = totals_of(now(), smoke(0), cells_);
  t.cfl = t.greatest_speed * last_step_ / cells_.size;
  return t;
}

std::map<std::string, double> LegendreFlow::counters() const {
  auto counters = fluid_->counters();
  counters["steps"] = double(steps_);
  counters["coefficients of a scalar"] = fluid_->space().scalars();
  return counters;
}

std::string LegendreFlow::state() const {
  Fluid& fluid = now();
  scene::StateWriter writer(shape());
  Array numbers(5);
  numbers << time_, since_, last_step_, double(equal_steps_), double(steps_);
  for (const Array& a : {numbers, fluid.velocity}) writer.array(a);
  for (const Array* r : fluid.carried()) writer.array(*r);
  return writer.done();
}

void LegendreFlow::restore(const std::string& state) {
  scene::StateReader reader(state, shape());
  const Array numbers = reader.array(), velocity = reader.array();
  std::vector<Array> carried(fluid_->carried().size());
  for (Array& r : carried) r = reader.array();
  reader.done();
  bool alike = numbers.size() == 5 && velocity.size() == fluid_->velocity.size();
  for (std::size_t i = 0; i < carried.size(); ++i) alike &= carried[i].size() == fluid_->carried()[i]->size();
  if (!alike) throw Error("the state is of a flow with other coefficients");
  time_ = numbers[0], since_ = numbers[1], last_step_ = numbers[2];
  equal_steps_ = (long long)(numbers[3]), steps_ = (long long)(numbers[4]);
  fluid_->velocity = velocity;
  for (std::size_t i = 0; i < carried.size(); ++i) *fluid_->carried()[i] = carried[i];
  settle();
}

std::string LegendreFlow::shape() const {
  std::string text = fmt::format("Legendre fluids, {} coefficients along {} axes, {} of velocity", fluid_->space().n(),
                                 p_->dimensions, fluid_->velocity.size());
  for (const Array* r : fluid_->carried()) text += fmt::format(", {} carried", r->size());
  return text;
}

void LegendreFlow::add_time(const std::string& stage, double seconds) {
  const auto at = std::find_if(times_.begin(), times_.end(), [&](const auto& t) { return t.name == stage; });
  if (at == times_.end())
    times_.push_back({stage, seconds});
  else
    at->seconds += seconds;
}

}  // namespace airlight::legendre_fluids
