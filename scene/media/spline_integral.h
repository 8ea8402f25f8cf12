// Integrals of a spline map times a factor of the height, over the cells that a walk chooses to visit.
#pragma once
#include <array>

#include "scene/base/kinds.h"
#include "scene/math/gauss_legendre.h"
#include "scene/media/spline_map.h"

namespace airlight::scene {
namespace spline_integral {

inline constexpr int most_points = most_spline_degree + 6;

// Nodes on [0, 1] and weights of the rule of m points.
struct UnitRule {
  std::array<double, most_points> node{}, weight{};
};
inline const UnitRule& unit_rule(int m) {
  static const std::array<UnitRule, most_points + 1> rules = [] {
    std::array<UnitRule, most_points + 1> all{};
    for (int n = 1; n <= most_points; ++n) {
      const GaussLegendre rule = gauss_legendre(n);
      for (int k = 0; k < n; ++k) {
        all[n].node[k] = 0.5 + 0.5 * rule.node[k];
        all[n].weight[k] = 0.5 * rule.weight[k];
      }
    }
    return all;
  }();
  return rules[m];
}

// f in a cell, at local positions.
template <int n>
double in_cell(const double* c, std::ptrdiff_t stride, double u, double v) {
  double a[n + 1], b[n + 1];
  cell_basis<n>(u, a);
  cell_basis<n>(v, b);
  double sum = 0;
  for (int k = 0; k <= n; ++k) {
    double row = 0;
    for (int m = 0; m <= n; ++m) row += a[m] * c[-m - k * stride];
    sum += b[k] * row;
  }
  return sum;
}

// A piece of the line within one cell.
struct Piece {
  const double* c;
  std::ptrdiff_t stride;
  double u, v;  // local, at t = 0
  double from, to;
};

// Integral of f(t) (a + b t) over the piece.
template <int n>
double linear_piece(const Piece& p, const MapLine& line, double a, double b) {
  const UnitRule& rule = unit_rule(n + 1);
  const double length = p.to - p.from;
  double sum = 0;
  for (int k = 0; k <= n; ++k) {
    const double t = p.from + rule.node[k] * length;
    sum += rule.weight[k] * (a + b * t) * in_cell<n>(p.c, p.stride, p.u + t * line.du, p.v + t * line.dv);
  }
  return length * sum;
}

// Integral of f(t) exp(-(y(t) - base) / scale) over a piece that lies above the base. Parts of at most one scale height
// are summed from the lower end until the rest is below rounding.
template <int n>
double exponential_piece(const Piece& p, const MapLine& line, const ExponentialFall& fall) {
  constexpr int points = n + 6;
  constexpr double deep = 44;
  const UnitRule& rule = unit_rule(points);
  const double length = p.to - p.from;
  const double zeta = std::abs(line.dy) / fall.scale_height * length;
  const double parts = std::max(1.0, std::ceil(zeta)), part = length / parts, fallen = zeta / parts;
  const double low = line.dy > 0 ? p.from : p.to, along = line.dy > 0 ? part : -part;
  const double least = (line.y + low * line.dy - fall.base) / fall.scale_height;
  double sum = 0;
  for (double i = 0; i < parts && i * fallen < deep; ++i) {
    double of_part = 0;
    for (int k = 0; k < points; ++k) {
      const double t = low + (i + rule.node[k]) * along;
      of_part += rule.weight[k] * std::exp(-fallen * rule.node[k]) *
                 in_cell<n>(p.c, p.stride, p.u + t * line.du, p.v + t * line.dv);
    }
    sum += std::exp(-(least + i * fallen)) * of_part;
  }
  return part * sum;
}

// Calls body(part) for the parts of t between the heights' breaks.
template <class Body>
void between_breaks(const HeightProfile& profile, const MapLine& line, Interval t, Body&& body) {
  std::vector<double> cuts;
  if (line.dy != 0)
    for (const double height : height_breaks(profile)) {
      const double cut = (height - line.y) / line.dy;
      if (cut > t.lo && cut < t.hi) cuts.push_back(cut);
    }
  if (line.dy < 0) std::reverse(cuts.begin(), cuts.end());
  cuts.push_back(t.hi);
  double from = t.lo;
  for (const double to : cuts) {
    if (to > from) body(Interval{from, to});
    from = std::max(from, to);
  }
}

template <int n, class Walk>
double integral_of_degree(const SplineMap& map, const HeightProfile& profile, const MapLine& line, Interval t,
                          Walk& walk) {
  double sum = 0;
  const auto over_cells = [&](Interval part, auto&& of_piece) {
    walk(part, [&](int i, int j, double from, double to) {
      sum += of_piece(Piece{map.cell(i, j), map.stride(), line.u - i, line.v - j, from, to});
      return sum;
    });
  };
  const auto linear = [&](Interval part, double a, double b) {
    over_cells(part, [&](const Piece& p) { return linear_piece<n>(p, line, a, b); });
  };
  match(
      profile, [&](const SameAtAllHeights&) { linear(t, 1, 0); },
      [&](const Layers&) {
        between_breaks(profile, line, t, [&](Interval part) {
          // The factor's straight line, from its values a quarter inside: at a knot it has two slopes.
          const double t0 = part.lo + 0.25 * part.length(), t1 = part.hi - 0.25 * part.length();
          const double f0 = factor_at(profile, line.y + t0 * line.dy), f1 = factor_at(profile, line.y + t1 * line.dy);
          const double slope = t1 > t0 ? (f1 - f0) / (t1 - t0) : 0;  // a part may be shorter than rounding
          if (f0 > 0 || f1 > 0) linear(part, f0 - slope * t0, slope);
        });
      },
      [&](const ExponentialFall& fall) {
        between_breaks(profile, line, t, [&](Interval part) {
          const double middle = line.y + (part.lo + 0.5 * part.length()) * line.dy;
          if (middle <= fall.base)
            linear(part, 1, 0);
          else if (line.dy == 0)
            linear(part, factor_at(profile, line.y), 0);
          else
            over_cells(part, [&](const Piece& p) { return exponential_piece<n>(p, line, fall); });
        });
      });
  return sum;
}

}  // namespace spline_integral

// walk(part, visit) calls visit(i, j, from, to) for the cells of a part of t, as walk_cells does; visit returns the integral so
// far. Cells that are left out count as empty. t lies over the support and ends.
template <class Walk>
double integral_by(const SplineMap& map, const HeightProfile& profile, const MapLine& line, Interval t, Walk&& walk) {
  return with_degree(map.degree(),
                     [&](auto n) { return spline_integral::integral_of_degree<n()>(map, profile, line, t, walk); });
}

}  // namespace airlight::scene
