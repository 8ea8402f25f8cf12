#include "experiments/wavelet_fog/errata_probe.h"

#include <algorithm>
#include <cmath>

#include "experiments/wavelet_fog/errata_setup.h"
#include "methods/wavelet_fog/leveled_fog.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

using namespace errata;
using fog::Coefficients;
using fog::Levels;
using scene::MapLine;
using scene::SplineMap;

// Eq. 10 and 11 print psi-psi twice; the first (beta) is phi-psi. Relative L2 error of K after one level.
Figures psi_psi_twice(const Setup& s) {
  const fog::Bands bands = split(s.map, s.family);
  Coefficients printed{s.map.range, std::vector<double>(s.map.values.size())};
  filter_up(bands.aa, s.family.p, s.family.p, printed);
  filter_up(bands.ad, s.family.q, s.family.q, printed);
  filter_up(bands.da, s.family.q, s.family.p, printed);
  filter_up(bands.dd, s.family.q, s.family.q, printed);
  return {relative(printed, s.map, s.rays.map.degree()),
          relative(join(bands, s.family, s.map.range), s.map, s.rays.map.degree())};
}

// Eq. 11 calls the integral tau(O, P), which is the transmittance: rms error of that.
Figures no_exponential(const Setup& s) {
  return {s.rms([&](std::size_t i) { return s.depth(i) - std::exp(-s.depth(i)); }), 0};
}

// Eq. 10 adds layers n = 1 to J-1, Eq. 11 n = 0 to J-1: without the coarsest layer, relative L2 error of K.
Figures one_layer_less(const Setup& s) {
  fog::Decomposition d = decompose(s.map, s.family, s.levels.count());
  const double right = relative(reconstruct(d, s.family), s.map, s.rays.map.degree());
  fog::Bands& coarsest = d.levels.back();
  for (Coefficients* band : {&coarsest.ad, &coarsest.da, &coarsest.dd})
    std::fill(band->values.begin(), band->values.end(), 0.0);
  return {relative(reconstruct(d, s.family), s.map, s.rays.map.degree()), right};
}

// Algorithm 1, last line: sum * object + (1 - sum) * fog, object 0.1, fog 0.8: rms error of the radiance.
Figures blend(const Setup& s) {
  constexpr double object = 0.1, white = 0.8;
  return {s.rms([&](std::size_t i) {
            return s.depth(i) * object + (1 - s.depth(i)) * white - fog::composite(s.depth(i), object, white);
          }),
          0};
}

// Algorithm 1 reads one coefficient per basis and cell, where (n+1)^2 splines overlap: rms error of the transmittance.
Figures one_coefficient(const Setup& s) {
  const int n = s.rays.map.degree();
  const auto alone = [&](std::size_t i) {
    const MapLine& line = s.rays.lines[i];
    const auto& rule = scene::spline_integral::unit_rule(n + 1);
    double sum = 0;
    walk_cells(s.rays.map, line, {0, s.rays.lengths[i]}, [&](int x, int y, double from, double to) {
      for (int k = 0; k <= n; ++k) {
        const double t = from + rule.node[k] * (to - from);
        sum += (to - from) * rule.weight[k] * s.rays.map.coefficient(x, y) *
               scene::bspline(n, line.u + t * line.du - x) * scene::bspline(n, line.v + t * line.dv - y);
      }
      return false;
    });
    return s.rays.sigma * sum;
  };
  return {s.rms([&](std::size_t i) { return std::exp(-alone(i)) - std::exp(-s.depth(i)); }), 0};
}

// Integrals over cells of unit size are not multiplied by the cells' size: rms error of the transmittance, all levels summed.
Figures no_cell_size(const Setup& s) {
  const auto summed = [&](std::size_t i, bool sizes) {
    const Interval t{0, s.rays.lengths[i]};
    const int L = s.levels.count();
    fog::Visits visits;
    double sum =
        integral_of_level(s.levels.grid[L], L, same, s.rays.lines[i], t, visits) * (sizes ? 1 : std::ldexp(1.0, -L));
    for (int l = 0; l < L; ++l)
      sum += integral_of_level(s.levels.detail[l], l, same, s.rays.lines[i], t, visits) *
             (sizes ? 1 : std::ldexp(1.0, -l));
    return std::exp(-std::max(0.0, s.rays.sigma * sum));
  };
  const auto error = [&](bool sizes) {
    return s.rms([&](std::size_t i) { return summed(i, sizes) - std::exp(-s.depth(i)); });
  };
  return {error(false), error(true)};
}

