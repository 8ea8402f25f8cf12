#include "reference/stable_fluids/grid_flow.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "reference/stable_fluids/balance.h"
#include "reference/stable_fluids/diffusion.h"
#include "reference/stable_fluids/forces.h"
#include "reference/stable_fluids/frames.h"
#include "reference/stable_fluids/requirements.h"
#include "reference/stable_fluids/totals.h"
#include "scene/base/error.h"
#include "scene/base/saved_state.h"
#include "scene/base/stopwatch.h"
#include "scene/base/threads.h"

namespace airlight::stable_fluids {
namespace {

// A quantity that the flow carries: density or temperature.
template <class Real>
struct Carried {
  Quantity quantity;
  Field<Real> now;
  Diffusion<Real> diffusion;
};

bool carries_density(const scene::FlowProblem& p) {
  bool any = p.density != 0 || p.wave || p.density_grid;
  for (const auto& b : p.blobs) any |= b.density != 0;
  for (const auto& s : p.sources) any |= s.density_rate != 0 || s.density;
  for (const auto& axis : p.sides)
    for (const auto& side : axis) any |= side.density != 0;
  return any;
}

bool carries_temperature(const scene::FlowProblem& p) {
  bool any = p.temperature != 0 || p.temperature_grid;
  for (const auto& b : p.blobs) any |= b.temperature != 0;
  for (const auto& s : p.sources) any |= s.temperature_rate != 0 || s.temperature;
  for (const auto& axis : p.sides)
    for (const auto& side : axis) any |= side.temperature != 0;
  return any;
}

template <class Real>
class GridFlow : public scene::Flow {
 public:
  GridFlow(std::shared_ptr<const scene::FlowProblem> problem, const Plan& plan)
      : problem_(std::move(problem)),
        pushes_(problem_->pushes),
        plan_(plan),
        l_(checked(make_lattice(*problem_, plan.longest))),
        obstacles_(make_obstacles(*problem_, l_)),
        arena_(scene::threads_for(plan.threads)) {
    arena_.execute([&] { begin(); });
  }

  double time() const override { return time_; }

  void step(double dt) override {
    arena_.execute([&] { advance(dt); });
    // Time after equal steps is computed as a product, because a sum would drift.
    if (dt != last_step_) {
      since_ = time_;
      equal_steps_ = 0;
    }
    last_step_ = dt;
    time_ = since_ + double(++equal_steps_) * dt;
    ++steps_;
  }

  void add(const scene::Push& push) override {
    if (problem_->velocity_stays) return scene::Flow::add(push);
    pushes_.push_back(push);
  }

  Vec3 velocity(const Point3& x) const override {
    Vec3 v = Vec3::Zero();
    for (int a = 0; a < l_.dimensions; ++a) v[a] = interpolate(u_[a], l_, (x - l_.low) / l_.h);
    return v;
  }
  double density(const Point3& x) const override { return carried_at(Quantity::density, x); }
  double temperature(const Point3& x) const override { return carried_at(Quantity::temperature, x); }

  scene::DensityField medium(int) const override { return density_grid(l_, find(Quantity::density)); }
  scene::Frame frame() const override { return frame_of(l_, u_, find(Quantity::density), find(Quantity::temperature)); }

  scene::Totals totals() const override {
    scene::Totals t;
    arena_.execute([&] {
      const Field<Real>* density = find(Quantity::density);
      t = totals_of(u_, density, l_, obstacles_);
    });
    t.cfl = t.greatest_speed * last_step_ / l_.h;
    return t;
  }

  std::vector<scene::StageTime> times() const override { return times_; }
  std::map<std::string, double> counters() const override {
    return {{"steps", double(steps_)},
            {"cells", double(count_of(l_.n))},
            {"solid cells", double(obstacles_.count)},
            {"pressure iterations", double(iterations_)},
            {"diffusion iterations", double(iterations_of_diffusion_)},
            {"greatest pressure residual", residual_}};
  }

  std::string state() const override {
    std::size_t numbers = 0;
    for (int a = 0; a < l_.dimensions; ++a) numbers += u_[a].values.size();
    for (const Carried<Real>& c : carried_) numbers += c.now.values.size();
    scene::StateWriter writer(shape(), numbers * sizeof(Real));
    for (const double value : {time_, since_, last_step_, double(equal_steps_), double(steps_)}) writer.number(value);
    for (int a = 0; a < l_.dimensions; ++a) writer.values(u_[a].values);
    for (const Carried<Real>& c : carried_) writer.values(c.now.values);
    return writer.done();
  }
  void restore(const std::string& state) override {
    scene::StateReader reader(state, shape());
    for (double* value : {&time_, &since_, &last_step_}) *value = reader.number();
    for (long long* value : {&equal_steps_, &steps_}) *value = (long long)(reader.number());
    for (int a = 0; a < l_.dimensions; ++a) reader.values(u_[a].values);
    for (Carried<Real>& c : carried_) reader.values(c.now.values);
    reader.done();
  }

