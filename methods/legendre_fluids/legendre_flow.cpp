#include "methods/legendre_fluids/legendre_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/legendre_fluids/cells.h"
#include "methods/legendre_fluids/saved_state.h"
#include "scene/stopwatch.h"

namespace airlight::legendre_fluids {

using scene::FlowProblem;

namespace {

class LegendreFlow : public scene::Flow {
 public:
  LegendreFlow(std::shared_ptr<const FlowProblem> problem, std::unique_ptr<Fluid> fluid, int cells, Mixing mixing)
      : p_(std::move(problem)), box_(*p_), fluid_(std::move(fluid)), cells_(box_, p_->box.lo, cells), mixing_(mixing) {
    begin();
  }

  double time() const override { return time_; }

  void step(double dt) override {
    try {
      timed("sources", [&] { add_sources(dt); });
      timed("advection and diffusion", [&] { fluid_->advance(dt); });
      if (!p_->velocity_stays) timed("forces", [&] { push(dt); });
      timed("projection and filter", [&] { fluid_->finish(dt); });
      require_finite();
    } catch (const scene::Unstable& e) {
      throw scene::Unstable(fmt::format("step {}, t = {:.6g} s: {}", steps_ + 1, time_, e.what()));
    }
    if (p_->decay > 0) fade(fluid_->faded(p_->decay * dt));
    // Of equal steps a product, not a sum that drifts.
    if (dt != last_step_) since_ = time_, equal_steps_ = 0;
    last_step_ = dt;
    time_ = since_ + ++equal_steps_ * dt;
    ++steps_;
    settle();
  }

  Vec3 velocity(const Point3& x) const override {
    Vec3 u = Vec3::Zero();
    for (int a = 0; a < p_->dimensions; ++a) u[a] = box_.half[a] * fluid_->at(a, box_.inside(x));
    return u;
  }
  double density(const Point3& x) const override { return carried_at(smoke(0), x); }
  double temperature(const Point3& x) const override { return carried_at(fluid_->temperature, x); }

  scene::DensityField medium(int density) const override { return cells_.medium(fluid_->space(), smoke(density)); }
  scene::Frame frame() const override {
    scene::Frame f = cells_.frame(*fluid_);
    f.density = cells_.values(fluid_->space(), smoke(0));
    for (int k = 1; k <= int(p_->densities.size()); ++k)
      f.densities[scene::density_name(*p_, k)] = cells_.values(fluid_->space(), smoke(k));
    return f;
  }
  scene::Totals totals() const override {
    scene::Totals t = totals_of(*fluid_, smoke(0), cells_);
    t.cfl = t.greatest_speed * last_step_ / cells_.size;
    return t;
  }

  std::vector<scene::StageTime> times() const override { return times_; }
  std::map<std::string, double> counters() const override {
    auto counters = fluid_->counters();
    counters["steps"] = double(steps_);
    counters["coefficients of a scalar"] = fluid_->space().scalars();
    return counters;
  }

  std::string state() const override {
    StateWriter writer(shape());
    Array numbers(5);
    numbers << time_, since_, last_step_, double(equal_steps_), double(steps_);
    for (const Array& a : {numbers, fluid_->velocity, fluid_->history()}) writer.array(a);
    for (const Array* r : fluid_->carried()) writer.array(*r);
    return writer.done();
  }
  void restore(const std::string& state) override {
    StateReader reader(state, shape());
    const Array numbers = reader.array(), velocity = reader.array(), history = reader.array();
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
    fluid_->set_history(history);
    settle();
  }

 private:
  void begin() {
    const ConfinedSpace& space = fluid_->space();
    fluid_->begin([&](int a, const Vec3& x) { return scene::start_velocity(*p_, a, box_.outside(x)) / box_.half[a]; });
    begin_densities();
    if (carries_temperature(*p_))
      fluid_->temperature =
          space.scalar_from_function([&](const Vec3& x) { return scene::start_temperature(*p_, box_.outside(x)); });
    for (std::size_t i = 0; i < p_->sources.size(); ++i)
      source_.push_back(region_coefficients(*p_, space, box_, p_->sources[i].region, fmt::format("source {}", i)));
    for (std::size_t i = 0; i < p_->pushes.size(); ++i)
      push_.push_back(region_coefficients(*p_, space, box_, p_->pushes[i].region, fmt::format("force {}", i)));
    settle();
  }