// Calls visit(depth of a piece) for every cell of every level from the coarsest on, as Algorithm 1 adds them after deconstruction;
// until it returns true.
void cells_in_order(const Setup& s, std::size_t i, const std::function<bool(double)>& visit) {
  bool done = false;
  const auto level = [&](const SplineMap& grid, int l) {
    const MapLine line = coarser(s.rays.lines[i], l);
    walk_cells(grid, line, {0, s.rays.lengths[i]}, [&](int, int, double from, double to) {
      return done = visit(s.rays.sigma * scene::integral(grid, same, line, {from, to}));
    });
  };
  level(s.levels.grid.back(), s.levels.count());
  for (int l = s.levels.count() - 1; l >= 0 && !done; --l) level(s.levels.detail[l], l);
}

// "Each new cell will only add opacity": share of the rays where a cell takes some away (printed: none).
Figures cells_that_take_away(const Setup& s) {
  long taking = 0, meeting = 0;
  for (std::size_t i = 0; i < s.rays.lines.size(); ++i) {
    if (!(s.depth(i) > 0)) continue;
    ++meeting;
    cells_in_order(s, i, [&](double piece) {
      const bool negative = piece < -1e-12;
      taking += negative ? 1 : 0;
      return negative;
    });
  }
  return {0, double(taking) / double(meeting)};
}

// Ending a ray where the sum exceeds a threshold of opacity: greatest error of the transmittance over the levels (printed) and along the
// map alone.
Figures early_end(const Setup& s) {
  const double enough = -std::log(s.threshold);
  Figures most{0, 0};
  for (std::size_t i = 0; i < s.rays.lines.size(); ++i) {
    double sum = 0, along = 0;
    const double exact = std::exp(-s.depth(i));
    cells_in_order(s, i, [&](double piece) { return (sum += piece) > enough; });
    most.printed = std::max(most.printed, std::abs(std::exp(-std::max(0.0, sum)) - exact));
    walk_cells(s.rays.map, s.rays.lines[i], {0, s.rays.lengths[i]}, [&](int, int, double from, double to) {
      return (along += s.rays.sigma * scene::integral(s.rays.map, same, s.rays.lines[i], {from, to})) > enough;
    });
    most.right = std::max(most.right, std::abs(std::exp(-along) - exact));
  }
  return most;
}

// Standard and nonstandard decomposition "output exactly the same kind of result": share of the square of the L2 norm that lies in products
// of different levels, which Eq. 10 cannot hold; Haar, all levels.
Figures products_of_levels(const Setup& s) {
  const int side = 1 << fog::most_levels(s.map.range);
  std::vector<double> c(std::size_t(side) * side, 0.0);
  for (int j = 0; j < std::min(side, s.map.range.size[1]); ++j)
    for (int i = 0; i < std::min(side, s.map.range.size[0]); ++i)
      c[std::size_t(j) * side + i] = s.map.values[std::size_t(j) * s.map.range.size[0] + i];
  std::vector<double> line(side), next(side);
  const auto transform = [&](std::ptrdiff_t start, std::ptrdiff_t step) {  // orthonormal
    for (int i = 0; i < side; ++i) line[i] = c[start + i * step];
    for (int length = side; length > 1; length /= 2) {
      for (int i = 0; i < length / 2; ++i) {
        next[i] = std::sqrt(0.5) * (line[2 * i] + line[2 * i + 1]);
        next[length / 2 + i] = std::sqrt(0.5) * (line[2 * i] - line[2 * i + 1]);
      }
      std::copy_n(next.begin(), length, line.begin());
    }
    for (int i = 0; i < side; ++i) c[start + i * step] = line[i];
  };
  for (int j = 0; j < side; ++j) transform(std::ptrdiff_t(j) * side, 1);
  for (int i = 0; i < side; ++i) transform(i, side);
  const auto level = [](int i) { return i == 0 ? 0 : int(std::log2(i)) + 1; };  // 0: the mean; 1: the coarsest wavelet
  double all = 0, mixed = 0;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double energy = c[std::size_t(j) * side + i] * c[std::size_t(j) * side + i];
      const int x = level(i), y = level(j);
      if (x + y > 0) all += energy;
      if (x != y && std::max(x, y) > 1) mixed += energy;
    }
  return {0, mixed / all};
}

