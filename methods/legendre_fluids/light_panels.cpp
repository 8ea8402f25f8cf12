#include "methods/legendre_fluids/light_panels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/math/legendre.h"
#include "scene/math/legendre_range.h"

namespace airlight::legendre_fluids {
namespace {

constexpr int most_points = 16, most_halvings = 48;
constexpr double black = 740;  // exp(-black) is 0, or nearly

}  // namespace

PanelRule::PanelRule(int n, int points, double tolerance) : n_(n), points_(points), tolerance_(tolerance) {
  for (const double lo : {-1.0, 0.0}) {
    const Eigen::MatrixXd restriction = scene::legendre_restriction(n, lo, lo + 1);
    half_.insert(half_.end(), restriction.data(), restriction.data() + restriction.size());
  }
  const scene::LegendrePoints rule(n, points);
  for (int k = 0; k < n; ++k)
    for (int p = 0; p < points; ++p) values_.push_back(rule.values(p, k));
  weight_.assign(rule.weight.data(), rule.weight.data() + points);
  for (int k = 0; k < n; ++k) greatest_.push_back(std::sqrt(k + 0.5));
}

struct PanelRule::Integral {
  const PanelRule& rule;
  int depths, sources;
  Rgb& sum;
  Work& work;

  std::size_t size() const { return std::size_t((depths + sources) * rule.n_); }

  // Depths first, then sources. The panel has a share of the range, `scale` with it.
  void add(const double* series, double scale, int halvings) {
    if (enough(series, scale) || halvings == most_halvings) return add_points(series, scale);
    const std::size_t at = std::size_t(2 * halvings) * size();
    double* half[] = {work.series.data() + at, work.series.data() + at + size()};
    for (int upper = 0; upper < 2; ++upper) restrict(series, upper, half[upper]);
    const bool first = half[1][0] < half[0][0];
    for (const bool upper : {first, !first}) add(half[upper], 0.5 * scale, halvings + 1);
  }

  void restrict(const double* series, int upper, double* half) const {
    const int n = rule.n_;
    std::fill(half, half + size(), 0.0);
    for (int s = 0; s < depths + sources; ++s, series += n, half += n) {
      const double* column = rule.half_.data() + upper * n * n;
      for (int j = 0; j < n; ++j, column += n)
        for (int i = 0; i <= j; ++i) half[i] += column[i] * series[j];
    }
  }

  bool enough(const double* series, double scale) const {
    const int n = rule.n_, exact = 2 * rule.points_;
    for (int c = 0; c < std::max(depths, sources); ++c) {
      const double* depth = series + (depths == 1 ? 0 : c * n);
      const double* source = series + (depths + (sources == 1 ? 0 : c)) * n;
      const double mean = depth[0] * rule.greatest_[0];
      // Orders of exp(-e) have coefficients of at most those of the power series exp(sum a_k x^k), with half of e's as a_k, twice.
      std::array<double, 2 * most_points + 1> by_order, order;
      double range = 0, most = 0;
      for (int k = 1; k < n; ++k) {
        const double greatest = std::abs(depth[k]) * rule.greatest_[std::size_t(k)];
        range += greatest;
        if (k <= exact) by_order[std::size_t(k)] = 0.5 * k * greatest;
      }
      if (mean - range > black) continue;
      order[0] = 1;
      for (int m = 1; m <= exact; ++m) {
        double sum_over = 0;
        for (int k = 1; k <= m && k < n; ++k) sum_over += by_order[std::size_t(k)] * order[std::size_t(m - k)];
        order[std::size_t(m)] = sum_over / m;
      }
      double error = 0, beyond = 0;  // beyond: what a source of order k makes of order 2 points and more
      for (int k = 0; k < n; ++k) {
        const double greatest = std::abs(source[k]) * rule.greatest_[std::size_t(k)];
        most += greatest;
        if (k <= exact) beyond += 2 * order[std::size_t(exact - k)];
        error += greatest * std::min(1.0, beyond);
      }
      const double here = scale * most * std::exp(-mean);
      if (!(2 * scale * error * std::exp(-std::max(0.0, mean - range)) <= rule.tolerance_ * (sum[c] + here)))
        return false;
    }
    return true;
  }

  void add_points(const double* series, double scale) const {
    ++work.panels;
    const int n = rule.n_, points = rule.points_;
    std::array<std::array<double, most_points>, 6> values{};
    for (int s = 0; s < depths + sources; ++s) {
      const double* at = rule.values_.data();
      for (int k = 0; k < n; ++k, at += points)
        for (int p = 0; p < points; ++p) values[std::size_t(s)][std::size_t(p)] += series[s * n + k] * at[p];
    }
    for (int s = 0; s < depths; ++s)
      for (int p = 0; p < points; ++p) {
        double& v = values[std::size_t(s)][std::size_t(p)];
        v = rule.weight_[std::size_t(p)] * std::exp(-v);
      }
    for (int c = 0; c < 3; ++c) {
      const auto& light = values[std::size_t(depths == 1 ? 0 : c)];
      const auto& source = values[std::size_t(depths + (sources == 1 ? 0 : c))];
      double total = 0;
      for (int p = 0; p < points; ++p) total += light[std::size_t(p)] * source[std::size_t(p)];
      sum[c] += scale * total;
      if (depths == 1 && sources == 1) {
        sum[1] = sum[2] = sum[0];
        break;
      }
    }
  }
};

void PanelRule::add(const PanelSeries& series, double scale, Rgb& sum, Work& work) const {
  Integral integral{*this, series.depths, series.sources, sum, work};
  const std::size_t size = std::size_t(2 * most_halvings) * integral.size();
  if (work.series.size() < size) work.series.resize(size);
  integral.add(series.coefficients.data(), scale, 0);
}

}  // namespace airlight::legendre_fluids
