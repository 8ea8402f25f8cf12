// Solvers of flow problems: what Stable Fluids and Legendre fluids have in common.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/base/component.h"
#include "scene/base/error.h"
#include "scene/flow/flow_problem.h"
#include "scene/flow/particle_mover.h"
#include "scene/media/medium.h"
#include "scene/renderer.h"

namespace airlight::scene {

// Sums over the box at one time.
struct Totals {
  double energy = 0;     // kinetic, over the fluid's density: integral of |u|^2 / 2 [m^5/s^2]; in 2D per metre of depth
  double enstrophy = 0;  // integral of |curl u|^2 / 2 [m^3/s^2]
  double mass = 0;       // integral of the density of smoke [m^3]
  double density_least = 0, density_greatest = 0;
  double greatest_speed = 0;               // of a component [m/s]
  double divergence = 0;                   // greatest |div u| times a cell, over the greatest speed [-]
  double cfl = 0;                          // greatest speed times the last step, in cells [-]
  Point3 center_of_mass = Point3::Zero();  // [m]; of the box where there is no mass
};

// State of a flow at one time, on a grid: content of an OpenVDB file (write_frame).
struct Frame {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();  // cells
  double cell = 1;                                 // [m]
  Point3 low = Point3::Zero();                     // corner of the first cell [m]
  // By cell, x fastest; empty where the flow carries none.
  std::vector<float> density, temperature;
  std::map<std::string, std::vector<float>> densities;  // beside the first, by name
  // On the low faces of each cell, and of one more cell along each axis, for the last faces: (u, v, w) [m/s], 3 numbers
  // each, size + 1 of them along an axis.
  std::vector<float> velocity;
};

// A step whose result is of no use: values are no longer finite, or energy grows beyond all measure.
class Unstable : public Error {
 public:
  using Error::Error;
};

class Flow {
 public:
  virtual ~Flow() = default;
  virtual double time() const = 0;  // [s]
  // By dt > 0 [s]. Throws Unstable (step and cell).
  virtual void step(double dt) = 0;
  // A further force, which acts as though the problem had it from the start, if its time begins now or later. Throws Error where the flow
  // takes none, and for a region that is too small to be seen.
  virtual void add(const Push&);
  // At points of the box; outside it at the nearest one.
  virtual Vec3 velocity(const Point3&) const = 0;                          // [m/s]
  virtual std::vector<Vec3> velocities(const std::vector<Point3>&) const;  // of many points: one by one by default
  virtual double density(const Point3&) const = 0;                         // the first one, as in totals()
  virtual double temperature(const Point3&) const = 0;
  // A density as renderers know it, not below 0: 0 the first, k the k-th of FlowProblem::densities.
  virtual DensityField medium(int density = 0) const = 0;
  virtual Frame frame() const = 0;
  virtual Totals totals() const = 0;
  // Wall clock of each stage, summed over the steps; what was counted.
  virtual std::vector<StageTime> times() const = 0;
  virtual std::map<std::string, double> counters() const = 0;
  // All that the next step depends on, bit for bit, and back into a flow that was started alike. Throws Error.
  virtual std::string state() const = 0;
  virtual void restore(const std::string& state) = 0;
  // Moves the problem's particles, which begin in these places, where the flow itself lies; null: on the processor, FlowParticles does.
  // The flow outlives it.
  virtual std::unique_ptr<ParticleMover> particle_mover(const ParticlePlaces&) const { return nullptr; }
};

// Grids `density`, `temperature`, those named (fog volumes) and `velocity` (staggered) of one OpenVDB file, atomically, with `notes`
// as its metadata. Nothing is pruned: what read_vdb reads are the frame's values. Moved here, a frame
// is freed on the way. Throws Error.
void write_frame(const std::string& path, Frame, const std::map<std::string, std::string>& notes);

class Solver : public Component {
 public:
  // Empty: it can solve the problem. Else the reasons why not, one line each.
  virtual std::vector<std::string> supports(const FlowProblem&, const Settings&) const = 0;
  // Throws NotSupported if supports() objects, Error where the problem has no solution on the grid that the settings
  // ask for; beginning with the problem's file.
  std::unique_ptr<Flow> start(std::shared_ptr<const FlowProblem>, const Settings&, const Execution&) const;
  // The steps that a frame takes, all of one length.
  virtual int steps_per_frame(const FlowProblem&, const Settings&) const = 0;

 private:
  virtual std::unique_ptr<Flow> start_supported(std::shared_ptr<const FlowProblem>, const Settings&,
                                                const Execution&) const = 0;
};

}  // namespace airlight::scene
