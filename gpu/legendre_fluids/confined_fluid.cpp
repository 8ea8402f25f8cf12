#include "gpu/legendre_fluids/confined_fluid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "scene/flow/flow.h"

namespace airlight::gpu::legendre_fluids {
namespace {

constexpr int lines_of_group = 32;

std::string indexed(const char* name, std::size_t i) { return fmt::format("{}[{}]", name, i); }

std::vector<std::size_t> carried_by(Fluid& fluid) {
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < fluid.carried().size(); ++i)
    if (fluid.carried()[i]->size() > 0) which.push_back(i);
  return which;
}

}  // namespace

FluidOnDevice::FluidOnDevice(Context& context, Fluid& fluid, const Material& material, const ConfinedOptions& options,
                             const Regions& regions)
    : context_(context),
      space_(fluid.space()),
      material_(material),
      options_(options),
      moves_(material.moves),
      carried_(carried_by(fluid)),
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
  Definitions definitions = tables.definitions();
  const auto number = [&](const char* name, std::size_t value) { definitions[name] = std::to_string(value); };
  number("FIELDS", std::size_t(fields_));
  number("MOVES", moves_);
  number("SCALARS", carried_.size());
  number("SOURCES", regions.sources.size());
  number("PUSHES", regions.pushes.size());
  definitions_ = definitions;
  const int n = space_.n();
  slab_group_ = (space_.points_shape()[0] + 7) / 8 * 8;  // a lane for every row and column
  expand_ = &program(context_, "expand", slab_group_, 1, definitions);
  collect_ = &program(context_, "collect", slab_group_, 1, definitions);
  points_ = &program(context_, "points", lines_of_group, 1, definitions);
  columns_ = &program(context_, "columns", lines_of_group, 1, definitions);
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

void FluidOnDevice::upload(Fluid& fluid) {
  std::vector<float> state;
  for (int a = 0; a < velocities_; ++a) put_field(space_, a, space_.component(fluid.velocity, a), state);
  for (const std::size_t which : carried_) put_field(space_, -1, *fluid.carried()[which], state);
  states_[current_]->upload(state);
}

void FluidOnDevice::download(Fluid& fluid) const { take(states_[current_]->download<float>(), fluid); }

void FluidOnDevice::take(const std::vector<float>& fields, Fluid& fluid) const {
  airlight::legendre_fluids::Components parts;
  const float* from = fields.data();
  for (int a = 0; a < velocities_; ++a, from += size_) parts[a] = take_field(space_, a, from);
  fluid.velocity = space_.joined(parts);
  for (const std::size_t which : carried_) *fluid.carried()[which] = take_field(space_, -1, from), from += size_;
}

void FluidOnDevice::set(Program& p, Fields fields) {
  p.set("first_field", fields.first);
  p.set("per_area", Vec3(space_.half().cwiseAbs2().cwiseInverse()));
}

