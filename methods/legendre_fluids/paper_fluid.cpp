#include "methods/legendre_fluids/paper_fluid.h"

#include <fmt/format.h>

#include "scene/flow/flow.h"
#include "scene/math/dense.h"

namespace airlight::legendre_fluids {
namespace {

constexpr double most_growth = 10;  // of the energy in a step

using Eigen::MatrixXd;

}  // namespace

void require_tame(double growth, bool repaired) {
  if (!(growth <= 1e300)) throw scene::Unstable("the energy is no longer finite");
  if (growth <= most_growth) return;
  throw scene::Unstable(fmt::format("the energy grew {:.3g} times in a step: {}", growth,
                                    repaired ? "smaller steps are needed" : "the paper's equations know no walls"));
}

PaperFluid::PaperFluid(int dimensions, int n, const Vec3& half, const Material& material, Truncation truncation,
                       bool repaired)
    : Fluid(dimensions, n, half, material), advection_(dimensions, n, truncation), laplacian_(dimensions, n, half) {
  velocity = Array::Zero(dimensions * space_.scalars());
  if (!repaired) return;
  confined_.emplace(dimensions, std::max(1, n - 1), half);
  if (confined_->size() == 0) return;
  const MatrixXd& phi = confined_->phi();  // n x (n-2)
  to_wall_ = scene::solve_definite(scene::product(phi.transpose(), phi), phi.transpose());
  to_free_ = MatrixXd::Identity(n - 1, n);
}

Components PaperFluid::parts() const {
  Components result;
  for (int a = 0; a < space_.dimensions(); ++a) result[a] = part(a);
  return result;
}
void PaperFluid::set_parts(const Components& u) {
  for (int a = 0; a < space_.dimensions(); ++a) velocity.segment(a * space_.scalars(), space_.scalars()) = u[a];
}

Array PaperFluid::to_confined() const {
  Components u;
  for (int a = 0; a < space_.dimensions(); ++a) {
    u[a] = part(a);
    TensorShape s = space_.shape();
    for (int b = 0; b < space_.dimensions(); ++b) {
      const MatrixXd& matrix = b == a ? to_wall_ : to_free_;
      u[a] = scene::along_axis(b, matrix, u[a], s);
      s[b] = int(matrix.rows());
    }
  }
  return confined_->joined(u);
}

void PaperFluid::from_confined(const Array& u) {
  const MatrixXd from_free = to_free_.transpose();
  Components result;
  for (int a = 0; a < space_.dimensions(); ++a) {
    result[a] = confined_->component(u, a);
    TensorShape s = confined_->shape(a);
    for (int b = 0; b < space_.dimensions(); ++b) {
      const MatrixXd& matrix = b == a ? confined_->phi() : from_free;
      result[a] = scene::along_axis(b, matrix, result[a], s);
      s[b] = int(matrix.rows());
    }
  }
  set_parts(result);
}

void PaperFluid::project() {
  if (!confined_)
    set_parts(laplacian_.projected(parts()));
  else if (confined_->size() == 0)
    velocity.setZero();
  else
    from_confined(confined_->project(to_confined()));
  needs_projection_ = false;
}

void PaperFluid::begin(const VelocityFunction& u) {
  Components start;
  for (int a = 0; a < space_.dimensions(); ++a)
    start[a] = space_.scalar_from_function([&](const Vec3& x) { return u(x)[a]; });
  set_parts(start);
  if (material_.moves) project();
}

// Advection, Eq. 14, and diffusion, Eq. 16. LegendreFlow::move then calls push (forces, Eq. 17) and finish (projection, Eqs. 19 and 20).
void PaperFluid::advance(double dt) {
  advection_.set_velocity(parts());
  const double before = energy();
  if (material_.moves) {
    Components u = parts();
    for (int a = 0; a < space_.dimensions(); ++a) u[a] = advection_.advected(u[a], dt);
    const double amount = material_.viscosity * dt;
    if (amount > 0 && !confined_)
      for (int a = 0; a < space_.dimensions(); ++a) u[a] = laplacian_.diffused(u[a], amount);
    set_parts(u);
    needs_projection_ = true;
    if (confined_) {
      project();
      if (amount > 0 && confined_->size() > 0)
        from_confined(confined_->project(confined_->diffused(to_confined(), amount)));
    }
    growth_ = before > 0 ? energy() / before : 1;
    require_tame(growth_, confined_.has_value());
  }
  for (Array* r : carried()) {
    *r = advection_.advected(*r, dt);
    if (r->size() == 0 || !(material_.diffusivity > 0)) continue;
    const double amount = material_.diffusivity * dt;
    *r = confined_ ? space_.scalar_diffused(*r, amount) : laplacian_.diffused(*r, amount);
  }
}

void PaperFluid::push(const Components& change) {
  Components u = parts();
  for (int a = 0; a < space_.dimensions(); ++a) u[a] += change[a];
  set_parts(u);
  needs_projection_ = true;
}

void PaperFluid::finish(double) {
  if (!needs_projection_) return;
  const double before = energy();
  project();
  if (before > 0) growth_ *= energy() / before;
  require_tame(growth_, confined_.has_value());
}

Components PaperFluid::at_points() const {
  Components u;
  for (int a = 0; a < space_.dimensions(); ++a) u[a] = space_.scalar_at_points(part(a));
  return u;
}
Array PaperFluid::sampled(int component, const Components& positions) const {
  return space_.scalar_sampled(part(component), positions);
}
Array PaperFluid::sampled_gradient(int component, int axis, const Components& positions) const {
  return space_.scalar_sampled_gradient(part(component), axis, positions);
}
double PaperFluid::at(int component, const Vec3& x) const { return value_at(space_, part(component), -1, x); }

std::map<std::string, double> PaperFluid::counters() const {
  return {{"coefficients of velocity", double(velocity.size())}};
}

}  // namespace airlight::legendre_fluids
