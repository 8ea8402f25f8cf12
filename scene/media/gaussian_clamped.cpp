// The integral of max(0, f) along a ray for sums with negative amplitudes.
#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/math/bernstein.h"
#include "scene/media/gaussian_line.h"

namespace airlight::scene {
namespace {

// Beyond it exp(-x^2) is 0 in double precision.
constexpr double underflow_widths = 27.4;
// A Gaussian is a polynomial of degree 9 to 3e-14 of its amplitude over this many widths:
// 2/10! (length/4)^10 max |d^10/dx^10 exp(-x^2)|.
constexpr double polynomial_widths = 0.25;

struct Term {
  GaussianLines<double> line;
  Interval reach;  // where it is not zero

  double value(double t) const {
    const double u = (t - line.middle) / line.width;
    return line.amplitude * exp_minus(line.exponent + u * u);
  }
  // Range over a piece that lies within the reach.
  Interval bounds(Interval t) const {
    const double ends[2] = {value(t.lo), value(t.hi)};
    const double nearest = value(std::clamp(line.middle, t.lo, t.hi));
    return {std::min({ends[0], ends[1], nearest}), std::max({ends[0], ends[1], nearest})};
  }
};

// `terms` reach all over t.
double positive_part(const std::vector<Term>& terms, double constant, Interval t) {
  double lo = constant, hi = constant, magnitude = constant;
  bool smooth = true;
  std::vector<Term> near;
  for (const Term& term : terms) {
    const Interval bounds = term.bounds(t);
    if (bounds.lo == 0 && bounds.hi == 0) continue;
    lo += bounds.lo;
    hi += bounds.hi;
    magnitude += std::max(-bounds.lo, bounds.hi);
    near.push_back(term);
  }
  if (hi <= 0) return 0;
  if (lo >= 0) {
    double integral = constant * (t.hi - t.lo);
    for (const Term& term : near) integral += scene::integral(term.line, {t.lo, t.hi});
    return integral;
  }
  // A term much smaller than the rest need not be resolved.
  for (const Term& term : near) {
    const Interval bounds = term.bounds(t);
    if (std::max(-bounds.lo, bounds.hi) > 1e-15 * magnitude)
      smooth &= t.hi - t.lo <= polynomial_widths * term.line.width;
  }
  const double middle = 0.5 * (t.lo + t.hi);
  if (!smooth && middle > t.lo && middle < t.hi)
    return positive_part(near, constant, {t.lo, middle}) + positive_part(near, constant, {middle, t.hi});

  Bernstein values;
  for (int k = 0; k < bernstein_size; ++k) {
    values[k] = constant;
    for (const Term& term : near) values[k] += term.value(t.lo + bernstein_nodes()[k] * (t.hi - t.lo));
  }
  return (t.hi - t.lo) * integral_of_positive_part(bernstein_through(values), 1e-15 * magnitude);
}

}  // namespace

double clamped_line_integral(const GaussianSum& sum, const Ray& ray, Interval t) {
  std::vector<Term> terms;
  std::vector<double> edges;
  for (const Gaussian& g : sum.gaussians) {
    const GaussianLines<double> line = along(load(g), ray);
    const Range<double> reach = within_cutoff(line, std::min(sum.cutoff, underflow_widths), {t.lo, t.hi});
    if (!(reach.lo < reach.hi) || g.amplitude == 0) continue;
    terms.push_back({line, {reach.lo, reach.hi}});
    edges.push_back(reach.lo);
    edges.push_back(reach.hi);
  }
  if (terms.empty()) return sum.constant > 0 ? sum.constant * (t.hi - t.lo) : 0;
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  double integral = 0;
  if (sum.constant > 0) integral = sum.constant * ((edges.front() - t.lo) + (t.hi - edges.back()));

  // Between two edges the set of terms does not change: the jumps at a cutoff lie on them.
  std::vector<Term> here;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    here.clear();
    for (const Term& term : terms)
      if (term.reach.lo <= edges[i] && term.reach.hi >= edges[i + 1]) here.push_back(term);
    integral += positive_part(here, sum.constant, {edges[i], edges[i + 1]});
  }
  return integral;
}

}  // namespace airlight::scene