void FluidOnDevice::expand(Fields fields, GoesOn goes_on, bool adds, int stage, double dt, bool begins, bool ends) {
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

void FluidOnDevice::points(bool measures) {
  points_->set("measures", measures);
  points_->dispatch(int(lines_));
}

void FluidOnDevice::collect(Fields fields, ComesFrom comes_from) {
  Program& p = *collect_;
  const int of_velocity = std::max(0, velocities_ - fields.first);
  p.set("comes_from", int(comes_from));
  p.set("velocity", of_velocity > 0);
  p.set("first_scalar", std::max(fields.first, velocities_));
  p.dispatch(space_.n() * slab_group_, (of_velocity > 0) + fields.count - of_velocity);
}

void FluidOnDevice::columns(Fields fields, bool diffuses, double dt) {
  Program& p = *columns_;
  set(p, fields);
  p.set("diffuses", diffuses);
  p.set("velocity_amount", material_.viscosity * dt);
  p.set("carried_amount", material_.diffusivity * dt);
  p.dispatch(int(slab_), diffuses ? fields.count : 1);
}

FluidOnDevice::Fields FluidOnDevice::diffusing() const {
  const bool velocity = moves_ && material_.viscosity > 0, carried = material_.diffusivity > 0;
  return {velocity ? 0 : velocities_, (velocity ? velocities_ : 0) + (carried ? fields_ - velocities_ : 0)};
}

// From the modes along y and z that expand left; of a velocity up to the pressure that expand adds.
void FluidOnDevice::spread_modes_back(Fields fields, double dt) {
  columns(fields, true, dt);
  collect(fields, ComesFrom::modes);
  if (fields.first == 0) columns(fields, false);
}

FluidOnDevice::Status FluidOnDevice::look() const {
  const std::vector<unsigned> status = status_->download<unsigned>();
  float squared;
  std::memcpy(&squared, &status[0], sizeof squared);
  return {std::sqrt(double(squared)), status[1] == 0};
}

int FluidOnDevice::steps_in(double dt, const Status& status) const {
  return airlight::legendre_fluids::runge_kutta_steps(dt, space_.n(), status.speed, false);
}

void FluidOnDevice::set(const Acting& acting) {
  for (std::size_t i = 0; i < acting.sources.size(); ++i)
    for (std::size_t r = 0; r < carried_.size(); ++r)
      expand_->set(indexed("amounts", i * carried_.size() + r), acting.sources[i][r]);
  for (std::size_t i = 0; i < acting.pushes.size(); ++i) collect_->set(indexed("push_amounts", i), acting.pushes[i]);
  for (std::size_t r = 0; r < carried_.size(); ++r)
    collect_->set(indexed("weights", r), r < acting.weights.size() ? acting.weights[r] : Vec3(Vec3::Zero()));
  expand_->set("fades", acting.fades);
}

bool FluidOnDevice::pushes(const Acting& acting) const {
  const auto acts = [](const Vec3& v) { return !v.isZero(0); };
  return moves_ && (std::any_of(acting.pushes.begin(), acting.pushes.end(), acts) ||
                    std::any_of(acting.weights.begin(), acting.weights.end(), acts));
}

// Up to the pressure that expand adds.
void FluidOnDevice::push() {
  collect({0, velocities_}, ComesFrom::forces);
  columns({0, velocities_}, false);
}

// How long a part of the step may be is asked before its first stage ends, or not at all: then all is one part.
int FluidOnDevice::run(double dt, const StepForces& forces, bool looks) {
  const Fields all{0, fields_}, moving = this->moving(), diffusing = this->diffusing();
  const bool any = diffusing.count > 0, viscous = any && diffusing.first == 0;
  const bool pushed = pushes(forces[0]), pushes = this->pushes(forces[1]);
  const GoesOn first = any ? GoesOn::to_modes : GoesOn::to_points;
  set(forces[0]);
  expand(all, pushed ? GoesOn::nowhere : first, false, -1, 0, true);
  if (pushed) {
    push();
    expand(all, first, true, -1, 0);
  }
  set(forces[1]);
  if (any) {
    spread_modes_back(diffusing, 0.5 * dt);
    expand(all, GoesOn::to_points, viscous, -1, 0);
  }
  int parts = 0;
  for (double left = dt; left > 0; ++parts) {
    int steps = 1;
    for (int stage = 0; stage < 4; ++stage) {
      if (looks && stage == 0) status_->clear();
      points(stage == 0);
      if (looks && stage == 0) steps = steps_in(left, look());
      collect(moving, ComesFrom::points);
      if (moves_) columns(moving, false);
      const bool last = steps == 1 && stage == 3;
      const GoesOn next = !last ? GoesOn::to_points : any ? GoesOn::to_modes : GoesOn::nowhere;
      expand(moving, next, true, stage, left / steps, false, last && !any && !pushes);
    }
    left = steps > 1 ? left - left / steps : 0;
  }
  if (any) spread_modes_back(diffusing, 0.5 * dt);
  if (pushes) push();
  if (any || pushes) expand(all, GoesOn::nowhere, viscous || pushes, -1, 0, false, true);
  return parts;
}

void FluidOnDevice::bind() {
  regions_->bind(at::regions);
  tables_->bind_as(GL_UNIFORM_BUFFER, at::matrices);
  rates_->bind(at::rates);
  pressure_->bind(at::pressure);
  spread_->bind(at::spread);
  gathered_->bind(at::gathered);
  status_->bind(at::status);
  states_[1 - current_]->bind(at::state);
}

void FluidOnDevice::project() {
  const Use use(context_);
  bind();
  const Fields velocity{0, velocities_};
  for (std::size_t r = 0; r < carried_.size(); ++r) collect_->set(indexed("weights", r), Vec3(Vec3::Zero()));
  expand({0, fields_}, GoesOn::nowhere, false, -1, 0, true);
  collect(velocity, ComesFrom::forces);
  columns(velocity, false);
  expand(velocity, GoesOn::nowhere, true, -1, 0);
  current_ = 1 - current_;
}

void FluidOnDevice::diffuse(double dt) {
  const Use use(context_);
  bind();
  const Fields all{0, fields_};
  expand(all, GoesOn::to_modes, false, -1, 0, true);
  columns(all, true, dt);
  collect(all, ComesFrom::modes);
  current_ = 1 - current_;
}

void FluidOnDevice::advect(Fluid& rates) {
  const Use use(context_);
  bind();
  expand({0, fields_}, GoesOn::to_points, false, -1, 0, true);
  points(false);
  collect(moving(), ComesFrom::points);
  take(rates_->download<float>(), rates);
}

void FluidOnDevice::step(double dt, const StepForces& forces) {
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
}

}  // namespace airlight::gpu::legendre_fluids