  void begin_densities() {
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

  // The time of its wind, and the densities that the share of an albedo stands for.
  void settle() {
    fluid_->time = time_;
    if (mixing_ != Mixing::albedo) return;
    const ConfinedSpace& space = fluid_->space();
    products_[0] = scene::legendre_product(fluid_->density, space.shape(), fluid_->others[0], space.shape(),
                                           space.shape(), space.dimensions());
    products_[1] = fluid_->density - products_[0];
  }
  const Array& smoke(int which) const {
    if (mixing_ == Mixing::albedo) return products_.at(std::size_t(which));
    return which == 0 ? fluid_->density : fluid_->others.at(std::size_t(which) - 1);
  }

  void fade(double factor) {
    fluid_->density *= factor;
    fluid_->temperature *= factor;
    for (Array& r : fluid_->others)
      if (mixing_ == Mixing::densities) r *= factor;
  }

  void add_sources(double dt) {
    for (std::size_t i = 0; i < source_.size(); ++i) {
      const scene::Source& s = p_->sources[i];
      const Interval part = intersect(s.time, {time_, time_ + dt});
      if (part.empty()) continue;
      Array& density = s.of == 0 ? fluid_->density : fluid_->others[std::size_t(s.of) - 1];
      if (s.density_rate != 0) density += part.length() * s.density_rate * source_[i];
      if (s.temperature_rate != 0) fluid_->temperature += part.length() * s.temperature_rate * source_[i];
    }
  }

  void push(double dt) {
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
      for (std::size_t i = 0; i < push_.size(); ++i) {
        const scene::Push& force = p_->pushes[i];
        const Interval part = intersect(force.time, {time_, time_ + dt});
        if (part.empty()) continue;
        // The integral of cos(2 pi f t) over the part of the step.
        const double w = 2 * pi * force.frequency;
        const double seconds = w > 0 ? (std::sin(w * part.hi) - std::sin(w * part.lo)) / w : part.length();
        change[a] += seconds * force.acceleration[a] / box_.half[a] * push_[i];
      }
      any |= !change[a].isZero(0);
    }
    if (any) fluid_->push(change);
  }

  void require_finite() const {
    bool finite = fluid_->velocity.allFinite();
    for (const Array* r : fluid_->carried()) finite &= r->allFinite();
    if (!finite) throw scene::Unstable("coefficients are no longer finite");
  }

  double carried_at(const Array& r, const Point3& x) const {
    return r.size() ? value_at(fluid_->space(), r, -1, box_.inside(x)) : 0;
  }

  std::string shape() const {
    std::string text = fmt::format("Legendre fluids, {} coefficients along {} axes, {} of velocity",
                                   fluid_->space().n(), p_->dimensions, fluid_->velocity.size());
    for (const Array* r : fluid_->carried()) text += fmt::format(", {} carried", r->size());
    return text;
  }

  template <class Body>
  void timed(const std::string& stage, const Body& body) {
    scene::Stopwatch watch;
    body();
    const double seconds = watch.lap();
    const auto at = std::find_if(times_.begin(), times_.end(), [&](const auto& t) { return t.name == stage; });
    if (at == times_.end())
      times_.push_back({stage, seconds});
    else
      at->seconds += seconds;
  }

  std::shared_ptr<const FlowProblem> p_;
  ReferenceBox box_;
  std::unique_ptr<Fluid> fluid_;
  Cells cells_;
  Mixing mixing_;
  std::array<Array, 2> products_;
  std::vector<Array> source_, push_;
  double time_ = 0, since_ = 0, last_step_ = 0;
  long long steps_ = 0, equal_steps_ = 0;
  std::vector<scene::StageTime> times_;
};

}  // namespace

std::unique_ptr<scene::Flow> start_flow(std::shared_ptr<const FlowProblem> problem, std::unique_ptr<Fluid> fluid,
                                        int cells, Mixing mixing) {
  return std::make_unique<LegendreFlow>(std::move(problem), std::move(fluid), cells, mixing);
}

}  // namespace airlight::legendre_fluids
