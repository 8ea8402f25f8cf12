#include "methods/legendre_fluids/legendre_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/legendre_fluids/saved_state.h"
#include "scene/stopwatch.h"

namespace airlight::legendre_fluids {

using scene::FlowProblem;

ReferenceBox::ReferenceBox(const FlowProblem& p)
    : half(0.5 * p.box.size()), center(0.5 * (p.box.lo + p.box.hi)), dimensions(p.dimensions) {
  if (dimensions == 2) half[2] = 1;
}

Vec3 ReferenceBox::inside(const Point3& x) const {
  Vec3 result = (x - center).cwiseQuotient(half).cwiseMax(-1).cwiseMin(1);
  if (dimensions == 2) result[2] = 0;
  return result;
}

bool carries_density(const FlowProblem& p) {
  bool any = p.density != 0 || p.wave || p.density_grid;
  for (const auto& b : p.blobs) any |= b.density != 0;
  for (const auto& s : p.sources) any |= s.density_rate != 0;
  for (const auto& axis : p.sides)
    for (const auto& side : axis) any |= side.density != 0;
  return any;
}

bool carries_temperature(const FlowProblem& p) {
  bool any = p.temperature != 0 || p.temperature_grid;
  for (const auto& b : p.blobs) any |= b.temperature != 0;
  for (const auto& s : p.sources) any |= s.temperature_rate != 0;
  for (const auto& axis : p.sides)
    for (const auto& side : axis) any |= side.temperature != 0;
  return any;
}

namespace {

// Coefficients of 1 inside a region and 0 outside, each axis times Lanczos factors: what is cut off leaves no waves behind.
Array region_coefficients(const FlowProblem& p, const ConfinedSpace& space, const ReferenceBox& box,
                          const scene::Region& region, const std::string& what) {
  Array c = space.scalar_from_function(
      [&](const Vec3& x) { return scene::contains(region, box.outside(x)) ? 1.0 : 0.0; }, 4 * space.n() + 32);
  if (!(c[0] > 0))
    throw Error(fmt::format("{}: the region of {} holds none of {} points along each axis, expected a larger one",
                            p.file, what, 4 * space.n() + 32));
  const TensorShape s = space.shape();
  const auto lanczos = [&](int k) {
    const double x = pi * k / space.n();
    return k == 0 ? 1 : std::sin(x) / x;
  };
  int at = 0;
  for (int i = 0; i < s[0]; ++i)
    for (int j = 0; j < s[1]; ++j)
      for (int k = 0; k < s[2]; ++k) c[at++] *= lanczos(i) * lanczos(j) * lanczos(k);
  return c;
}

class LegendreFlow : public scene::Flow {
 public:
  LegendreFlow(std::shared_ptr<const FlowProblem> problem, std::unique_ptr<Fluid> fluid, int cells)
      : p_(std::move(problem)), box_(*p_), fluid_(std::move(fluid)) {
    cell_ = p_->box.size().maxCoeff() / cells;
    for (int a = 0; a < p_->dimensions; ++a) n_[a] = std::max(1, int(std::lround(2 * box_.half[a] / cell_)));
    begin();
  }

  double time() const override { return time_; }

  void step(double dt) override {
    timed("sources", [&] { add_sources(dt); });
    timed("fluid", [&] {
      try {
        fluid_->step(dt);
      } catch (const scene::Unstable& e) {
        throw scene::Unstable(fmt::format("step {}, t = {:.6g} s: {}", steps_ + 1, time_, e.what()));
      }
    });
    if (!p_->velocity_stays) timed("forces", [&] { push(dt); });
    for (Array* r : {&fluid_->density, &fluid_->temperature})
      if (p_->decay > 0) *r *= std::exp(-p_->decay * dt);
    require_finite();
    // Of equal steps a product, not a sum that drifts.
    if (dt != last_step_) since_ = time_, equal_steps_ = 0;
    last_step_ = dt;
    time_ = since_ + ++equal_steps_ * dt;
    ++steps_;
  }

  Vec3 velocity(const Point3& x) const override {
    Vec3 u = Vec3::Zero();
    for (int a = 0; a < p_->dimensions; ++a) u[a] = box_.half[a] * fluid_->at(a, box_.inside(x));
    return u;
  }
  double density(const Point3& x) const override { return carried_at(fluid_->density, x); }
  double temperature(const Point3& x) const override { return carried_at(fluid_->temperature, x); }

