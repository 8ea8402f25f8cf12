#include "reference/exact_flows/exact_flows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "scene/base/error.h"

namespace airlight::exact_flows {
namespace {

using scene::FlowProblem;
using scene::Side;

bool sides_are(const FlowProblem& p, int axis, std::initializer_list<Side::Kind> kinds) {
  return std::all_of(p.sides[axis].begin(), p.sides[axis].end(),
                     [&](const Side& side) { return std::find(kinds.begin(), kinds.end(), side.kind) != kinds.end(); });
}

bool carries(const FlowProblem& p) {
  return p.density != 0 || p.temperature != 0 || !p.blobs.empty() || p.wave || p.density_grid;
}
bool is_uniform(const FlowProblem& p) { return p.blobs.empty() && !p.wave && !p.density_grid; }

// Velocity of the wind; 0 for a flow at rest.
Vec3 wind_of(const FlowProblem& p) {
  const auto* wind = std::get_if<scene::Wind>(&p.velocity);
  return wind ? wind->velocity : Vec3(Vec3::Zero());
}

std::string why_velocity_is_unknown(const FlowProblem& p) {
  if (const auto* wind = std::get_if<scene::Wind>(&p.velocity); wind && !wind->gust.isZero(0)) return "a gust";
  if (p.velocity_stays) return "";
  if (!p.pushes.empty()) return "forces";
  if (p.confinement != 0) return "confinement of vorticity";
  const bool buoyant = (p.weight != 0 || p.expansion != 0) && !p.gravity.isZero();
  if (buoyant && !is_uniform(p)) return "buoyancy of what is not uniform";
  if (std::holds_alternative<scene::TaylorGreen>(p.velocity)) {
    for (int a = 0; a < p.dimensions; ++a)
      if (!sides_are(p, a, {Side::Kind::periodic, Side::Kind::free_slip}))
        return "Taylor-Green beside sides that are neither periodic nor free-slip";
    return "";
  }
  if (std::holds_alternative<scene::AtRest>(p.velocity)) {
    for (int a = 0; a < p.dimensions; ++a)
      for (const Side& side : p.sides[a])
        if (!side.velocity.isZero()) return "sides that move";
    return "";
  }
  if (!std::holds_alternative<scene::Wind>(p.velocity))
    return "a swirl or a rotation that moves itself (velocity_stays is false)";
  for (int a = 0; a < p.dimensions; ++a)
    if (!sides_are(p, a, {Side::Kind::periodic}) && !(wind_of(p)[a] == 0 && sides_are(p, a, {Side::Kind::free_slip})))
      return "wind through sides that are not periodic";
  return "";
}

std::string why_carried_is_unknown(const FlowProblem& p) {
  if (!carries(p) || is_uniform(p)) return "";
  if (std::holds_alternative<scene::RigidRotation>(p.velocity) && p.velocity_stays)
    return p.diffusivity != 0 || p.wave ? "diffusion, or a wave, in a rotation" : "";
  if (!std::holds_alternative<scene::Wind>(p.velocity) && !std::holds_alternative<scene::AtRest>(p.velocity))
    return "what a vortex carries";
  if (p.diffusivity != 0 && (!p.blobs.empty() || p.density_grid)) return "diffusion of anything but waves";
  for (int a = 0; a < p.dimensions; ++a)
    if ((wind_of(p)[a] != 0 || p.diffusivity != 0) && !sides_are(p, a, {Side::Kind::periodic}))
      return "what moves or spreads beside sides that are not periodic";
  return "";
}

class ExactFlow : public scene::Flow {
 public:
  ExactFlow(std::shared_ptr<const FlowProblem> problem, int longest) : p_(std::move(problem)) {
    const Vec3 size = p_->box.size();
    cell_ = size.maxCoeff() / longest;
    for (int a = 0; a < 3; ++a) n_[a] = a < p_->dimensions ? std::max(1, int(std::lround(size[a] / cell_))) : 1;
    decay_ = 0;
    if (const auto* vortex = std::get_if<scene::TaylorGreen>(&p_->velocity); vortex && !p_->velocity_stays)
      for (int a = 0; a < 2; ++a) decay_ += p_->viscosity * std::pow(2 * pi * vortex->waves / size[a], 2);
  }

  double time() const override { return time_; }
  void step(double dt) override { time_ += dt; }
  Vec3 velocity(const Point3& x) const override {
    return std::exp(-decay_ * time_) * scene::velocity_at(p_->velocity, p_->box, x);
  }
  double density(const Point3& x) const override {
    const Point3 from = origin_of(x);
    double sum = scene::start_density(*p_, from);
    if (p_->wave) sum += (spread_of_wave() - 1) * scene::wave_at(*p_->wave, p_->box, from);
    return fading() * sum;
  }
  double temperature(const Point3& x) const override { return fading() * scene::start_temperature(*p_, origin_of(x)); }

  scene::DensityField medium(int) const override {
    auto grid = std::make_shared<scene::VoxelGrid>();
    grid->size = n_;
    grid->voxel_size = cell_;
    grid->translation = center(0, 0, 0);
    for_cells([&](const Point3& x) { grid->values.push_back(float(std::max(0.0, density(x)))); });
    return scene::GridPointer(grid);
  }

