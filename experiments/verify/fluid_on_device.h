// The solver's parts on the device, for vectors of fluids in a box of coefficients: methods/legendre_fluids, variant `galerkin`, and what of
// its vectors the paper's variants can meet.
#pragma once
#include <Eigen/Cholesky>
#include <memory>
#include <vector>

#include "gpu/legendre_fluids/confined_fluid.h"
#include "gpu/legendre_fluids/flow_particles.h"
#include "gpu/legendre_fluids/paper_fluid.h"

namespace airlight::experiments::verification {

using legendre_fluids::Array;
using legendre_fluids::Components;
using legendre_fluids::ConfinedSpace;
using legendre_fluids::Material;
using scene::TensorShape;

// A fluid on the device: coefficients go there and come back.
struct DeviceFluid : legendre_fluids::ConfinedFluid {
  DeviceFluid(const ConfinedSpace& space, const Material& material, const Array& u, const Array& r = {},
              const std::vector<Array>& more = {})
      : legendre_fluids::ConfinedFluid(space.dimensions(), space.n(), Vec3::Ones(), material, {}), material(material) {
    velocity = u, density = r, others = more;
    device = std::make_unique<gpu::legendre_fluids::ConfinedFluidOnDevice>(gpu::Context::get(), *this, material,
                                                                           legendre_fluids::ConfinedOptions{});
  }
  DeviceFluid& now() {
    device->download(*this);
    return *this;
  }
  // The velocity and all that it carries become their rates of advection.
  DeviceFluid& rates() {
    device->advect(*this);
    return *this;
  }
  Material material;
  std::unique_ptr<gpu::legendre_fluids::ConfinedFluidOnDevice> device;
};

inline constexpr Material carrying{0, 0, false};  // by a velocity that is given

// The first coefficients along each axis, or all and zeros.
inline Array resized(const Array& from, const TensorShape& shape, const TensorShape& to) {
  const auto part = [&](std::size_t a) { return Eigen::MatrixXd(Eigen::MatrixXd::Identity(to[a], shape[a])); };
  return scene::along_axes(part(0), part(1), part(2), from, shape);
}

// A fluid of the paper's variants on the device, of n + 1 coefficients, which hold the velocities of a space of n.
struct PaperDeviceFluid : legendre_fluids::PaperFluid {
  PaperDeviceFluid(const ConfinedSpace& space, const Material& material, bool repaired, const Array& u, const Array& r)
      : legendre_fluids::PaperFluid(space.dimensions(), space.n() + 1, Vec3::Ones(), material,
                                    legendre_fluids::Truncation::l2, repaired),
        narrow(space) {
    for (int a = 0; a < space.dimensions(); ++a) {
      TensorShape shape = space.shape();
      shape[std::size_t(a)] = space.n() + 1;
      const Array l = scene::along_axis(a, space.phi(), space.component(u, a), space.shape(a));
      velocity.segment(a * this->space().scalars(), this->space().scalars()) = resized(l, shape, this->space().shape());
    }
    if (r.size()) density = resized(r, space.shape(), this->space().shape());
    device = std::make_unique<gpu::legendre_fluids::PaperFluidOnDevice>(gpu::Context::get(), *this, material);
  }
  // The velocity after a step, in the functions of the space of n; and the density's first n coefficients.
  void step(double dt) {
    device->step(dt);
    device->download(*this);
  }
  Array narrow_velocity() const {
    const Eigen::MatrixXd& phi = narrow.phi();
    const Eigen::MatrixXd tested = (phi.transpose() * phi).llt().solve(phi.transpose());
    Components parts;
    for (int a = 0; a < narrow.dimensions(); ++a) {
      TensorShape shape = narrow.shape();
      shape[std::size_t(a)] = narrow.n() + 1;
      parts[a] = scene::along_axis(
          a, tested, resized(velocity.segment(a * space().scalars(), space().scalars()), space().shape(), shape),
          shape);
    }
    return narrow.joined(parts);
  }
  Array narrow_density() const { return resized(density, space().shape(), narrow.shape()); }
  ConfinedSpace narrow;
  std::unique_ptr<gpu::legendre_fluids::PaperFluidOnDevice> device;
};

// A step of no time is the projection alone.
inline Array projected_by_paper(const ConfinedSpace& space, const Array& u) {
  PaperDeviceFluid fluid(space, {}, true, u, {});
  fluid.step(0);
  return fluid.narrow_velocity();
}

// The rate of a density, by steps forward and back.
inline Array advected_by_paper(const ConfinedSpace& space, const Array& w, const Array& r) {
  constexpr double dt = 1e-5;
  PaperDeviceFluid fluid(space, carrying, false, w, r);
  const Array before = fluid.density;
  fluid.step(dt);
  const Array after = fluid.narrow_density();
  fluid.density = before;
  fluid.device->upload(fluid);
  fluid.step(-dt);
  return (after - fluid.narrow_density()) / (2 * dt);
}

// A velocity carried by another one: its components, whose n coefficients are n + 1 in L, as scalars. Their rates tested with the functions
// of the velocity's space.
inline Array carried_on_device(const ConfinedSpace& space, const Array& w, const Array& u) {
  const ConfinedSpace wide(space.dimensions(), space.n() + 1);
  Components parts;
  std::vector<Array> scalars;
  std::vector<TensorShape> shapes;
  for (int a = 0; a < space.dimensions(); ++a) {
    parts[a] = resized(space.component(w, a), space.shape(a), wide.shape(a));
    shapes.push_back(space.shape());
    shapes.back()[std::size_t(a)] = space.n() + 1;
    const Array l = scene::along_axis(a, space.phi(), space.component(u, a), space.shape(a));
    scalars.push_back(resized(l, shapes.back(), wide.shape()));
  }
  DeviceFluid fluid(wide, carrying, wide.joined(parts), scalars[0], {scalars.begin() + 1, scalars.end()});
  const std::vector<Array*> rates = fluid.rates().carried();  // density, others
  const Eigen::MatrixXd& phi = space.phi();
  const Eigen::MatrixXd tested = (phi.transpose() * phi).llt().solve(phi.transpose());
  for (int a = 0; a < space.dimensions(); ++a)
    parts[a] = scene::along_axis(a, tested, resized(*rates[std::size_t(a)], wide.shape(), shapes[std::size_t(a)]),
                                 shapes[std::size_t(a)]);
  return space.joined(parts);
}

// Where particles at these places are after a microsecond, in double precision: how far they went over that time is the velocity.
inline std::vector<Vec3> speeds_of_particles(DeviceFluid& fluid, const std::vector<Vec3>& places) {
  constexpr double dt = 1e-6;
  scene::FlowProblem problem;
  problem.dimensions = fluid.space().dimensions();
  problem.box = {Point3::Constant(-1), Point3::Constant(1)};
  problem.particles.push_back({int(places.size()), {}, 0, Vec3::Zero(), scene::ParticleSet::Leaving::stay});
  scene::ParticlePlaces particles{{places}, {std::vector<double>(places.size())}};
  gpu::legendre_fluids::ParticlesOnDevice moving(gpu::Context::get(), *fluid.device, problem, particles);
  fluid.device->step(dt);
  moving.step(dt);
  moving.read(particles);
  std::vector<Vec3> speeds;
  for (std::size_t i = 0; i < places.size(); ++i) speeds.push_back((particles.positions[0][i] - places[i]) / dt);
  return speeds;
}

}  // namespace airlight::experiments::verification