  scene::DensityField medium() const override {
    auto grid = std::make_shared<scene::VoxelGrid>();
    grid->size = n_;
    grid->voxel_size = cell_;
    grid->translation = low() + 0.5 * cell_ * Vec3::Ones();
    if (p_->dimensions == 2) grid->translation[2] = 0;
    grid->values = by_cell(fluid_->density);
    grid->values.resize(std::size_t(n_.prod()), 0.0f);
    for (float& value : grid->values) value = std::max(0.0f, value);
    return scene::GridPointer(grid);
  }

  scene::Frame frame() const override {
    scene::Frame f;
    f.size = n_;
    f.cell = cell_;
    f.low = low();
    f.density = by_cell(fluid_->density);
    f.temperature = by_cell(fluid_->temperature);
    const int nx = n_[0] + 1, ny = n_[1] + 1;
    f.velocity.assign(3 * std::size_t(nx) * ny * (n_[2] + 1), 0.0f);
    for (int a = 0; a < p_->dimensions; ++a) {
      const Components at = lattice(a);
      const Array u = box_.half[a] * fluid_->sampled(a, at);
      Eigen::Index from = 0;
      for (int i = 0; i < at[0].size(); ++i)
        for (int j = 0; j < at[1].size(); ++j)
          for (int k = 0; k < (p_->dimensions == 3 ? at[2].size() : 1); ++k)
            f.velocity[3 * (i + std::size_t(nx) * (j + std::size_t(ny) * k)) + a] = float(u[from++]);
    }
    return f;
  }

  scene::Totals totals() const override;

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
    for (const Array& a : {numbers, fluid_->velocity, fluid_->density, fluid_->temperature, fluid_->history()})
      writer.array(a);
    return writer.done();
  }
  void restore(const std::string& state) override {
    StateReader reader(state, shape());
    const Array numbers = reader.array(), velocity = reader.array(), density = reader.array(),
                temperature = reader.array(), history = reader.array();
    reader.done();
    if (numbers.size() != 5 || velocity.size() != fluid_->velocity.size() || density.size() != fluid_->density.size() ||
        temperature.size() != fluid_->temperature.size())
      throw Error("the state is of a flow with other coefficients");
    time_ = numbers[0], since_ = numbers[1], last_step_ = numbers[2];
    equal_steps_ = (long long)(numbers[3]), steps_ = (long long)(numbers[4]);
    fluid_->velocity = velocity, fluid_->density = density, fluid_->temperature = temperature;
    fluid_->set_history(history);
  }

 private:
  void begin() {
    const ConfinedSpace& space = fluid_->space();
    fluid_->begin([&](int a, const Vec3& x) { return scene::start_velocity(*p_, a, box_.outside(x)) / box_.half[a]; });
    if (carries_density(*p_))
      fluid_->density =
          space.scalar_from_function([&](const Vec3& x) { return scene::start_density(*p_, box_.outside(x)); });
    if (carries_temperature(*p_))
      fluid_->temperature =
          space.scalar_from_function([&](const Vec3& x) { return scene::start_temperature(*p_, box_.outside(x)); });
    for (std::size_t i = 0; i < p_->sources.size(); ++i)
      source_.push_back(region_coefficients(*p_, space, box_, p_->sources[i].region, fmt::format("source {}", i)));
    for (std::size_t i = 0; i < p_->pushes.size(); ++i)
      push_.push_back(region_coefficients(*p_, space, box_, p_->pushes[i].region, fmt::format("force {}", i)));
  }

  void add_sources(double dt) {
    for (std::size_t i = 0; i < source_.size(); ++i) {
      const scene::Source& s = p_->sources[i];
      const Interval part = intersect(s.time, {time_, time_ + dt});
      if (part.empty()) continue;
      if (s.density_rate != 0) fluid_->density += part.length() * s.density_rate * source_[i];
      if (s.temperature_rate != 0) fluid_->temperature += part.length() * s.temperature_rate * source_[i];
    }
  }

