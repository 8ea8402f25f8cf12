// The solver's parts on the device, for vectors of fluids in a box of coefficients: methods/legendre_fluids, variant `galerkin`.
#pragma once
#include <Eigen/Cholesky>
#include <memory>
#include <vector>

#include "gpu/legendre_fluids/confined_fluid.h"
#include "gpu/legendre_fluids/flow_particles.h"

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
    device = std::make_unique<gpu::legendre_fluids::FluidOnDevice>(gpu::Context::get(), *this, material,
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
  std::unique_ptr<gpu::legendre_fluids::FluidOnDevice> device;
};

inline constexpr Material carrying{0, 0, false};  // by a velocity that is given

// A velocity carried by another one: its components, whose n coefficients are n + 1 in L, as scalars. Their rates tested with the functions
// of the velocity's space.
inline Array carried_on_device(const ConfinedSpace& space, const Array& w, const Array& u) {
  const ConfinedSpace wide(space.dimensions(), space.n() + 1);
  const auto cut = [](const Array& from, const TensorShape& shape, const TensorShape& to) {
    const auto part = [&](std::size_t a) { return Eigen::MatrixXd(Eigen::MatrixXd::Identity(to[a], shape[a])); };
    return Array(scene::along_axes(part(0), part(1), part(2), from, shape));
  };
  Components parts;
  std::vector<Array> scalars;
  std::vector<TensorShape> shapes;
  for (int a = 0; a < space.dimensions(); ++a) {
    parts[a] = cut(space.component(w, a), space.shape(a), wide.shape(a));
    shapes.push_back(space.shape());
    shapes.back()[std::size_t(a)] = space.n() + 1;
    const Array l = scene::along_axis(a, space.phi(), space.component(u, a), space.shape(a));
    scalars.push_back(cut(l, shapes.back(), wide.shape()));
  }
  DeviceFluid fluid(wide, carrying, wide.joined(parts), scalars[0], {scalars.begin() + 1, scalars.end()});
  const std::vector<Array*> rates = fluid.rates().carried();  // density, others
  const Eigen::MatrixXd& phi = space.phi();
  const Eigen::MatrixXd tested = (phi.transpose() * phi).llt().solve(phi.transpose());
  for (int a = 0; a < space.dimensions(); ++a)
    parts[a] = scene::along_axis(a, tested, cut(*rates[std::size_t(a)], wide.shape(), shapes[std::size_t(a)]),
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
