#include <fmt/format.h>

#include <cmath>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/stable_fluids/cavity.h"
#include "experiments/stable_fluids/probes.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

using verification::Value;

CavityTable table_of(const Value& file, const std::string& id) {
  const Value vectors = file["vectors"];
  for (std::size_t i = 0; i < vectors.size(); ++i)
    if (vectors[i]["id"].text() == id) return read_cavity_table(vectors[i]);
  vectors.complain("a vector with id " + id);
}

struct Difference {
  double greatest = 0, squares = 0;
  int count = 0;
  void add(double d) {
    greatest = std::max(greatest, std::abs(d));
    squares += d * d;
    ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
};

// Values to compare with the known ones: from a flow, or a table.
using Curve = std::function<double(double)>;
Difference difference(const std::vector<double>& places, const std::vector<double>& known, const Curve& curve) {
  Difference d;
  for (std::size_t i = 0; i < places.size(); ++i) d.add(curve(places[i]) - known[i]);
  return d;
}

void add(Findings& found, const std::string& what, const Difference& d) {
  found.figures.push_back(exactly(what, d.greatest));
  found.figures.push_back(exactly(what + "_rms", d.rms()));
}

// The heights that both tables have.
Difference of_tables(const CavityTable& a, const std::vector<double>& u, const CavityTable& b,
                     const std::vector<double>& v) {
  Difference d;
  for (std::size_t i = 0; i < a.y.size(); ++i)
    for (std::size_t k = 0; k < b.y.size(); ++k)
      if (a.y[i] == b.y[k]) d.add(u[i] - v[k]);
  return d;
}

const CavityProfiles& require(const CavityTable& table, double reynolds, const std::string& whose) {
  const CavityProfiles* found = table.find(reynolds);
  if (!found) throw Error(fmt::format("{} have no values at a Reynolds number of {:g}", whose, reynolds));
  return *found;
}

}  // namespace

std::string CavityProbe::about() const {
  return "steady flow below a moving lid against spectral solutions and Ghia et al. 1982";
}

std::vector<scene::SettingSpec> CavityProbe::settings() const {
  return {scene::choice_setting("curve", "solver", {"solver", "spectral", "ghia"},
                                "what is judged: the solver, or known values for a plot"),
          scene::choice_setting("lid", "regularized", {"regularized", "unit"}, "16 x^2 (1-x)^2, or 1, in m/s"),
          scene::real_setting("reynolds", "100", 1, 1e4, "of the side and the lid"),
          scene::integer_setting("n", "48", 2, 1024, "cells a side"),
          scene::real_setting("cfl", "0", 0, 100, "the lid's way a step [cells]; 0: 1 up to Reynolds 400, 0.25 beyond"),
          scene::real_setting("seconds", "0", 0, 1e4, "from rest; 0: 25 up to Reynolds 100, 50 beyond")};
}

std::vector<std::string> CavityProbe::figures() const {
  return {"u", "u_rms", "v", "v_rms", "ghia_u", "ghia_u_rms", "change", "divergence", "steps"};
}

Findings CavityProbe::run(const ProbeInput& input, const scene::Settings& s, const scene::Execution& execution) const {
  if (input.file.empty()) throw Error("cavity needs a [[scene]] whose file holds vectors");
  const nlohmann::json json = read_json(input.file.string());
  const Value file(json, input.file.string());
  const bool regularized = s.text("lid") == "regularized";
  const std::string& curve = s.text("curve");
  const double reynolds = s.real("reynolds");
  const CavityTable spectral = table_of(file, regularized ? "fluid-cavity-regular" : "fluid-cavity-lid");
  const CavityTable ghia = table_of(file, "fluid-ghia-u");
  const CavityProfiles& known = require(spectral, reynolds, "the spectral solutions");
  const CavityProfiles* by_ghia = regularized ? nullptr : ghia.find(reynolds);
  Findings found;
  if (curve == "ghia") {
    if (regularized) throw Error("Ghia et al. have lid = unit only");
    const CavityProfiles& points = require(ghia, reynolds, "Ghia et al.");
    add(found, "u", of_tables(ghia, points.u, spectral, known.u));
    found.columns = {{"y", ghia.y}, {"u", points.u}};
    return found;
  }
  if (curve == "spectral") {
    if (by_ghia) add(found, "ghia_u", of_tables(ghia, by_ghia->u, spectral, known.u));
    found.columns = {{"y", spectral.y}, {"u", known.u}, {"x", spectral.x}, {"v", known.v}};
    return found;
  }
  Cavity cavity = usual_cavity(reynolds, regularized, int(s.integer("n")));
  if (s.real("cfl") > 0) cavity.cfl = s.real("cfl");
  if (s.real("seconds") > 0) cavity.seconds = s.real("seconds");
  const SteadyFlow steady = steady_flow(cavity, execution);
  const Curve u = [&](double y) { return steady.flow->velocity(on_vertical(y))[0]; };
  const Curve v = [&](double x) { return steady.flow->velocity(on_horizontal(x))[1]; };
  add(found, "u", difference(spectral.y, known.u, u));
  add(found, "v", difference(spectral.x, known.v, v));
  if (by_ghia) add(found, "ghia_u", difference(ghia.y, by_ghia->u, u));
  for (int i = 0; i <= cavity.n; ++i) {
    const double at = double(i) / cavity.n;
    found.columns["y"].push_back(at);
    found.columns["u"].push_back(u(at));
    found.columns["x"].push_back(at);
    found.columns["v"].push_back(v(at));
  }
  found.figures.push_back(exactly("change", steady.change));
  found.figures.push_back(exactly("divergence", steady.flow->totals().divergence));
  found.figures.push_back(exactly("steps", steady.flow->counters().at("steps")));
  return found;
}

}  // namespace airlight::experiments
