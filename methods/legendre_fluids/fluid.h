// State of a variant of Legendre fluids: a velocity in coefficients of its own, and carried quantities
// in n^d coefficients of L.
#pragma once
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "methods/legendre_fluids/confined_space.h"
#include "methods/legendre_fluids/time_steps.h"

namespace airlight::legendre_fluids {

using VelocityFunction = std::function<Vec3(const Vec3& x)>;  // half sizes per second, x in [-1, 1]^d

struct Material {
  double viscosity = 0, diffusivity = 0;  // [m^2/s]
  bool moves = true;                      // false: the velocity is given, what it carries alone moves
};

class Fluid {
 public:
  Fluid(int dimensions, int n, const Vec3& half, const Material& material)
      : space_(dimensions, n, half), material_(material) {}
  virtual ~Fluid() = default;

  const ConfinedSpace& space() const { return space_; }
  Array velocity;              // coefficients, of the variant's own shape
  Array density, temperature;  // coefficients; empty where there is none
  std::vector<Array> others;   // further densities
  double time = 0;             // at which the next step begins [s]
  // Density, others, temperature: all, empty ones too.
  std::vector<Array*> carried();

  virtual void begin(const VelocityFunction&) = 0;
  // A step is advance, push where there are forces, before and after or after alone, then finish. The first and the last throw
  // scene::Unstable.
  virtual void advance(double dt) = 0;
  virtual void push(const Components& change) = 0;  // coefficients of L for each axis [half sizes per second], added
  virtual void finish(double dt) = 0;
  // Do forces, sources and decay act for half of a step before the fluid moves (Strang)? Else sources act before, the others after.
  virtual bool halves() const { return false; }
  // Remaining share of a quantity that decays; `amount` is rate times time.
  virtual double faded(double amount) const { return std::exp(-amount); }

  // Half sizes per second at the Gauss points of the space; on a lattice of other points; its gradient along an axis.
  virtual Components at_points() const = 0;
  virtual Array sampled(int component, const Components& positions) const = 0;
  virtual Array sampled_gradient(int component, int axis, const Components& positions) const = 0;
  virtual double at(int component, const Vec3& x) const = 0;
  virtual Array at(int component, const std::vector<Vec3>& x) const;  // one by one by default

  // [m^(d+2)/s^2]
  double energy() const;
  // The longest half sizes per second at the Gauss points.
  double greatest_speed() const;

  virtual std::map<std::string, double> counters() const = 0;

 protected:
  ConfinedSpace space_;
  Material material_;
};

// The value at one point of [-1, 1]^d of coefficients whose component is as for ConfinedSpace, -1: a scalar.
double value_at(const ConfinedSpace&, const Array& coefficients, int component, const Vec3& x);

}  // namespace airlight::legendre_fluids