 private:
  const Lattice& checked(const Lattice& l) const {
    require_memory(l, sizeof(Real));
    require_samples(*problem_, l);
    return l;
  }

  std::string shape() const {
    return fmt::format("stable fluids, {} x {} x {} cells, {} bytes a number, {} fields carried", l_.n[0], l_.n[1],
                       l_.n[2], sizeof(Real), carried_.size());
  }

  void begin() {
    projection_.emplace(l_, obstacles_, plan_.pressure, plan_.tolerance, plan_.iterations);
    balance_.emplace(l_, obstacles_, projection_->parts());
    for (int a = 0; a < l_.dimensions; ++a) {
      u_[a] = Field<Real>(l_, a);
      each_sample(u_[a], [&](const Point3& x) { return scene::start_velocity(*problem_, a, x); });
      diffusion_.emplace_back(l_, obstacles_, a, plan_.tolerance, plan_.iterations);
    }
    advected_ = u_;
    hold_velocities(*problem_, l_, 0, u_);
    settle();
    if (!problem_->velocity_stays) project();
    const auto carry = [&](Quantity quantity, auto value) {
      carried_.push_back({quantity, Field<Real>(l_, at_centers),
                          Diffusion<Real>(l_, obstacles_, at_centers, plan_.tolerance, plan_.iterations)});
      Field<Real>& field = carried_.back().now;
      each_sample(field, [&](const Point3& x) { return value(*problem_, x); });
      if (obstacles_.any())
        for_rows(l_.n, [&](int j, int k) {
          for (int i = 0; i < l_.n[0]; ++i)
            if (obstacles_.solid.at(i, j, k)) field.at(i, j, k) = 0;
        });
      fill_ghosts(field, quantity, l_, Walls::carried);
    };
    carried_.reserve(2);
    if (carries_density(*problem_)) carry(Quantity::density, scene::start_density);
    if (carries_temperature(*problem_)) carry(Quantity::temperature, scene::start_temperature);
    if (!carried_.empty()) center_ = Field<Real>(l_, at_centers);
  }

  template <class Value>
  void each_sample(Field<Real>& field, const Value& value) {
    for_rows(field.n, [&](int j, int k) {
      for (int i = 0; i < field.n[0]; ++i) field.at(i, j, k) = Real(value(field.position(l_, i, j, k)));
    });
  }

  // Ghosts, walls and obstacles of the velocity.
  void settle() {
    for (int a = 0; a < l_.dimensions; ++a) {
      stop_at_obstacles(obstacles_, u_[a]);
      fill_ghosts(u_[a], Quantity::velocity, l_);
    }
  }

  void project() {
    const ProjectionReport report = (*projection_)(u_);
    iterations_ += report.iterations;
    residual_ = std::max(residual_, report.residual);
    settle();
    // The residual divergence by rounding in float grows with the cells along an axis. A second projection reduces it.
    constexpr double most = 1e-5;
    if (sizeof(Real) == sizeof(double) || plan_.pressure != PressureSolver::transforms) return;
    if (greatest_divergence(u_, l_, obstacles_) <= most * greatest_speed(u_)) return;
    (*projection_)(u_);
    settle();
  }

  // The order of the paper (section 2.2), forces first.
  void advance(double dt) {
    for (Carried<Real>& c : carried_) {
      timed("sources", [&] { add_sources(*problem_, l_, time_, dt, c.quantity, c.now); });
      fill_ghosts(c.now, c.quantity, l_, Walls::carried);
    }
    if (!problem_->velocity_stays) {
      timed("forces", [&] {
        add_forces(dt);
        require_finite();  // limiters would swallow what is not
      });
      if (plan_.project_twice) timed("projection", [&] { project(); });
      timed("advection of velocity", [&] {
        for (int a = 0; a < l_.dimensions; ++a)
          advect(plan_.advection, l_, obstacles_, u_, dt, Quantity::velocity, u_[a], advected_[a], work_);
        std::swap(u_, advected_);
        balance_->add_deferred(u_);
        settle();
      });
      if (problem_->viscosity > 0)
        timed("viscosity", [&] {
          for (int a = 0; a < l_.dimensions; ++a)
            iterations_of_diffusion_ += diffusion_[a](u_[a], Quantity::velocity, problem_->viscosity * dt);
        });
      timed("projection", [&] {
        hold_velocities(*problem_, l_, time_, u_);
        settle();
        project();
        require_finite();
      });
    }
    for (Carried<Real>& c : carried_) carry(c, dt);
  }