// "Grids from different bases match at a given level": columns of the finest approximation and of its psi-psi band.
Figures widths(const Setup& s) {
  const fog::Bands bands = split(s.map, s.family);
  return {double(bands.aa.range.size[0]), double(bands.dd.range.size[0])};
}

// Table 2's times against the coefficients that two readings of Algorithm 1 and Eq. 12 read: details from l = 0 on as printed, which leaves
// the coarsest details whole for every mu, and level 0 as the approximation alone. Correlation of 18 cells.
Figures readings(const Setup& s) {
  const double mu[] = {1, 0.8, 0.6, 0.4, 0.2, 0};
  const double frames[3][6] = {{35, 39, 47, 55, 66, 83}, {31, 45, 55, 71, 90, 124}, {27, 39, 66, 76, 99, 166}};
  std::vector<double> ms, printed, right;
  for (int L = 1; L <= 3; ++L) {
    const Levels levels = fog::make_levels(s.rays.map, s.family.name, fog::Coarse::wavelet, L, true);
    for (int k = 0; k < 6; ++k) {
      fog::Visits as_printed, as_meant;
      for (std::size_t i = 0; i < s.rays.lines.size(); ++i) {
        const MapLine& line = s.rays.lines[i];
        const double length = fog::length_in_box(levels, line, s.rays.lengths[i]);
        fog::summed_depth(levels, same, line, {0, infinity}, length, mu[k], as_meant);
        integral_of_level(levels.grid[L], L, same, line, {0, length}, as_printed);
        for (int m = 1; m <= L; ++m)
          integral_of_level(levels.detail[L - m], L - m, same, line, {0, fog::reach_of(m - 1, length, mu[k])},
                            as_printed);
      }
      ms.push_back(1000 / frames[L - 1][k]);
      printed.push_back(double(as_printed.coefficients));
      right.push_back(double(as_meant.coefficients));
    }
  }
  const auto correlation = [&](const std::vector<double>& x) {
    double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / double(x.size()), my += ms[i] / double(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      xx += (x[i] - mx) * (x[i] - mx);
      yy += (ms[i] - my) * (ms[i] - my);
      xy += (x[i] - mx) * (ms[i] - my);
    }
    return xy / std::sqrt(xx * yy);
  };
  return {correlation(printed), correlation(right)};
}

// "Vertical extinction" by the distance from the viewer, scale 3 m, is no property of the fog: greatest difference of the transmittance
// between a segment and its reverse.
Figures seen_from_both_ends(const Setup& s) {
  scene::Medium medium;
  auto map = std::make_shared<scene::Fogmap>();
  map->map = s.rays.map;
  medium.field = scene::FogmapPointer(map);
  medium.region = scene::Slab{Vec3::UnitY(), -1, 101};
  const auto most = [&](double fade) {
    fog::Options options;
    options.variant = fog::Options::Variant::direct;
    options.fade = fade;
    const fog::LeveledFog leveled(medium, options);
    double greatest = 0;
    for (std::size_t i = 0; i < s.rays.lines.size(); ++i) {
      const MapLine& l = s.rays.lines[i];
      const Point3 a(l.u, 1, l.v), b(l.u + s.rays.lengths[i] * l.du, 9, l.v + s.rays.lengths[i] * l.dv);
      const double length = (b - a).norm();
      fog::Visits visits;
      const double there = leveled.column({a, (b - a) / length}, length, visits);
      const double back = leveled.column({b, (a - b) / length}, length, visits);
      greatest = std::max(greatest, std::abs(std::exp(-s.rays.sigma * there) - std::exp(-s.rays.sigma * back)));
    }
    return greatest;
  };
  return {most(3), most(0)};
}

