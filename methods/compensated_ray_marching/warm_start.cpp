#include "methods/compensated_ray_marching/warm_start.h"

#include <cmath>

namespace airlight::compensated_ray_marching {
namespace {

bool same_but_for_place(const scene::Gaussian& a, const scene::Gaussian& b) {
  return a.width == b.width && a.amplitude == b.amplitude;
}

// A box that was moved has the size of the box before, but for rounding of its ends.
bool same_but_for_place(const NodeGrid& a, const NodeGrid& b) {
  return a.cells.size == b.cells.size && a.cells.cell.isApprox(b.cells.cell, 1e-9);
}

}  // namespace

bool Solution::empty() const {
  return of_channel[0].size() == 0 && of_channel[1].size() == 0 && of_channel[2].size() == 0;
}

Eigen::VectorXd at_centres(const Solution& last, int channel, const std::vector<scene::Gaussian>& centres) {
  const Eigen::ArrayXXd& values = last.of_channel[std::size_t(channel)];
  if (values.size() == 0 || values.rows() != Eigen::Index(last.centres.size())) return {};
  if (std::equal(last.centres.begin(), last.centres.end(), centres.begin(), centres.end(),
                 [](const auto& a, const auto& b) { return same_but_for_place(a, b); }))
    return values.col(0);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(Eigen::Index(centres.size()));
  for (std::size_t i = 0; i < centres.size(); ++i) {
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < last.centres.size(); ++k) {
      const scene::Gaussian& g = last.centres[k];
      const double weight = g.amplitude * std::exp(-(centres[i].center - g.center).squaredNorm() / (g.width * g.width));
      sum += weight * values(Eigen::Index(k), 0);
      weights += weight;
    }
    if (weights > std::numeric_limits<double>::min()) result[Eigen::Index(i)] = sum / weights;
  }
  return result;
}

Eigen::ArrayXXd at_nodes(const Solution& last, int channel, const NodeGrid& grid, Eigen::Index columns) {
  const Eigen::ArrayXXd& values = last.of_channel[std::size_t(channel)];
  if (values.cols() != columns || values.rows() != last.nodes.cells.nodes()) return {};
  if (same_but_for_place(last.nodes, grid)) return values;
  Eigen::ArrayXXd result = Eigen::ArrayXXd::Zero(grid.cells.nodes(), columns);
  const std::array<int, 3>& size = last.nodes.cells.size;
  for (Eigen::Index i = 0; i < grid.cells.nodes(); ++i) {
    const Vec3 at = (grid.node(i) - last.nodes.node(0)).cwiseQuotient(last.nodes.cells.cell);
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      Eigen::Index node = 0, stride = 1;
      for (int a = 0; a < 3; ++a) {
        const double below = std::floor(at[a]);
        const double place = below + (corner >> a & 1);
        weight *= corner >> a & 1 ? at[a] - below : 1 - (at[a] - below);
        if (!(place >= 0 && place < size[std::size_t(a)])) weight = 0;
        if (weight == 0) break;
        node += stride * Eigen::Index(place);
        stride *= size[std::size_t(a)];
      }
      if (weight > 0) result.row(i) += weight * values.row(node);
    }
  }
  return result;
}

}  // namespace airlight::compensated_ray_marching