  scene::Frame frame() const override {
    scene::Frame f;
    f.size = n_;
    f.cell = cell_;
    f.low = p_->box.lo;
    if (carries(*p_)) {
      for_cells([&](const Point3& x) { f.density.push_back(float(density(x))); });
      for_cells([&](const Point3& x) { f.temperature.push_back(float(temperature(x))); });
    }
    for (int k = 0; k <= n_[2]; ++k)
      for (int j = 0; j <= n_[1]; ++j)
        for (int i = 0; i <= n_[0]; ++i)
          for (int a = 0; a < 3; ++a) {
            Point3 x = center(i, j, k);
            x[a] -= 0.5 * cell_;
            f.velocity.push_back(float(velocity(x)[a]));
          }
    return f;
  }

  scene::Totals totals() const override {
    scene::Totals t;
    t.density_least = infinity, t.density_greatest = -infinity;
    const double volume = std::pow(cell_, p_->dimensions);
    Vec3 moment = Vec3::Zero();
    for_cells([&](const Point3& x) {
      const Vec3 u = velocity(x);
      const double d = density(x);
      t.energy += 0.5 * volume * u.squaredNorm();
      t.enstrophy += 0.5 * volume * curl(x).squaredNorm();
      t.mass += volume * d;
      moment += volume * d * x;
      t.density_least = std::min(t.density_least, d);
      t.density_greatest = std::max(t.density_greatest, d);
      t.greatest_speed = std::max(t.greatest_speed, u.cwiseAbs().maxCoeff());
    });
    t.center_of_mass = t.mass > 0 ? Point3(moment / t.mass) : Point3(0.5 * (p_->box.lo + p_->box.hi));
    return t;
  }

  std::vector<scene::StageTime> times() const override { return {}; }
  std::map<std::string, double> counters() const override { return {{"cells", double(n_.prod())}}; }
  std::string state() const override { return std::string(reinterpret_cast<const char*>(&time_), sizeof time_); }
  void restore(const std::string& state) override {
    if (state.size() != sizeof time_)
      throw Error(fmt::format("a state of {} bytes, expected {}", state.size(), sizeof time_));
    std::memcpy(&time_, state.data(), sizeof time_);
  }

 private:
  Point3 center(int i, int j, int k) const {
    Point3 x = p_->box.lo + cell_ * (Vec3(i, j, k) + 0.5 * Vec3::Ones());
    if (p_->dimensions == 2) x[2] = 0;
    return x;
  }
  template <class Body>
  void for_cells(const Body& body) const {
    for (int k = 0; k < n_[2]; ++k)
      for (int j = 0; j < n_[1]; ++j)
        for (int i = 0; i < n_[0]; ++i) body(center(i, j, k));
  }
  double fading() const { return std::exp(-p_->decay * time_); }

  // Where what is at x now was at first.
  Point3 origin_of(const Point3& x) const {
    if (const auto* turn = std::get_if<scene::RigidRotation>(&p_->velocity); turn && !turn->rate.isZero())
      return turn->center +
             Eigen::AngleAxisd(-turn->rate.norm() * time_, turn->rate.normalized()) * Vec3(x - turn->center);
    const Vec3 wind = wind_of(*p_);
    Point3 from = x - time_ * wind;
    const Vec3 size = p_->box.size();
    for (int a = 0; a < p_->dimensions; ++a)
      if (wind[a] != 0) from[a] -= size[a] * std::floor((from[a] - p_->box.lo[a]) / size[a]);
    return from;
  }

  double spread_of_wave() const {
    double k2 = 0;
    for (int a = 0; a < p_->dimensions; ++a) k2 += std::pow(2 * pi * p_->wave->waves[a] / p_->box.size()[a], 2);
    return std::exp(-p_->diffusivity * k2 * time_);
  }

  // By central differences, whose own error is some 1e-9 of it.
  Vec3 curl(const Point3& x) const {
    const double step = 1e-4 * cell_;
    const auto gradient = [&](int component, int axis) {
      Point3 low = x, high = x;
      low[axis] -= step, high[axis] += step;
      return (velocity(high)[component] - velocity(low)[component]) / (2 * step);
    };
    if (p_->dimensions == 2) return {0, 0, gradient(1, 0) - gradient(0, 1)};
    return {gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0), gradient(1, 0) - gradient(0, 1)};
  }

  std::shared_ptr<const FlowProblem> p_;
  Eigen::Vector3i n_;
  double cell_ = 1, time_ = 0, decay_ = 0;
};

}  // namespace

std::string ExactFlows::about() const {
  return "closed forms: rest, wind, Taylor-Green, rotation, and what they carry; other problems are refused";
}

std::vector<scene::SettingSpec> ExactFlows::settings() const {
  return {scene::integer_setting("n", "64", 1, 2048, "cells along the longest axis, of frames and sums over the box")};
}

std::vector<std::string> ExactFlows::supports(const FlowProblem& problem, const scene::Settings&) const {
  std::vector<std::string> reasons;
  const auto unknown = [&](const std::string& what) {
    if (!what.empty()) reasons.push_back("no closed form is known here for " + what);
  };
  if (!problem.sources.empty()) unknown("sources");
  if (!problem.obstacles.empty()) unknown("obstacles");
  if (!problem.densities.empty()) unknown("several densities");
  unknown(why_velocity_is_unknown(problem));
  unknown(why_carried_is_unknown(problem));
  return reasons;
}

std::unique_ptr<scene::Flow> ExactFlows::start_supported(std::shared_ptr<const FlowProblem> problem,
                                                         const scene::Settings& settings,
                                                         const scene::Execution&) const {
  return std::make_unique<ExactFlow>(std::move(problem), int(settings.integer("n")));
}

}  // namespace airlight::exact_flows
