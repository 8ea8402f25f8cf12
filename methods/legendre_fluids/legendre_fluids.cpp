#include "methods/legendre_fluids/legendre_fluids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/legendre_fluids/confined_fluid.h"
#include "methods/legendre_fluids/legendre_flow.h"
#include "methods/legendre_fluids/paper_fluid.h"
#include "methods/legendre_fluids/reference_box.h"

namespace airlight::legendre_fluids {

using scene::FlowProblem;
using scene::Settings;
using scene::Side;

namespace {

using Variant = FlowOptions::Variant;

constexpr double most_steps = 1e8;   // of a frame
constexpr double most_dense = 1000;  // coefficients of a field where systems are dense

void bind_flow(scene::SettingBinder& b, FlowOptions& o) {
  b.choice("variant", o.variant,
           {{"galerkin", Variant::galerkin}, {"paper", Variant::paper}, {"paper_repaired", Variant::paper_repaired}},
           "galerkin: no flow through walls, energy kept; paper: equations 13 to 21, without walls; "
           "paper_repaired: the same, confined after each advection");
  b.integer("n", o.n, 1, 64, "coefficients along each axis");
  b.real("dt", o.dt, 0, 1e9,
         "longest step [s]; 0: a frame. Steps divide a frame evenly; galerkin divides its advection further");
  b.choice("truncation", o.truncation, {{"chebyshev", Truncation::chebyshev}, {"l2", Truncation::l2}},
           "T of the paper's variants")
      .where("variant", {"paper", "paper_repaired"});
  b.choice("mixing", o.mixing, {{"densities", Mixing::densities}, {"albedo", Mixing::albedo}},
           "of two densities move both, or their sum and the first one's share (the paper's albedo)");
  b.real("filter_velocity", o.confined.filter_velocity, 0, 1e9,
         "rate of exp(-rate (k/(n-1))^order t) for coefficient k of an axis [1/s]")
      .where("variant", {"galerkin"});
  b.real("filter_carried", o.confined.filter_carried, 0, 1e9, "the same of density and temperature [1/s]")
      .where("variant", {"galerkin"});
  b.real("filter_order", o.confined.filter_order, 1, 64, "of both")
      .where("variant", {"galerkin"})
      .where("filter_velocity", {"> 0"})
      .or_where("variant", {"galerkin"})
      .where("filter_carried", {"> 0"});
  b.integer("cells", o.cells, 1, 1024, "along the longest axis, of frames and media that are grids");
}

double steps_in_frame(const FlowProblem& problem, const Settings& settings) {
  const double frame = 1 / problem.frame_rate, longest = read_flow_options(settings).dt;
  return longest > 0 ? std::max(1.0, std::ceil(frame / longest * (1 - 1e-9))) : 1;
}

bool has_open_sides(const FlowProblem& p) {
  for (int a = 0; a < p.dimensions; ++a)
    for (const Side& side : p.sides[a])
      if (side.kind == Side::Kind::open) return true;
  return false;
}

// Velocity of a wind that blows through the box; 0 for all other flows.
Vec3 wind_of(const FlowProblem& p) {
  const auto* wind = std::get_if<scene::Wind>(&p.velocity);
  return wind && has_open_sides(p) ? wind->velocity : Vec3(Vec3::Zero());
}
bool blows_along(const FlowProblem& p, int axis) {
  const auto* wind = std::get_if<scene::Wind>(&p.velocity);
  return wind && (wind->velocity[axis] != 0 || wind->gust[axis] != 0);
}

// A velocity that stays and may go through sides, at most linear: what swirls and vortices have is confined.
bool is_given(const FlowProblem& p) {
  return p.velocity_stays &&
         (std::holds_alternative<scene::Wind>(p.velocity) || std::holds_alternative<scene::RigidRotation>(p.velocity));
}

}  // namespace

bool air_comes_in(const FlowProblem& p) { return is_given(p) || has_open_sides(p); }

std::optional<Wind> wind_through(const std::shared_ptr<const FlowProblem>& problem, const ReferenceBox& box) {
  if (!air_comes_in(*problem)) return {};
  Wind wind;
  wind.added = !is_given(*problem);
  wind.incoming.resize(problem->densities.size() + 2);
  if (const auto* blown = std::get_if<scene::Wind>(&problem->velocity)) {
    wind.gust = blown->gust.cwiseQuotient(box.half);
    wind.frequency = blown->frequency;
  }
  const Vec3 through = wind_of(*problem);
  if (wind.added)
    wind.velocity = [=](const Vec3&) -> Vec3 { return through.cwiseQuotient(box.half); };
  else
    wind.velocity = [=](const Vec3& x) -> Vec3 {
      return scene::start_velocity(*problem, box.outside(x)).cwiseQuotient(box.half);
    };
  for (int a = 0; a < problem->dimensions; ++a)
    for (int side = 0; side < 2; ++side) {
      const Side& from = problem->sides[a][side];
      wind.incoming[std::size_t(from.of)][a][side] = from.density;
      wind.incoming.back()[a][side] = from.temperature;
    }
  return wind;
}

namespace {

void object_to_sides(const FlowProblem& p, std::vector<std::string>& reasons) {
  for (int a = 0; a < p.dimensions; ++a)
    for (const Side& side : p.sides[a]) {
      if (side.kind == Side::Kind::periodic || side.kind == Side::Kind::no_slip) {
        reasons.push_back(fmt::format("sides of axis {} are {}, expected free_slip, or open for wind", "xyz"[a],
                                      scene::side_name(side.kind)));
        break;
      }
    }
  if (const auto* wind = std::get_if<scene::Wind>(&p.velocity); wind && !wind->gust.isZero(0) && !air_comes_in(p))
    reasons.push_back("a gust without open sides");
  if (p.velocity_stays && p.velocity_grid) reasons.push_back("a grid of velocities that stays");
  if (!has_open_sides(p) || is_given(p)) return;
  if (!std::holds_alternative<scene::Wind>(p.velocity))
    reasons.push_back("open sides where the velocity is neither a wind nor a rotation that stays");
  for (int a = 0; a < p.dimensions; ++a)
    for (const Side& side : p.sides[a])
      if ((side.kind == Side::Kind::open) != blows_along(p, a)) {
        reasons.push_back(
            fmt::format("sides of axis {} are {}, expected open where the wind goes through, else free_slip", "xyz"[a],
                        scene::side_name(side.kind)));
        break;
      }
}

// mixing = albedo moves the sum of two densities and the first one's share, which has no sources or
// inflow and does not diffuse.
void object_to_albedo(const FlowProblem& problem, std::vector<std::string>& reasons) {
  const std::string mixing = "mixing = albedo with ";
  if (problem.densities.size() != 1)
    reasons.push_back(fmt::format("{}{} densities, expected 2", mixing, problem.densities.size() + 1));
  for (const scene::Source& s : problem.sources)
    if (s.density_rate != 0) {
      reasons.push_back(mixing + "sources of a density");
      break;
    }
  if (air_comes_in(problem)) reasons.push_back(mixing + "air that comes in");
  if (problem.diffusivity > 0) reasons.push_back(mixing + "diffusivity");
}

// Reasons why the paper's variants do not support the problem.
void object_to_paper(const FlowProblem& problem, const Settings& settings, std::vector<std::string>& reasons) {
  const std::string& variant = settings.text("variant");
  const FlowOptions o = read_flow_options(settings);
  if (has_open_sides(problem)) reasons.push_back(variant + " with open sides: its operators know no inflow");
  if (const auto* wind = std::get_if<scene::Wind>(&problem.velocity); wind && !wind->gust.isZero(0))
    reasons.push_back(variant + " with a gust");
  const double coefficients = std::pow(double(o.n), problem.dimensions);
  if (o.variant == Variant::paper && coefficients > most_dense)
    reasons.push_back(
        fmt::format("paper with {:.0f} coefficients of a field: it solves dense systems of at most {:.0f}",
                    coefficients, most_dense));
}

}  // namespace

FlowOptions read_flow_options(const Settings& settings) { return scene::read_settings(bind_flow, settings); }

std::string LegendreFluids::about() const {
  return "Gupta and Narasimhan 2007: velocity and density in n Legendre coefficients along each axis of a box";
}

std::vector<scene::SettingSpec> LegendreFluids::settings() const { return scene::list_settings(bind_flow); }

std::vector<std::string> LegendreFluids::supports(const FlowProblem& problem, const Settings& settings) const {
  const FlowOptions o = read_flow_options(settings);
  std::vector<std::string> reasons;
  object_to_sides(problem, reasons);
  if (!problem.obstacles.empty()) reasons.push_back("obstacles: polynomials of the whole box know none");
  if (problem.confinement != 0) reasons.push_back("confinement of vorticity");
  for (const scene::Source& s : problem.sources)
    if (s.density || s.temperature || s.velocity) {
      reasons.push_back("sources that hold a value, expected rates");
      break;
    }
  if (o.mixing == Mixing::albedo) object_to_albedo(problem, reasons);
  if (o.variant != Variant::galerkin) object_to_paper(problem, settings, reasons);
  if (is_given(problem) && o.n < 2) reasons.push_back("n = 1 where air comes in, expected 2 or more");
  if (const double steps = steps_in_frame(problem, settings); steps > most_steps)
    reasons.push_back(
        fmt::format("dt = {:g} makes {:.3g} steps of a frame, expected at most {:g}", o.dt, steps, most_steps));
  return reasons;
}

int LegendreFluids::steps_per_frame(const FlowProblem& problem, const Settings& settings) const {
  return int(std::min(most_steps, steps_in_frame(problem, settings)));
}

std::unique_ptr<scene::Flow> LegendreFluids::start_supported(std::shared_ptr<const FlowProblem> problem,
                                                             const Settings& settings, const scene::Execution&) const {
  const ReferenceBox box(*problem);
  const FlowOptions o = read_flow_options(settings);
  const Material material{problem->viscosity, problem->diffusivity, !problem->velocity_stays};
  std::unique_ptr<Fluid> fluid;
  if (o.variant == Variant::galerkin)
    fluid = std::make_unique<ConfinedFluid>(box.dimensions, o.n, box.half, material, o.confined,
                                            wind_through(problem, box));
  else
    fluid = std::make_unique<PaperFluid>(box.dimensions, o.n, box.half, material, o.truncation,
                                         o.variant == Variant::paper_repaired);
  return std::make_unique<LegendreFlow>(std::move(problem), std::move(fluid), o.cells, o.mixing);
}

}  // namespace airlight::legendre_fluids
