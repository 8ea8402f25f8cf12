// Multiple scattering on a grid by discrete ordinates: the transport equation itself, with light that leaves the box, where Zhou et al. 2008
// solve a diffusion equation without a boundary (their Eq. 13).
//
//   w.grad L = extinction (J - L),   J = J_ss + J_ms,   J_ms,lm = albedo p_l M_lm,   M_lm = integral of L y_lm over the sphere
//
// All directions are propagation directions. Each direction is swept plane by plane along the axis that it crosses
// fastest; between two planes the source is a parabola in the optical depth. The inflow through the faces is 0 (the
// reduced light is in J_ss), or constant.
#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "methods/compensated_ray_marching/ordinate_directions.h"

namespace airlight::compensated_ray_marching {

// Nodes at the centres of equal cells, x fastest.
struct OrdinateGrid {
  std::array<int, 3> size{1, 1, 1};
  Vec3 cell = Vec3::Ones();                          // [m]
  std::array<bool, 3> endless{false, false, false};  // along it nothing changes and nothing ends; one cell
  Eigen::Index nodes() const { return Eigen::Index(size[0]) * size[1] * size[2]; }
};

// A row for each node; for each light (a colour, say) its `order`^2 coefficients of real spherical harmonics, one light after another.
using Moments = Eigen::ArrayXXd;

struct OrdinateOptions {
  int levels = 4;  // in cos(theta), on each side where `hemispheres`
  int azimuths = 8;
  bool hemispheres = true;
  int order = 4;            // bands of the source, 1 to 6
  double tolerance = 2e-4;  // of the solution, weighted with the extinction, as the changes let it be estimated
  int iterations = 200;     // at most
};

struct OrdinateSolution {
  Moments radiance;  // M_lm of the light that has been scattered, or came in by the faces
  Moments source;    // J
  int iterations = 0;
  double error = 0;  // estimated, relative; above the tolerance where iterations ran out
};

class DiscreteOrdinates {
 public:
  // extinction: of each node [1/m], >= 0. phase[l], l < order: mean of P_l(cos) over the phase function, g^l for Henyey-Greenstein.
  // albedo in [0, 1]. open: of each direction of the options, by node, as open_ways has it; empty: no objects. Throws Error for sizes that do
  // not fit and for values out of range.
  DiscreteOrdinates(const OrdinateGrid&, Eigen::ArrayXd extinction, double albedo, std::vector<double> phase,
                    const OrdinateOptions&, std::vector<std::vector<float>> open = {});

  // Factors of M_lm by node, of what `solve` sweeps; without them 1.
  void scale(Eigen::ArrayXd factors) { factors_ = std::move(factors); }

  // source: J_ss. inflow: radiance at all faces that are not endless. before: where to start from, a solution's source, or null.
  // interrupted: asked once an iteration; true ends the solve with what it has.
  OrdinateSolution solve(const Moments& source, double inflow = 0, const Moments* before = nullptr,
                         const std::function<bool()>& interrupted = {}) const;

  // M_lm of the radiance that a given J makes: one iteration.
  Moments sweep(const Moments& source, double inflow) const;

  // Greatest optical depth of a cell along an axis: above 1.5 light leaks through.
  double deepest_cell() const;

 private:
  class GroupSweep;  // of the directions that cross planes of one axis fastest, on one side

  OrdinateGrid grid_;
  Eigen::ArrayXd extinction_;
  Eigen::ArrayXd factors_;  // empty: 1
  double albedo_;
  std::vector<double> phase_;
  OrdinateOptions options_;
  std::vector<Ordinate> directions_;
  std::vector<std::vector<float>>
      open_;  // of each direction, by node: 0 where an object is met before the plane before; empty without
};

// The axis whose planes a direction crosses fastest.
int fastest_axis(const OrdinateGrid&, const Vec3& direction);

// Visibility for every direction, by node: 0 where an object stands between the node and the previous plane, else 1.
// `objects`: whether an object stands between a node and the point at offset `back` [m]; called from several threads.
// Objects absorb the light that meets them; reflected light is left out. Rays along a wall are interpolated across the
// wall: 0.06 of the light leaks behind it.
std::vector<std::vector<float>> open_ways(const OrdinateGrid&, const std::vector<Ordinate>&,
                                          const std::function<bool(Eigen::Index node, const Vec3& back)>& objects);

}  // namespace airlight::compensated_ray_marching
