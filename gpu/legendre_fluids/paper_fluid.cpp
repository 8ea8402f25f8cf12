#include "gpu/legendre_fluids/paper_fluid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scene/flow/flow.h"
#include "scene/math/dense.h"

namespace airlight::gpu::legendre_fluids {
namespace {

using Eigen::MatrixXd;
using scene::product;

constexpr std::size_t least_lanes = 32, most_lanes = 256, points_of_lane = 4;
constexpr int loops_of_dispatch = 20000;  // llvmpipe ends all loops after 65535 iterations
constexpr double more_steps = 1.25;       // of the series than were enough
constexpr std::size_t field_status = 9;   // numbers of paper_fluid.glsl

// Filled up with zeros.
MatrixXd padded(const MatrixXd& m, int n) {
  MatrixXd result = MatrixXd::Zero(n, n);
  result.topLeftCorner(m.rows(), m.cols()) = m;
  return result;
}

// Factors of diffusion in modes, as a matrix: modes exp(-amount rates) modes^T.
MatrixXd factors(const MatrixXd& modes, const Array& rates, double amount) {
  return product(modes * (-amount * rates).array().exp().matrix().asDiagonal(), modes.transpose());
}

}  // namespace

PaperFluidOnDevice::PaperFluidOnDevice(Context& context, PaperFluid& fluid, const Material& material,
                                       const Regions& regions)
    : FluidOnDevice(context, fluid),
      material_(material),
      repaired_(fluid.confined() != nullptr),
      velocities_(fluid.space().dimensions()),
      fields_(velocities_ + int(carried_.size())),
      n_(fluid.space().n()),
      size_(std::size_t(fluid.space().scalars())),
      half_(fluid.space().half()),
      space_(fluid.space()),
      to_wall_(fluid.to_wall()),
      to_free_(fluid.to_free()) {
  const Use use(context_);
  if (repaired_ && fluid.confined()->size() > 0) confined_ = *fluid.confined();
  lay_out(fluid, regions);
  begin_ = &program(context_, "paper_fluid_begin", lanes_, 1, definitions_);
  advect_ = &program(context_, "paper_fluid_advect", lanes_, 1, definitions_);
  diffuse_ = &program(context_, "paper_fluid_diffuse", lanes_, 1, definitions_);
  end_ = &program(context_, "paper_fluid_end", lanes_, 1, definitions_);
  table_ = std::make_unique<Buffer>(context_, "tables of the paper's fluid", tables_);
  for (auto& state : doubles_)
    state = std::make_unique<Buffer>(context_, "state of the paper's fluid", 8 * std::size_t(fields_) * size_,
                                     Contents::undefined);
  for (auto& state : states_)
    state = std::make_unique<Buffer>(context_, "state in single precision", 4 * std::size_t(fields_) * size_,
                                     Contents::undefined);
  upload(fluid);
  // A step that nobody keeps: drivers that compile what is used first do so now.
  bind();
  set({});
  begin_->dispatch(fields_ * lanes_);
  advect(1e-9, 1);
  end(1e-9, {});
  look();
}

// Tables, the parts of the work, and the buffers that no upload makes.
void PaperFluidOnDevice::lay_out(const PaperFluid& fluid, const Regions& regions) {
  const auto table = [&](const char* name, const auto& values) {
    define(name, tables_.size());
    tables_.insert(tables_.end(), values.data(), values.data() + values.size());  // by columns
  };
  const std::size_t n = std::size_t(n_), m = 2 * n - 1, last = velocities_ == 3 ? m : 1, nz = velocities_ == 3 ? n : 1;
  define("D", std::size_t(velocities_));
  define("N", n);
  define("NZ", nz);
  define("M", m);
  define("FIELDS", std::size_t(fields_));
  define("SCALARS", carried_.size());
  define("MOVES", material_.moves);
  define("REPAIRED", repaired_);
  define("CONFINED", 0);
  define("WIND", 0);
  define("SOURCES", regions.sources.size());
  define("PUSHES", regions.pushes.size());
  define("FIELD_STATUS", field_status);
  const auto matrices = fluid.advection().matrices();
  table("VALUES_AT", matrices.values);
  table("CUT_AT", matrices.cut);
  table("SLOPE_AT", matrices.derived_and_cut);
  const MatrixXd& derivative = fluid.laplacian().derivative();
  table("DERIVATIVE_AT", derivative);
  table("SECOND_AT", product(derivative, derivative));
  if (!repaired_) table("INVERSE_AT", material_.moves ? fluid.laplacian().least_norm_inverse() : MatrixXd());
  if (repaired_) {
    // n coefficients of L to the confined space's modes of pressure, and back; zeros where it has no velocity.
    MatrixXd own, other, confined, rest, gradient_own, gradient;
    Array pressure = Array::Zero(Eigen::Index(size_));
    if (confined_) {
      const auto space = confined_->matrices();
      const MatrixXd& phi = confined_->phi();
      const MatrixXd modes = space.pressure_modes.transpose(), back = to_free_.transpose();
      own = product(modes.rightCols(n_ - 2), to_wall_);  // phi_i' = L_i, i from 1
      other = product(modes, to_free_);
      confined = product(phi, to_wall_);
      rest = product(back, to_free_);
      gradient_own = MatrixXd::Zero(n_, n_);
      gradient_own.middleCols(1, n_ - 2) = product(phi, space.wall_modes * space.wall_rates.asDiagonal());
      gradient = product(back, space.pressure_modes);
      Eigen::Index e = 0;
      const scene::TensorShape shape = space_.shape();
      for (int i = 0; i < shape[0]; ++i)
        for (int j = 0; j < shape[1]; ++j)
          for (int k = 0; k < shape[2]; ++k, ++e) {
            const std::array<int, 3> index{i, j, k};
            double rate = 0;
            bool there = true;
            for (int a = 0; a < velocities_; ++a) {
              there &= index[a] < n_ - 1;
              if (there && index[a] > 0) rate += space.wall_rates[index[a] - 1] / (half_[a] * half_[a]);
            }
            pressure[e] = there && rate > 0 ? -1 / rate : 0;
          }
    }
    table("TO_MODES_OWN_AT", padded(own, n_));
    table("TO_MODES_AT", padded(other, n_));
    table("CONFINED_OWN_AT", padded(confined, n_));
    table("CONFINED_AT", padded(rest, n_));
    table("GRADIENT_OWN_AT", padded(gradient_own, n_));
    table("GRADIENT_AT", padded(gradient, n_));
    table("PRESSURE_AT", pressure);
    factors_at_ = tables_.size();
    table("FACTORS_AT", MatrixXd(MatrixXd::Zero(9 * n_, n_)));  // set_factors
  }
  define("REGIONS_AT", tables_.size());
  for (const auto* list : {&regions.sources, &regions.pushes})
    for (const Array& region : *list) tables_.insert(tables_.end(), region.data(), region.data() + region.size());
  std::size_t stride = 0;
  const auto part = [&](const char* name, std::size_t count) {
    define(name, stride);
    stride += count;
  };
  const std::size_t points = m * m * last, lines = m * last * n, slab = n * nz;
  part("TERM_AT", size_);
  part("ONE_AT", points);
  part("TWO_AT", std::max(std::size_t(velocities_) * lines, size_));
  part("THREE_AT", velocities_ == 3 ? 2 * m * slab : 0);
  define("STRIDE", stride);
  const auto doubles = [&](const char* name, std::size_t count) {
    return std::make_unique<Buffer>(context_, name, 8 * count, Contents::undefined);
  };
  work_ = doubles("work of the paper's fluid", std::max(std::size_t(fields_) * stride, 4 * size_ + points));
  speeds_ = doubles("velocity at points", std::size_t(velocities_) * points);
  status_ = std::make_unique<Buffer>(context_, "status of the paper's fluid", 8 * (fields_ * field_status + 4));
  // A power of two, for sums. Software renderers pay for each lane at each barrier.
  lanes_ = int(std::clamp(std::bit_ceil(points / points_of_lane), least_lanes, most_lanes));
  // Loops of a term: to the points along each axis, and back.
  const double loops =
      double(points * n + m * m * slab + m * slab * n + lines * m + (velocities_ == 3 ? m * slab * m : 0) + size_ * m);
  together_ = std::max(1, int(loops_of_dispatch / (loops / lanes_ + 12)));
}

// Exact diffusion of the repaired variant over a time [s].
void PaperFluidOnDevice::set_factors(double dt) {
  factors_dt_ = dt;
  if (!repaired_ || !(material_.viscosity > 0 || material_.diffusivity > 0)) return;
  double* to = tables_.data() + factors_at_;
  const auto put = [&](const MatrixXd& m) { to = std::copy(m.data(), m.data() + m.size(), to); };
  for (int a = 0; a < 3; ++a) {
    const double per_area = a < velocities_ ? dt / (half_[a] * half_[a]) : 0, amount = material_.viscosity * per_area;
    MatrixXd own, free;
    if (confined_) {
      const auto space = confined_->matrices();
      own = product(product(confined_->phi(), factors(space.wall_modes, space.wall_rates, amount)), to_wall_);
      free = product(product(to_free_.transpose(), factors(space.free_modes, space.free_rates, amount)), to_free_);
    }
    put(padded(own, n_));
    put(padded(free, n_));
    put(factors(space_.matrices().free_modes, space_.matrices().free_rates, material_.diffusivity * per_area));
  }
  table_->upload(tables_);
}

void PaperFluidOnDevice::upload(Fluid& fluid) {
  const Use use(context_);
  std::vector<double> state(fluid.velocity.begin(), fluid.velocity.end());
  for (const std::size_t which : carried_)
    state.insert(state.end(), fluid.carried()[which]->begin(), fluid.carried()[which]->end());
  times_[current_] = fluid.time;
  doubles_[current_]->upload(state);
  states_[current_]->upload(std::vector<float>(state.begin(), state.end()));
}

void PaperFluidOnDevice::download(Fluid& fluid) const {
  const Use use(context_);
  const std::vector<double> state = doubles_[current_]->download<double>();
  const auto field = [&](std::size_t first, std::size_t count) {
    return Eigen::Map<const Array>(state.data() + first * size_, Eigen::Index(count * size_));
  };
  fluid.velocity = field(0, std::size_t(velocities_));
  for (std::size_t r = 0; r < carried_.size(); ++r)
    *fluid.carried()[carried_[r]] = field(std::size_t(velocities_) + r, 1);
}

void PaperFluidOnDevice::bind() {
  table_->bind(at::tables);
  work_->bind(at::work);
  speeds_->bind(at::values);
  status_->bind(at::status);
  doubles_[current_]->bind(at::start);
  doubles_[1 - current_]->bind(at::state);
  states_[1 - current_]->bind(at::floats);
}

// Sources act before the fluid moves, forces and decay after it.
void PaperFluidOnDevice::set(const StepForces& forces) {
  const Acting &before = forces.before, &after = forces.after;
  const std::size_t scalars = carried_.size();
  for (std::size_t i = 0; i < before.sources.size(); ++i)
    for (std::size_t r = 0; r < scalars; ++r)
      begin_->set_double(at_index("amounts", i * scalars + r), before.sources[i][r]);
  for (std::size_t i = 0; i < after.pushes.size(); ++i) end_->set_double(at_index("push_amounts", i), after.pushes[i]);
  for (std::size_t r = 0; r < scalars; ++r) {
    end_->set_double(at_index("weights", r), r < after.weights.size() ? after.weights[r] : Vec3(Vec3::Zero()));
    end_->set_double(at_index("fades", r), r < after.fades.size() ? after.fades[r] : 1);
  }
}

void PaperFluidOnDevice::advect(double dt, int steps) {
  const int first = material_.moves ? 0 : velocities_;
  advect_->set("first_field", first);
  advect_->set_double("dt", dt);
  for (int left = steps; left > 0; left -= together_) {
    advect_->set("steps", std::min(left, together_));
    advect_->dispatch((fields_ - first) * lanes_);
  }
}

void PaperFluidOnDevice::end(double dt, const StepForces& forces) {
  const Vec3 areas = half_.cwiseAbs2(), per_area = areas.cwiseInverse();
  const double viscosity = material_.moves ? material_.viscosity * dt : 0, diffusivity = material_.diffusivity * dt;
  const int first = viscosity > 0 && !repaired_ ? 0 : velocities_,
            count = (diffusivity > 0 ? fields_ : velocities_) - first;
  diffuse_->set("first_field", first);
  diffuse_->set_double("velocity_amount", viscosity);
  diffuse_->set_double("carried_amount", diffusivity);
  diffuse_->set_double("per_area", per_area);
  diffuse_->dispatch(count * lanes_);
  end_->set("pushes", material_.moves && pushes(forces.after));
  end_->set("diffuses", viscosity > 0);
  end_->set_double("per_area", per_area);
  end_->set_double("areas", areas);
  end_->dispatch(lanes_);
}

PaperFluidOnDevice::Status PaperFluidOnDevice::look() const {
  const std::vector<double> all = status_->download<double>();
  Status s{{}, {}, 0, true, false, false, 0, 0, 0};
  for (int f = 0; f < fields_; ++f) {
    const double* of = all.data() + std::size_t(f) * field_status;
    if (f < velocities_) s.most.push_back(of[0]), s.squares.push_back(of[8]);
    s.lost |= of[1] != 0;
    s.done &= of[2] != 0;
    s.steps = std::max(s.steps, of[3]);
  }
  const double* rest = all.data() + std::size_t(fields_) * field_status;
  s.advected = rest[0], s.pushed = rest[1], s.last = rest[2];
  s.lost_at_end = rest[3] != 0;
  return s;
}

// As PaperFluid and LegendreFlow do.
void PaperFluidOnDevice::require_tame(const Status& s, double dt) const {
  const auto not_finite = [] { throw scene::Unstable("coefficients are no longer finite"); };
  double rate = 0, first = 0;
  for (int a = 0; a < velocities_; ++a) {
    rate += s.most[std::size_t(a)] * n_ * n_;
    first += half_[a] * half_[a] * s.squares[std::size_t(a)];
  }
  if (s.lost) not_finite();
  airlight::legendre_fluids::parts_of_advection(dt, rate);
  if (!s.done) return;
  if (material_.moves) {
    double growth = first > 0 ? s.advected / first : 1;
    airlight::legendre_fluids::require_tame(growth, repaired_);
    if (s.pushed > 0) growth *= s.last / s.pushed;
    airlight::legendre_fluids::require_tame(growth, repaired_);
  }
  if (s.lost_at_end) not_finite();
}

void PaperFluidOnDevice::step(double dt, const StepForces& forces) {
  const Use use(context_);
  if (dt != factors_dt_) set_factors(dt);
  bind();
  set(forces);
  begin_->dispatch(fields_ * lanes_);
  Status status;
  for (bool again = false;; again = true) {
    advect(dt, steps_);
    end(dt, forces);
    status = look();
    require_tame(status, dt);
    if (status.done) break;
    if (again) steps_ *= 2;
  }
  context_.check("a step of the paper's fluid");
  steps_ = int(more_steps * status.steps) + 2;
  current_ = 1 - current_;
  times_[current_] = forces.begins + dt;
}

}  // namespace airlight::gpu::legendre_fluids
