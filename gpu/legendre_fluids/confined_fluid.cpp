#include "gpu/legendre_fluids/confined_fluid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "scene/flow/flow.h"

namespace airlight::gpu::legendre_fluids {
namespace {

constexpr int lines_of_group = 32, lanes_of_inflow = 128;

}  // namespace

ConfinedFluidOnDevice::ConfinedFluidOnDevice(Context& context, Fluid& fluid, const Material& material,
                                             const ConfinedOptions& options, const Regions& regions,
                                             const std::optional<Wind>& wind)
    : FluidOnDevice(context, fluid),
      space_(fluid.space()),
      material_(material),
      options_(options),
      wind_(wind),
      moves_(material.moves && (!wind || wind->added)),
      velocities_(space_.dimensions()),
      fields_(velocities_ + int(carried_.size())),
      slab_(std::size_t(space_.shape()[1] * space_.shape()[2])),
      size_(std::size_t(space_.n()) * slab_),
      lines_(std::size_t(space_.points_shape()[1] * space_.points_shape()[2])) {
  const Use use(context_);
  Tables tables(space_, options.filter_order);
  std::vector<float> amounts;
  for (const auto* list : {&regions.sources, &regions.pushes})
    for (const Array& region : *list) amounts.insert(amounts.end(), region.data(), region.data() + region.size());
  definitions_ = tables.definitions();
  define("FIELDS", std::size_t(fields_));
  define("MOVES", moves_);
  define("SCALARS", carried_.size());
  define("SOURCES", regions.sources.size());
  define("PUSHES", regions.pushes.size());
  define("CONFINED", 1);
  define("WIND", wind_.has_value());
  if (wind_) {
    calm_.middle = wind_->velocity(Vec3::Zero());
    for (int a = 0; a < velocities_; ++a) calm_.slopes.col(a) = wind_->velocity(Vec3::Unit(a)) - calm_.middle;
  }
  const int n = space_.n();
  slab_group_ = (space_.points_shape()[0] + 7) / 8 * 8;  // a lane for every row and column
  expand_ = &program(context_, "expand", slab_group_, 1, definitions_);
  collect_ = &program(context_, "collect", slab_group_, 1, definitions_);
  points_ = &program(context_, "points", lines_of_group, 1, definitions_);
  columns_ = &program(context_, "columns", lines_of_group, 1, definitions_);
  if (wind_ && !carried_.empty()) inflow_ = &program(context_, "inflow", lanes_of_inflow, 1, definitions_);
  tables_ = std::make_unique<Buffer>(context_, "matrices of the fluid", tables.values());
  regions_ = std::make_unique<Buffer>(context_, "regions of the fluid", amounts);
  const auto floats = [&](const char* name, std::size_t count) {
    return std::make_unique<Buffer>(context_, name, count * sizeof(float), Contents::undefined);
  };
  const std::size_t all = std::size_t(fields_);
  for (auto& state : states_) state = floats("state of the fluid", all * size_);
  rates_ = floats("rates of the fluid", 2 * all * size_);
  pressure_ = floats("pressure", 2 * size_);
  spread_ = floats("slabs of the fluid", all * std::max(size_, 3 * std::size_t(n) * lines_));
  gathered_ = floats("lines of the fluid", all * std::size_t(n) * lines_);
  status_ = std::make_unique<Buffer>(context_, "status of the fluid", 2 * sizeof(unsigned));
  upload(fluid);
  // A step that nobody keeps: drivers that compile what is used first do so now.
  bind();
  run(1e-9, {}, false);
  look();
}

void ConfinedFluidOnDevice::upload(Fluid& fluid) {
  std::vector<float> state;
  for (int a = 0; a < velocities_; ++a) put_field(space_, a, space_.component(fluid.velocity, a), state);
  for (const std::size_t which : carried_) put_field(space_, -1, *fluid.carried()[which], state);
  times_[current_] = fluid.time;
  states_[current_]->upload(state);
}

void ConfinedFluidOnDevice::download(Fluid& fluid) const { take(states_[current_]->download<float>(), fluid); }

void ConfinedFluidOnDevice::take(const std::vector<float>& fields, Fluid& fluid) const {
  airlight::legendre_fluids::Components parts;
  const float* from = fields.data();
  for (int a = 0; a < velocities_; ++a, from += size_) parts[a] = take_field(space_, a, from);
  fluid.velocity = space_.joined(parts);
  for (const std::size_t which : carried_) *fluid.carried()[which] = take_field(space_, -1, from), from += size_;
}

void ConfinedFluidOnDevice::set(Program& p, Fields fields) {
  p.set("first_field", fields.first);
  p.set("per_area", Vec3(space_.half().cwiseAbs2().cwiseInverse()));
}

void ConfinedFluidOnDevice::expand(Fields fields, GoesOn goes_on, bool adds, int stage, double dt, bool begins,
                                   bool ends) {
  Program& p = *expand_;
  set(p, fields);
  states_[begins ? current_ : 1 - current_]->bind(at::start);
  p.set("adds", adds);
  p.set("stage", stage);
  p.set("dt", dt);
  p.set("goes_on", int(goes_on));
  p.set("begins", begins);
  p.set("ends", ends);
  p.dispatch(space_.n() * slab_group_, fields.count);
}

ConfinedFluidOnDevice::LinearWind ConfinedFluidOnDevice::wind_at(double time) const {
  LinearWind wind = calm_;
  if (wind_) wind.middle += std::sin(2 * pi * wind_->frequency * time) * wind_->gust;
  return wind;
}

// The rates at the points, with what the wind at this time brings in.
void ConfinedFluidOnDevice::points(bool measures, double time) {
  const LinearWind wind = wind_at(time);
  points_->set("measures", measures);
  if (wind_) {
    points_->set("wind", wind.middle);
    points_->set("wind_slopes", wind.slopes);
  }
  points_->dispatch(int(lines_));
  if (!inflow_) return;
  inflow_->set("wind", wind.middle);
  inflow_->set("wind_slopes", wind.slopes);
  for (std::size_t r = 0; r < carried_.size(); ++r)
    for (std::size_t side = 0; side < 6; ++side)
      inflow_->set(at_index("incoming", 6 * r + side), wind_->incoming[carried_[r]][side / 2][side % 2]);
  inflow_->dispatch(int(carried_.size()) * lanes_of_inflow);
}

void ConfinedFluidOnDevice::collect(Fields fields, ComesFrom comes_from) {
  Program& p = *collect_;
  const int of_velocity = std::max(0, velocities_ - fields.first);
  p.set("comes_from", int(comes_from));
  p.set("velocity", of_velocity > 0);
  p.set("first_scalar", std::max(fields.first, velocities_));
  p.dispatch(space_.n() * slab_group_, (of_velocity > 0) + fields.count - of_velocity);
}

void ConfinedFluidOnDevice::columns(Fields fields, bool diffuses, double dt) {
  Program& p = *columns_;
  set(p, fields);
  p.set("diffuses", diffuses);
  p.set("velocity_amount", material_.viscosity * dt);
  p.set("carried_amount", material_.diffusivity * dt);
  p.dispatch(int(slab_), diffuses ? fields.count : 1);
}

ConfinedFluidOnDevice::Fields ConfinedFluidOnDevice::diffusing() const {
  const bool velocity = moves_ && material_.viscosity > 0, carried = material_.diffusivity > 0;
  return {velocity ? 0 : velocities_, (velocity ? velocities_ : 0) + (carried ? fields_ - velocities_ : 0)};
}

// From the modes along y and z that expand left; of a velocity up to the pressure that expand adds.
void ConfinedFluidOnDevice::spread_modes_back(Fields fields, double dt) {
  columns(fields, true, dt);
  collect(fields, ComesFrom::modes);
  if (fields.first == 0) columns(fields, false);
}

ConfinedFluidOnDevice::Status ConfinedFluidOnDevice::look() const {
  const std::vector<unsigned> status = status_->download<unsigned>();
  float squared;
  std::memcpy(&squared, &status[0], sizeof squared);
  return {std::sqrt(double(squared)), status[1] == 0};
}

int ConfinedFluidOnDevice::steps_in(double dt, const Status& status) const {
  return airlight::legendre_fluids::runge_kutta_steps(dt, space_.n(), status.speed + (wind_ ? wind_->gust.norm() : 0),
                                                      wind_.has_value());
}

void ConfinedFluidOnDevice::set(const Acting& acting) {
  for (std::size_t i = 0; i < acting.sources.size(); ++i)
    for (std::size_t r = 0; r < carried_.size(); ++r)
      expand_->set(at_index("amounts", i * carried_.size() + r), acting.sources[i][r]);
  for (std::size_t i = 0; i < acting.pushes.size(); ++i) collect_->set(at_index("push_amounts", i), acting.pushes[i]);
  for (std::size_t r = 0; r < carried_.size(); ++r)
    collect_->set(at_index("weights", r), r < acting.weights.size() ? acting.weights[r] : Vec3(Vec3::Zero()));
  for (std::size_t r = 0; r < carried_.size(); ++r)
    expand_->set(at_index("fades", r), r < acting.fades.size() ? acting.fades[r] : 1.0);
}

// Up to the pressure that expand adds.
void ConfinedFluidOnDevice::push() {
  collect({0, velocities_}, ComesFrom::forces);
  columns({0, velocities_}, false);
}

// How long a part of the step may be is asked before its first stage ends, or not at all: then all is one part.
int ConfinedFluidOnDevice::run(double dt, const StepForces& forces, bool looks) {
  const Fields all{0, fields_}, moving = this->moving(), diffusing = this->diffusing();
  const bool any = diffusing.count > 0, viscous = any && diffusing.first == 0;
  const bool pushed = moves_ && pushes(forces.before), pushes_after = moves_ && pushes(forces.after);
  const GoesOn first = any ? GoesOn::to_modes : GoesOn::to_points;
  set(forces.before);
  expand(all, pushed ? GoesOn::nowhere : first, false, -1, 0, true);
  if (pushed) {
    push();
    expand(all, first, true, -1, 0);
  }
  set(forces.after);
  if (any) {
    spread_modes_back(diffusing, 0.5 * dt);
    expand(all, GoesOn::to_points, viscous, -1, 0);
  }
  int parts = 0;
  for (double left = dt; left > 0; ++parts) {
    int steps = 1;
    for (int stage = 0; stage < 4; ++stage) {
      if (looks && stage == 0) status_->clear();
      points(stage == 0, forces.begins + dt - left + (stage == 0 ? 0 : stage == 3 ? 1 : 0.5) * (left / steps));
      if (looks && stage == 0) steps = steps_in(left, look());
      collect(moving, ComesFrom::points);
      if (moves_) columns(moving, false);
      const bool last = steps == 1 && stage == 3;
      const GoesOn next = !last ? GoesOn::to_points : any ? GoesOn::to_modes : GoesOn::nowhere;
      expand(moving, next, true, stage, left / steps, false, last && !any && !pushes_after);
    }
    left = steps > 1 ? left - left / steps : 0;
  }
  if (any) spread_modes_back(diffusing, 0.5 * dt);
  if (pushes_after) push();
  if (any || pushes_after) expand(all, GoesOn::nowhere, viscous || pushes_after, -1, 0, false, true);
  return parts;
}

void ConfinedFluidOnDevice::bind() {
  regions_->bind(at::regions);
  tables_->bind_as(GL_UNIFORM_BUFFER, at::matrices);
  rates_->bind(at::rates);
  pressure_->bind(at::pressure);
  spread_->bind(at::spread);
  gathered_->bind(at::gathered);
  status_->bind(at::status);
  states_[1 - current_]->bind(at::state);
}

void ConfinedFluidOnDevice::project() {
  const Use use(context_);
  bind();
  const Fields velocity{0, velocities_};
  for (std::size_t r = 0; r < carried_.size(); ++r) collect_->set(at_index("weights", r), Vec3(Vec3::Zero()));
  expand({0, fields_}, GoesOn::nowhere, false, -1, 0, true);
  collect(velocity, ComesFrom::forces);
  columns(velocity, false);
  expand(velocity, GoesOn::nowhere, true, -1, 0);
  current_ = 1 - current_;
}

void ConfinedFluidOnDevice::diffuse(double dt) {
  const Use use(context_);
  bind();
  const Fields all{0, fields_};
  expand(all, GoesOn::to_modes, false, -1, 0, true);
  columns(all, true, dt);
  collect(all, ComesFrom::modes);
  current_ = 1 - current_;
}

void ConfinedFluidOnDevice::advect(Fluid& rates) {
  const Use use(context_);
  bind();
  expand({0, fields_}, GoesOn::to_points, false, -1, 0, true);
  points(false, times_[current_]);
  collect(moving(), ComesFrom::points);
  take(rates_->download<float>(), rates);
}

void ConfinedFluidOnDevice::step(double dt, const StepForces& forces) {
  const Use use(context_);
  bind();
  expand_->set("filters_velocity", moves_ ? options_.filter_velocity * dt : 0.0);
  expand_->set("filters_carried", options_.filter_carried * dt);
  // A step is taken to be one part, if the last one was; where the speed then says otherwise it is taken again.
  int parts = run(dt, forces, divides_);
  Status status = look();
  if (!divides_ && steps_in(dt, status) > 1) {
    divides_ = true;
    parts = run(dt, forces, true);
    status = look();
  }
  if (!status.finite) throw scene::Unstable("coefficients are no longer finite");
  context_.check("a step of the fluid");
  substeps_ += parts;
  divides_ = parts > 1;
  current_ = 1 - current_;
  times_[current_] = forces.begins + dt;
}

}  // namespace airlight::gpu::legendre_fluids
