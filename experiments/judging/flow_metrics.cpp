#include "experiments/judging/flow_metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "scene/base/error.h"
#include "scene/base/nearest.h"

namespace airlight::experiments {
namespace {

constexpr int samples_along = 61;
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

const std::vector<std::string> against_reference = {"velocity.rel_l2",  "velocity.greatest",  "density.rel_l2",
                                                    "density.greatest", "temperature.rel_l2", "temperature.greatest"};
const std::vector<std::string> alone = {"density.contrast", "density.asymmetry", "energy_drift", "mass_drift",
                                        "greatest_speed",   "center_y",          "enstrophy",    "mass",
                                        "divergence_max",   "minimum",           "maximum",      "energy_growth",
                                        "center_falls"};

const std::vector<double>& field(const FlowSample& s, const std::string& base) {
  return base.starts_with("velocity") ? s.velocity : base.starts_with("density") ? s.density : s.temperature;
}

double rel_l2(const std::vector<double>& a, const std::vector<double>& r) {
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += (a[i] - r[i]) * (a[i] - r[i]);
    norm += r[i] * r[i];
  }
  return norm > 0 ? std::sqrt(difference / norm) : undefined;
}

// Greatest difference over the greatest norm, for vectors of `width` numbers.
double greatest(const std::vector<double>& a, const std::vector<double>& r, std::size_t width) {
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); i += width) {
    double d = 0, n = 0;
    for (std::size_t c = i; c < i + width; ++c) {
      d += (a[c] - r[c]) * (a[c] - r[c]);
      n += r[c] * r[c];
    }
    difference = std::max(difference, d);
    norm = std::max(norm, n);
  }
  return norm > 0 ? std::sqrt(difference / norm) : undefined;
}

double drift(double now, double before) { return before > 0 ? now / before - 1 : undefined; }

double asymmetry(const FlowMoment& m) {
  const double along_x = greatest(m.mirrored[0].density, m.here.density, 1);
  return m.mirrored[1].density.empty() ? along_x
                                       : std::max(along_x, greatest(m.mirrored[1].density, m.here.density, 1));
}

// Over the frames up to now.
double over_frames(const std::string& base, const std::vector<scene::Totals>& frames) {
  double worst = base == "minimum" ? infinity : base == "maximum" ? -infinity : 0, before = infinity;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const scene::Totals& t = frames[i];
    if (base == "divergence_max") worst = std::max(worst, t.divergence);
    if (base == "minimum") worst = std::min(worst, t.density_least);
    if (base == "maximum") worst = std::max(worst, t.density_greatest);
    if (base == "energy_growth") {
      if (i > 0 && before > 0) worst = std::max(worst, t.energy / before - 1);
      before = std::min(before, t.energy);
    }
    if (base == "center_falls" && i > 0 && frames[i - 1].mass > 0)
      worst = std::max(worst, frames[i - 1].center_of_mass[1] - t.center_of_mass[1]);
  }
  return worst;
}

}  // namespace

FlowMetric parse_flow_metric(const std::string& name, const std::string& where) {
  std::vector<std::string> names = against_reference;
  names.insert(names.end(), alone.begin(), alone.end());
  FlowMetric metric{name.substr(0, name.find('@')), {}};
  if (std::find(names.begin(), names.end(), metric.base) == names.end())
    throw Error(fmt::format(
        "{}: unknown metric '{}' of flows, expected one of {}, with @ and a time in seconds for any but the "
        "end{}",
        where, name, fmt::join(names, ", "), scene::nearest_hint(metric.base, names)));
  if (metric.base.size() == name.size()) return metric;
  const char *begin = name.data() + metric.base.size() + 1, *end = name.data() + name.size();
  double time = 0;
  const auto [stop, code] = std::from_chars(begin, end, time);
  if (code != std::errc() || stop != end || !(time >= 0) || !std::isfinite(time))
    throw Error(fmt::format("{}: '{}', expected a time in seconds after the @", where, name));
  metric.time = time;
  return metric;
}

bool needs_reference(const FlowMetric& metric) {
  return std::find(against_reference.begin(), against_reference.end(), metric.base) != against_reference.end();
}

double deviation(const std::vector<double>& a) {
  double sum = 0, squares = 0;
  for (const double x : a) sum += x;
  for (const double x : a) squares += std::pow(x - sum / double(a.size()), 2);
  return std::sqrt(squares / double(a.size()));
}

bool needs_samples(const FlowMetric& metric) {
  return needs_reference(metric) || metric.base == "density.contrast" || metric.base == "density.asymmetry";
}

std::vector<Point3> sample_points(const scene::FlowProblem& problem) {
  const Vec3 size = problem.box.size();
  const double cell = size.maxCoeff() / samples_along;
  Eigen::Vector3i n = Eigen::Vector3i::Ones();
  for (int a = 0; a < problem.dimensions; ++a) n[a] = std::max(1, int(std::lround(size[a] / cell)));
  std::vector<Point3> points;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        points.emplace_back(problem.box.lo +
                            Vec3((i + 0.5) / n[0], (j + 0.5) / n[1], (k + 0.5) / n[2]).cwiseProduct(size));
  return points;
}

FlowSample sample(const scene::Flow& flow, const std::vector<Point3>& points) {
  FlowSample s;
  for (const Point3& x : points) {
    const Vec3 u = flow.velocity(x);
    s.velocity.insert(s.velocity.end(), {u[0], u[1], u[2]});
    s.density.push_back(flow.density(x));
    s.temperature.push_back(flow.temperature(x));
  }
  return s;
}

double flow_figure(const std::string& base, const FlowMoment& m) {
  const scene::Totals &now = m.totals.back(), &first = m.totals.front();
  if (base.ends_with(".rel_l2")) return rel_l2(field(m.here, base), field(*m.reference, base));
  if (base.ends_with(".greatest"))
    return greatest(field(m.here, base), field(*m.reference, base), base.starts_with("velocity") ? 3 : 1);
  if (base == "density.contrast")
    return m.deviation_at_start > 0 ? deviation(m.here.density) / m.deviation_at_start : undefined;
  if (base == "density.asymmetry") return asymmetry(m);
  if (base == "energy_drift") return drift(now.energy, first.energy);
  if (base == "mass_drift") return drift(now.mass, first.mass);
  if (base == "greatest_speed") return now.greatest_speed;
  if (base == "center_y") return now.center_of_mass[1];
  if (base == "enstrophy") return now.enstrophy;
  if (base == "mass") return now.mass;
  return over_frames(base, m.totals);
}

}  // namespace airlight::experiments
