// The grid on which source radiance is known: nodes at the centres of equal cubes around the smoke.
#pragma once
#include <vector>

#include "methods/compensated_ray_marching/discrete_ordinates.h"
#include "scene/media/medium.h"

namespace airlight::compensated_ray_marching {

struct NodeGrid {
  OrdinateGrid cells;
  Point3 corner = Point3::Zero();  // of the first cell
  Point3 node(Eigen::Index) const;
};

// Where a medium has density worth a look: its support; of Gaussians without a cutoff, three widths of each.
Box smoke_box(const scene::Medium&);

// Cubes, `cells` of them along the longest side of the box, in its middle. The box is finite, and has a volume.
NodeGrid node_grid(const Box&, int cells);

// Mean density over each cell [-]. threads: 0 is all.
Eigen::ArrayXd mean_densities(const scene::Medium&, const NodeGrid&, int threads);

// Where any of the 27 cells around has a density above `least`: every place between nodes that has one lies between those.
// In blocks of 4^3: neighbours in the list are neighbours in space, which have much work in common.
std::vector<Eigen::Index> nodes_with_smoke(const NodeGrid&, const Eigen::ArrayXd& densities, double least);

// Whether density jumps: at a region, or at the faces of a field with a border. Fields that fade to 0
// have no hard edges.
bool has_hard_edges(const scene::Medium&);

// Nodes beyond a hard edge of the medium, a region's or a border's, beside nodes within it. Within, logarithms of light that dies away are
// straight lines, which go on beyond the edge; what a node has there itself bends them. Each takes weights times values of nodes within.
struct BeyondEdges {
  std::vector<Eigen::Index> nodes;
  std::vector<std::size_t> first;  // of each in the two lists, and their length
  std::vector<Eigen::Index> from;
  std::vector<double> weights;
  void go_on(std::vector<Rgb>& values) const;
};
BeyondEdges beyond_edges(const scene::Medium&, const NodeGrid&);

// Trilinear between nodes; beyond them, as far as the cells reach, the same lines go on. values: one a node.
Rgb between_nodes(const NodeGrid&, const std::vector<Rgb>& values, const Point3&);

}  // namespace airlight::compensated_ray_marching
