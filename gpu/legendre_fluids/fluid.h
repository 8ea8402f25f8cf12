// A fluid whose coefficients live on the device: common parts of the variants of methods/legendre_fluids.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/legendre_fluids/interface.h"
#include "methods/legendre_fluids/fluid.h"

namespace airlight::gpu::legendre_fluids {

using airlight::legendre_fluids::Array;
using airlight::legendre_fluids::Fluid;
using airlight::legendre_fluids::Material;

constexpr int most_regions = 64;  // of sources, and of forces: uniforms

// Regions that sources fill and forces push, by their coefficients.
struct Regions {
  std::vector<Array> sources, pushes;
};

// Influences on the fluid before it moves in a step; after it they act in the opposite order.
struct Acting {
  // For the carried fields, in their order: what decay leaves; amounts added by sources, [source][field]; push per unit of a field
  // [half sizes per second].
  std::vector<double> fades;
  std::vector<std::vector<double>> sources;
  std::vector<Vec3> weights;
  std::vector<Vec3> pushes;  // by force [half sizes per second]
};
struct StepForces {
  Acting before, after;
  double begins = 0;  // when the step does [s]
};

// Whether any of it is a force.
bool pushes(const Acting&);

class FluidOnDevice {
 public:
  // What of Fluid::carried() is not empty is carried.
  FluidOnDevice(Context&, Fluid&);
  virtual ~FluidOnDevice() = default;

  // By dt [s]. Throws scene::Unstable, and leaves the state as it was.
  virtual void step(double dt, const StepForces& = {}) = 0;
  // Into a fluid that was made alike, and from it.
  virtual void download(Fluid&) const = 0;
  virtual void upload(Fluid&) = 0;
  virtual std::map<std::string, double> counters() const = 0;

  // Air that blows through the box beside the coefficients, linear in space [half sizes per second]: in the middle, and its slopes.
  struct LinearWind {
    Vec3 middle = Vec3::Zero();
    Mat3 slopes = Mat3::Zero();
  };
  virtual bool blows() const { return false; }
  // At the time of state() and at that of before().
  LinearWind wind() const { return wind_at(times_[current_]); }
  LinearWind wind_before() const { return wind_at(times_[1 - current_]); }

  // Current coefficients in single precision, with the layout of fields.glsl. The buffer changes with every step.
  const Buffer& state() const { return *states_[current_]; }
  // Coefficients before the last step.
  const Buffer& before() const { return *states_[1 - current_]; }
  // Definitions for shaders that read the coefficients.
  const Definitions& definitions() const { return definitions_; }
  // Indices into Fluid::carried() of the fields that are stored after the velocity's components.
  const std::vector<std::size_t>& carried() const { return carried_; }

 protected:
  virtual LinearWind wind_at(double) const { return {}; }
  void define(const char* name, std::size_t value) { definitions_[name] = std::to_string(value); }

  Context& context_;
  std::vector<std::size_t> carried_;
  std::array<std::unique_ptr<Buffer>, 2> states_;
  std::array<double, 2> times_{};  // of the states [s]
  int current_ = 0;                // of the states
  Definitions definitions_;
};

}  // namespace airlight::gpu::legendre_fluids