  void push(double dt) {
    Components change;
    bool any = false;
    for (int a = 0; a < p_->dimensions; ++a) {
      change[a] = Array::Zero(fluid_->space().scalars());
      if (fluid_->density.size()) change[a] += dt * p_->gravity[a] * p_->weight / box_.half[a] * fluid_->density;
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
    for (const Array* a : {&fluid_->velocity, &fluid_->density, &fluid_->temperature})
      if (!a->allFinite())
        throw scene::Unstable(
            fmt::format("step {}, t = {:.6g} s: coefficients are no longer finite", steps_ + 1, time_));
  }

  Point3 low() const { return p_->box.lo; }
  double carried_at(const Array& r, const Point3& x) const {
    return r.size() ? value_at(fluid_->space(), r, -1, box_.inside(x)) : 0;
  }

  // Centres of cells, along one axis their faces, in the reference box.
  Components lattice(int faces = -1) const {
    Components at;
    for (int a = 0; a < p_->dimensions; ++a) {
      const int count = n_[a] + (a == faces);
      at[a].resize(count);
      for (int i = 0; i < count; ++i)
        at[a][i] = std::clamp((i + (a == faces ? 0 : 0.5)) * cell_ / box_.half[a] - 1, -1.0, 1.0);
    }
    return at;
  }

  // x fastest.
  std::vector<float> by_cell(const Array& r) const {
    if (!r.size()) return {};
    const Array values = fluid_->space().scalar_sampled(r, lattice());
    std::vector<float> result(std::size_t(values.size()));
    Eigen::Index from = 0;
    for (int i = 0; i < n_[0]; ++i)
      for (int j = 0; j < n_[1]; ++j)
        for (int k = 0; k < n_[2]; ++k)
          result[i + std::size_t(n_[0]) * (j + std::size_t(n_[1]) * k)] = float(values[from++]);
    return result;
  }

  std::string shape() const {
    return fmt::format(
        "Legendre fluids, {} coefficients along {} axes, {} of velocity, {} of density, {} of temperature",
        fluid_->space().n(), p_->dimensions, fluid_->velocity.size(), fluid_->density.size(),
        fluid_->temperature.size());
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
  std::vector<Array> source_, push_;
  double cell_ = 1;
  Eigen::Vector3i n_ = Eigen::Vector3i::Ones();
  double time_ = 0, since_ = 0, last_step_ = 0;
  long long steps_ = 0, equal_steps_ = 0;
  std::vector<scene::StageTime> times_;
};

// Sums are integrals of polynomials, exact; extremes are those of the cells' centres.
scene::Totals LegendreFlow::totals() const {
  scene::Totals t;
  const ConfinedSpace& space = fluid_->space();
  const int d = p_->dimensions;
  const double volume = box_.half.head(d).prod();
  t.energy = fluid_->energy();
  t.center_of_mass = box_.center;
  const Components at = lattice(), points{space.nodes(), space.nodes(), space.nodes()};
  if (fluid_->density.size()) {
    const Array values = space.scalar_sampled(fluid_->density, at);
    t.density_least = values.minCoeff(), t.density_greatest = values.maxCoeff();
    t.mass = volume * std::pow(std::sqrt(2.0), d) * fluid_->density[0];
    const TensorShape s = space.shape();
    const std::array<int, 3> first{s[1] * s[2], s[2], 1};
    for (int a = 0; a < d && t.mass > 0 && space.n() > 1; ++a)
      t.center_of_mass[a] += box_.half[a] * fluid_->density[first[a]] / (std::sqrt(3.0) * fluid_->density[0]);
  }
  for (int a = 0; a < d; ++a)
    t.greatest_speed = std::max(t.greatest_speed, box_.half[a] * fluid_->sampled(a, at).cwiseAbs().maxCoeff());
  // d u_a / d x_b [1/s], u in half boxes a second.
  const auto slope = [&](int a, int b) -> Array {
    return box_.half[a] / box_.half[b] * fluid_->sampled_slope(a, b, points);
  };
  Array divergence = slope(0, 0), curl2 = (slope(1, 0) - slope(0, 1)).cwiseAbs2();
  for (int a = 1; a < d; ++a) divergence += slope(a, a);
  if (d == 3) curl2 += (slope(2, 1) - slope(1, 2)).cwiseAbs2() + (slope(0, 2) - slope(2, 0)).cwiseAbs2();
  const Array& w = space.weights();
  const TensorShape s = space.points_shape();
  int k = 0;
  for (int i = 0; i < s[0]; ++i)
    for (int j = 0; j < s[1]; ++j)
      for (int l = 0; l < s[2]; ++l) t.enstrophy += 0.5 * volume * w[i] * w[j] * (d == 3 ? w[l] : 1) * curl2[k++];
  if (t.greatest_speed > 0) t.divergence = divergence.cwiseAbs().maxCoeff() * cell_ / t.greatest_speed;
  t.cfl = t.greatest_speed * last_step_ / cell_;
  return t;
}

}  // namespace

std::unique_ptr<scene::Flow> start_flow(std::shared_ptr<const FlowProblem> problem, std::unique_ptr<Fluid> fluid,
                                        int cells) {
  return std::make_unique<LegendreFlow>(std::move(problem), std::move(fluid), cells);
}

}  // namespace airlight::legendre_fluids
