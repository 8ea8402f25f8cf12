// The average depth of Eq. 26 (Zhou et al. 2007) as polynomials in the cells of an octree around the surfaces, made once
// for all points, so that a point does not sum all Gaussians. Not in the paper, which has one depth for an object.
//
// The depth of a Gaussian, averaged over all directions, is smooth on the scale of its width and of the distance from it.
// In a cell the Gaussians that a polynomial of degree 5 follows are one polynomial together; the few that are too narrow
// or too near are listed and summed as they are. Cells are split until few are listed. So narrow Gaussians cost small
// cells where they are and nothing elsewhere, and no accuracy anywhere: where there is no room for smaller cells, lists
// are longer. Cells without a surface are not made. Far away all Gaussians are one point.
#pragma once
#include <vector>

#include "methods/fogshop/cell_polynomial.h"
#include "methods/fogshop/gaussian_arrays.h"
#include "scene/geometry/surface.h"
#include "scene/renderer.h"

namespace airlight::fogshop {

struct DepthCell {
  CellPolynomial polynomial;
  int begin, end;  // of DepthTree::listed
};

class DepthTree {
 public:
  static constexpr int most_listed = 8;  // in a cell, unless there is no room for smaller ones
  static constexpr std::size_t most_cells = 1 << 16;
  static constexpr std::size_t most_entries = 1 << 21;  // of all lists

  // For points on the surfaces: within `tolerance` [-], > 0, of average_depth_of, by the sum of cell_error over the
  // Gaussians that are not listed. Requires a Gaussian.
  DepthTree(const GaussianArrays&, const std::vector<scene::Surface>&, double tolerance, const scene::Execution&);

  // At a point of a surface; extinction_ratio 1, without the constant.
  double operator()(const Point3&) const;

  const Point3& corner() const { return corner_; }  // of the root, a cube
  double side() const { return side_; }             // [m]; 0: there are no cells
  // Eight of each inner node, the first is the root: the lowest bit of a place among them is the half along x. Another
  // inner node, or -1 minus the number of a cell.
  const std::vector<int>& children() const { return children_; }
  const std::vector<DepthCell>& cells() const { return cells_; }  // the first one lists all Gaussians
  const std::vector<int>& listed() const { return listed_; }      // places of Gaussians
  // Beyond the root the depth is `far` [m^2] over the squared distance from the centre.
  const Point3& center() const { return center_; }
  double far() const { return far_; }

 private:
  friend class DepthTreeMaker;
  void look_from_afar(const GaussianArrays&);
  double far_error(const GaussianArrays&, double distance) const;

  Point3 corner_ = Point3::Zero(), center_ = Point3::Zero();
  double side_ = 0, far_ = 0;
  std::vector<int> children_;
  std::vector<DepthCell> cells_;
  std::vector<int> listed_;
  GaussianArrays listed_gaussians_;  // the Gaussians of listed_
};

// Error of the polynomial of a cell of this side [m] for a Gaussian of width 1/a at `distance` [m] from the cell,
// relative to the average depth at its centre [-]: at most 1. Measured and rounded up; a test checks it.
double cell_error(double side, double distance, double a);

}  // namespace airlight::fogshop
