// A fluid of coefficients as a scene::Flow: metres, sources, forces, states.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "methods/legendre_fluids/cells.h"
#include "methods/legendre_fluids/fluid.h"
#include "scene/base/stopwatch.h"
#include "scene/flow/flow.h"

namespace airlight::legendre_fluids {

enum class Mixing {
  densities,  // each density moves
  albedo,  // of two the sum r and the first one's share a: densities are the products a r and r - a r, cut to n (the paper's section 7)
};

class LegendreFlow : public scene::Flow {
 public:
  // Starts the fluid with what the problem has at first. `cells` are those of frames and of media that are grids, along the longest axis.
  // Throws Error where a region of a source or force is too small to be seen.
  LegendreFlow(std::shared_ptr<const scene::FlowProblem>, std::unique_ptr<Fluid>, int cells,
               Mixing = Mixing::densities);

  double time() const override { return time_; }
  void step(double dt) override;
  void add(const scene::Push&) override;
  Vec3 velocity(const Point3& x) const override;
  std::vector<Vec3> velocities(const std::vector<Point3>&) const override;
  double density(const Point3& x) const override { return carried_at(smoke(0), x); }
  double temperature(const Point3& x) const override { return carried_at(now().temperature, x); }
  scene::DensityField medium(int density) const override { return cells_.medium(fluid_->space(), smoke(density)); }
  scene::Frame frame() const override;
  scene::Totals totals() const override;
  std::vector<scene::StageTime> times() const override { return times_; }
  std::map<std::string, double> counters() const override;
  std::string state() const override;
  void restore(const std::string& state) override;

 protected:
  // Moves the coefficients by a step of dt [s] that begins at time(). Throws scene::Unstable.
  virtual void move(double dt);
  // The fluid with its coefficients of now, for those who move them elsewhere than in the fluid.
  virtual Fluid& now() const { return *fluid_; }
  // After the coefficients changed: the time of the fluid's wind, and the densities that the share of an albedo stands for.
  virtual void settle() const;

  // Times of decay, sources and forces that act before the fluid moves in a step of dt [s]; after it
  // they act in the opposite order.
  struct Acting {
    double decay;
    Interval sources, pushes;
  };
  std::array<Acting, 2> acting(double dt) const;
  // Durations for which each source acts within a time interval [s], and for which each force does: 0
  // outside their times.
  std::vector<double> source_seconds(const Interval& time) const;
  std::vector<double> push_seconds(const Interval& time) const;
  template <class Body>
  void timed(const std::string& stage, const Body& body) {
    scene::Stopwatch watch;
    body();
    add_time(stage, watch.lap());
  }

  std::shared_ptr<const scene::FlowProblem> p_;
  ReferenceBox box_;
  std::unique_ptr<Fluid> fluid_;
  Cells cells_;
  std::vector<scene::Push> pushes_;   // the problem's, and those that were added
  std::vector<Array> source_, push_;  // coefficients of the regions of sources and forces
  Mixing mixing_;

 private:
  void begin();
  void begin_densities();
  void begin_push(const scene::Push&);
  const Array& smoke(int which) const;
  void fade(double seconds);
  void add_sources(const Interval& time);
  void push(const Interval& time);
  void require_finite() const;
  double carried_at(const Array& r, const Point3& x) const;
  std::string shape() const;
  void add_time(const std::string& stage, double seconds);

  mutable std::array<Array, 2> products_;  // of an albedo
  double time_ = 0, since_ = 0, last_step_ = 0;
  long long steps_ = 0, equal_steps_ = 0;
  std::vector<scene::StageTime> times_;
};

}  // namespace airlight::legendre_fluids