  void add_forces(double dt) {
    const Field<Real>* density = problem_->weight != 0 ? find(Quantity::density) : nullptr;
    const Field<Real>* temperature = problem_->expansion != 0 ? find(Quantity::temperature) : nullptr;
    const auto acts_along = [&](int axis) {
      bool any = (density || temperature) && problem_->gravity[axis] != 0;
      for (const scene::Push& push : pushes_)
        any |= push.acceleration[axis] != 0 && !intersect(push.time, {time_, time_ + dt}).empty();
      return any;
    };
    Velocity<Real>& change = advected_;  // not used before the advection
    for (int a = 0; a < l_.dimensions; ++a)
      if (acts_along(a)) std::fill(change[a].values.begin(), change[a].values.end(), Real(0));
    if (density || temperature)
      add_buoyancy(density ? problem_->weight : 0, temperature ? problem_->expansion : 0, problem_->gravity, l_,
                   density ? *density : *temperature, temperature ? *temperature : *density, dt, change);
    add_pushes(pushes_, l_, time_, dt, change);
    for (int a = 0; a < l_.dimensions; ++a)
      if (acts_along(a)) balance_->add(change[a], u_[a]);
    add_confinement(problem_->confinement, l_, obstacles_, dt, u_);
    settle();
  }

  void carry(Carried<Real>& c, double dt) {
    timed("advection of what is carried", [&] {
      advect(plan_.advection, l_, obstacles_, u_, dt, c.quantity, c.now, center_, work_);
      std::swap(c.now.values, center_.values);
    });
    if (problem_->diffusivity > 0)
      timed("diffusion",
            [&] { iterations_of_diffusion_ += c.diffusion(c.now, c.quantity, problem_->diffusivity * dt); });
    if (problem_->decay > 0) {
      const Real factor = Real(std::exp(-problem_->decay * dt));
      for_rows(c.now.n, [&](int j, int k) {
        for (Real* v = c.now.row(j, k); v != c.now.row(j, k) + c.now.n[0]; ++v) *v *= factor;
      });
    }
    fill_ghosts(c.now, c.quantity, l_, Walls::carried);
  }

  void require_finite() const {
    const std::string what = what_is_not_finite(u_, l_);
    if (!what.empty()) throw scene::Unstable(fmt::format("step {}, t = {:.6g} s: {}", steps_ + 1, time_, what));
  }

  const Field<Real>* find(Quantity quantity) const {
    for (const Carried<Real>& c : carried_)
      if (c.quantity == quantity) return &c.now;
    return nullptr;
  }
  double carried_at(Quantity quantity, const Point3& x) const {
    const Field<Real>* field = find(quantity);
    return field ? interpolate(*field, l_, (x - l_.low) / l_.h) : 0;
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

  std::shared_ptr<const scene::FlowProblem> problem_;
  std::vector<scene::Push> pushes_;  // the problem's, and those that were added
  Plan plan_;
  Lattice l_;
  Obstacles obstacles_;
  mutable tbb::task_arena arena_;
  std::optional<Projection<Real>> projection_;
  std::optional<Balance<Real>> balance_;
  std::vector<Diffusion<Real>> diffusion_;
  Velocity<Real> u_, advected_;
  std::vector<Carried<Real>> carried_;
  Field<Real> center_;
  Workspace<Real> work_;
  double time_ = 0, since_ = 0, last_step_ = 0, residual_ = 0;
  long long steps_ = 0, equal_steps_ = 0, iterations_ = 0, iterations_of_diffusion_ = 0;
  std::vector<scene::StageTime> times_;
};

}  // namespace

std::unique_ptr<scene::Flow> start_float(std::shared_ptr<const scene::FlowProblem> problem, const Plan& plan) {
  return std::make_unique<GridFlow<float>>(std::move(problem), plan);
}
std::unique_ptr<scene::Flow> start_double(std::shared_ptr<const scene::FlowProblem> problem, const Plan& plan) {
  return std::make_unique<GridFlow<double>>(std::move(problem), plan);
}

}  // namespace airlight::stable_fluids