// "Can reduce the rendering cost by up to 2": greatest ratio of Table 3's own frame rates.
Figures up_to_two(const Setup&) {
  const double table[][2] = {{58, 111}, {47, 99}, {35, 83}, {20, 62}, {15, 55}, {13, 49}, {7, 23}, {5, 20}, {5, 18}};
  double most = 0;
  for (const auto& row : table) most = std::max(most, row[1] / row[0]);
  return {2, most};
}

struct Erratum {
  const char* name;
  Figures (*measure)(const Setup&);
};
constexpr Erratum all_errata[] = {{"psi_psi_twice", psi_psi_twice},
                                  {"no_exponential", no_exponential},
                                  {"one_layer_less", one_layer_less},
                                  {"blend", blend},
                                  {"readings", readings},
                                  {"one_coefficient", one_coefficient},
                                  {"no_cell_size", no_cell_size},
                                  {"cells_that_take_away", cells_that_take_away},
                                  {"early_end", early_end},
                                  {"up_to_two", up_to_two},
                                  {"products_of_levels", products_of_levels},
                                  {"widths", widths},
                                  {"seen_from_both_ends", seen_from_both_ends},
                                  {"union_of_spaces", union_of_spaces},
                                  {"from_zero", from_zero},
                                  {"exit_by_equality", exit_by_equality},
                                  {"no_distance", no_distance},
                                  {"no_threshold", no_threshold},
                                  {"tabulated", tabulated},
                                  {"haar_steps", haar_steps}};

}  // namespace

std::string WaveletErrata::about() const {
  return "formulas and claims of Giroud and Biri 2010 as printed, and what holds";
}

std::vector<scene::SettingSpec> WaveletErrata::settings() const {
  std::vector<std::string> names;
  for (const Erratum& e : all_errata) names.push_back(e.name);
  return {
      scene::choice_setting("erratum", names.front(), names,
                            "what is measured; errata_probe.cpp and errata_claims.cpp say how"),
      scene::integer_setting("levels", "3", 1, 20, "of the decomposition"),
      scene::real_setting("mean_depth", "1", 1e-6, 1e3, "mean optical depth of the rays"),
      scene::real_setting("threshold", "0.02", 1e-9, 0.999,
                          "transmittance at which early_end and no_threshold end a ray"),
      scene::integer_setting("places", "16", 1, 64, "of tabulated: R, a fourth of the places on a cell's perimeter"),
      scene::integer_setting("angles", "24", 1, 100000, "directions of each of six eyes, five lengths each")};
}

std::vector<std::string> WaveletErrata::figures() const { return {"printed", "right"}; }

Findings WaveletErrata::run(const ProbeInput& input, const scene::Settings& s, const scene::Execution&) const {
  MapRays rays = map_rays(input.file, input.overrides, int(s.integer("angles")), s.real("mean_depth"));
  if (rays.map.degree() > 2) throw Error("the map has degree 3, for which there is no wavelet");
  const fog::Family& family = fog::family(families[rays.map.degree()]);
  Levels levels = fog::make_levels(rays.map, family.name, fog::Coarse::wavelet, int(s.integer("levels")), true);
  Coefficients map{rays.map.range(), rays.map.coefficients()};
  const Setup setup{std::move(rays),         family, std::move(map), std::move(levels), s.real("threshold"),
                    int(s.integer("places"))};
  for (const Erratum& e : all_errata)
    if (s.text("erratum") == e.name) {
      const Figures f = e.measure(setup);
      Findings found;
      found.figures = {exactly("printed", f.printed), exactly("right", f.right)};
      return found;
    }
  return {};
}

}  // namespace airlight::experiments
