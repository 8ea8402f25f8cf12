// Common parts of the errata: the map, its rays, its levels; and the errata of errata_claims.cpp.
#pragma once
#include <cmath>
#include <functional>

#include "experiments/wavelet_fog/rays.h"
#include "methods/wavelet_fog/decomposition.h"
#include "methods/wavelet_fog/levels.h"
#include "scene/media/spline_integral.h"

namespace airlight::experiments::errata {

namespace fog = airlight::wavelet_fog;

inline const scene::HeightProfile same = scene::SameAtAllHeights{};

struct Figures {
  double printed, right;
};

struct Setup {
  MapRays rays;
  const fog::Family& family;
  fog::Coefficients map;
  fog::Levels levels;
  double threshold;
  int places;  // of tables, on a side of a cell

  double rms(const std::function<double(std::size_t)>& f) const {
    double sum = 0;
    for (std::size_t i = 0; i < rays.lines.size(); ++i) sum += f(i) * f(i);
    return std::sqrt(sum / double(rays.lines.size()));
  }
  double depth(std::size_t i) const {
    return rays.sigma * scene::integral(rays.map, same, rays.lines[i], {0, rays.lengths[i]});
  }
};

// Relative L2 error of a as b.
double relative(const fog::Coefficients& a, const fog::Coefficients& b, int degree);

Figures union_of_spaces(const Setup&);
Figures from_zero(const Setup&);
Figures exit_by_equality(const Setup&);
Figures no_distance(const Setup&);
Figures no_threshold(const Setup&);
Figures tabulated(const Setup&);
Figures haar_steps(const Setup&);

}  // namespace airlight::experiments::errata
