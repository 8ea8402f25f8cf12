// Adaptive Gauss-Kronrod quadrature of a colour-valued integrand, and the change of variable that tames 1/distance^2.
//
// The caller cuts the range into panels at every point where its integrand is not smooth; each panel is bisected until
// the sum of the error estimates meets the tolerance in every channel. Estimates: |Kronrod - Gauss|, or where the
// integrand is resolved the sharper power law of QUADPACK (Piessens et al. 1983), with rounding as the floor.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

// Kronrod nodes in (-1, 1) with the Gauss rule nested in them. Only half is stored: node 0 is the centre, node i > 0
// stands for +-node[i].
struct KronrodRule {
  int half;  // stored nodes
  std::array<double, 8> node;
  std::array<double, 8> weight;
  std::array<double, 8> gauss_weight;  // 0 where the node is not a Gauss node
};
const KronrodRule& kronrod7();   // 3-point Gauss inside: for many short panels
const KronrodRule& kronrod15();  // 7-point Gauss inside: for few long ones

struct Panel {
  double lo = 0;
  double hi = 0;
  int chart = 0;  // passed on to the integrand, which knows what [lo, hi] means there
  Rgb value = Rgb::Zero();
  Rgb error = Rgb::Zero();
};

struct QuadratureOptions {
  double relative_tolerance = 1e-10;       // of the integral, per channel; 0 asks for rounding level
  Rgb absolute_tolerance = Rgb::Zero();    // met as well counts as converged
  long max_evaluations = 100000;           // a panel under way is finished
  const KronrodRule* rule = &kronrod15();  // of every panel
};

struct Integral {
  Rgb value = Rgb::Zero();
  Rgb error = Rgb::Zero();  // estimate, absolute
  long evaluations = 0;
  bool converged = true;
};

// Estimates one panel in place. f(chart, u) -> Rgb, never called at the ends.
template <class F>
void estimate_panel(F&& f, const KronrodRule& rule, Panel& p) {
  const double center = 0.5 * (p.lo + p.hi);
  const double half = 0.5 * (p.hi - p.lo);
  std::array<Rgb, 15> values;
  values[0] = f(p.chart, center);
  Rgb kronrod = rule.weight[0] * values[0];
  Rgb gauss = rule.gauss_weight[0] * values[0];
  Rgb magnitude = rule.weight[0] * values[0].abs();
  for (int i = 1; i < rule.half; ++i) {
    const double step = half * rule.node[i];
    values[2 * i - 1] = f(p.chart, center - step);
    values[2 * i] = f(p.chart, center + step);
    const Rgb pair = values[2 * i - 1] + values[2 * i];
    kronrod += rule.weight[i] * pair;
    gauss += rule.gauss_weight[i] * pair;
    magnitude += rule.weight[i] * (values[2 * i - 1].abs() + values[2 * i].abs());
  }
  const Rgb mean = 0.5 * kronrod;
  Rgb deviation = rule.weight[0] * (values[0] - mean).abs();
  for (int i = 1; i < rule.half; ++i)
    deviation += rule.weight[i] * ((values[2 * i - 1] - mean).abs() + (values[2 * i] - mean).abs());
  const double width = std::abs(half);
  p.value = kronrod * half;
  const Rgb difference = (kronrod - gauss).abs() * width;
  deviation *= width;
  magnitude *= width;
  for (int c = 0; c < 3; ++c) {
    double error = difference[c];
    if (deviation[c] > 0) error = std::min(error, deviation[c] * std::pow(200 * error / deviation[c], 1.5));
    // Rounding of the sum; NaN and infinity pass through.
    p.error[c] = std::max(error, 4e-16 * magnitude[c]);
    if (!std::isfinite(p.value[c])) p.error[c] = p.value[c];
  }
}

// True if the errors meet the tolerance, or cannot be told from rounding.
bool within_tolerance(const Rgb& value, const Rgb& error, const QuadratureOptions&);

// Bisects the panel with the largest error, relative to the whole, until the tolerance is met or the evaluations are
// spent; the panels must have been estimated. `used` counts evaluations already spent on them. The panels are left as
// the final subdivision.
template <class F>
Integral refine_panels(F&& f, std::vector<Panel>& panels, const QuadratureOptions& options, long used) {
  Integral result;
  result.evaluations = used;
  for (const Panel& p : panels) {
    result.value += p.value;
    result.error += p.error;
  }
  const Rgb scale = result.value.abs().max(1e-300) + options.absolute_tolerance;
  const auto urgency = [&](const Panel& p) { return (p.error / scale).maxCoeff(); };
  const auto less = [&](const Panel& a, const Panel& b) { return urgency(a) < urgency(b); };
  const long per_panel = 2 * options.rule->half - 1;
  std::make_heap(panels.begin(), panels.end(), less);
  while (!within_tolerance(result.value, result.error, options)) {
    if (panels.empty() || result.evaluations + 2 * per_panel > options.max_evaluations || !result.value.allFinite()) {
      result.converged = false;
      break;
    }
    std::pop_heap(panels.begin(), panels.end(), less);
    const Panel parent = panels.back();
    panels.pop_back();
    const double middle = 0.5 * (parent.lo + parent.hi);
    if (!(middle > parent.lo && middle < parent.hi)) {  // no number in between: this is as good as it gets
      panels.push_back(parent);
      result.converged = false;
      break;
    }
    for (Panel child : {Panel{parent.lo, middle, parent.chart}, Panel{middle, parent.hi, parent.chart}}) {
      estimate_panel(f, *options.rule, child);
      result.value += child.value;
      result.error += child.error;
      panels.push_back(child);
      std::push_heap(panels.begin(), panels.end(), less);
    }
    result.value -= parent.value;
    result.error -= parent.error;
    result.evaluations += 2 * per_panel;
  }
  // The running sums carry the rounding of every parent that came and went.
  result.value.setZero();
  result.error.setZero();
  for (const Panel& p : panels) {
    result.value += p.value;
    result.error += p.error;
  }
  return result;
}

// Estimates and refines.
template <class F>
Integral integrate(F&& f, std::vector<Panel> panels, const QuadratureOptions& options = {}) {
  long used = 0;
  for (Panel& p : panels) {
    estimate_panel(f, *options.rule, p);
    used += 2 * options.rule->half - 1;
  }
  return refine_panels(f, panels, options, used);
}

// A stretch [xa, xb] of a line, x measured from the foot of the perpendicular from a point at distance h >= 0, on one
// side of the foot (xa xb >= 0), |xa| or |xb| may be infinite. u in [0, 1] steps by equal angles as seen from the
// point, so that
//   dx / (x^2 + h^2) = density * du,
// a constant: the inverse square disappears. Well conditioned for h -> 0 also at h = 0 (Zhou et al. 2007; the
// half-angle form of the tangent avoids the difference of two angles near pi/2). An end at x = 0 with h = 0 has density
// infinity.
class EquiangularMap {
 public:
  EquiangularMap(double xa, double xb, double h);
  double x(double u) const;
  double density() const { return density_; }

 private:
  double near_, far_, h_, angle_, density_, sign_;
  bool reversed_;
};

}  // namespace airlight::scene
