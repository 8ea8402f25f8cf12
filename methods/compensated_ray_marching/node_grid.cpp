#include "methods/compensated_ray_marching/node_grid.h"

#include <algorithm>
#include <cmath>

#include "scene/convert/gaussian_samples.h"
#include "scene/renderer.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr double widths_without_cutoff = 3;
constexpr int samples_of_gaussians = 3, most_samples = 8;  // along a side of a cell
constexpr double steepest = 3;  // as far as lines that go on may rise above the nodes they come from
constexpr int block = 4;        // nodes along a side

// Whether a cell has a point of a region.
bool meets(const scene::Region& region, const Box& cell) {
  if (const auto* sphere = std::get_if<scene::Sphere>(&region))
    return contains(region, sphere->center.cwiseMax(cell.lo).cwiseMin(cell.hi));
  if (const auto* slab = std::get_if<scene::Slab>(&region)) {
    const double middle = slab->normal.dot(cell.center()), reach = 0.5 * slab->normal.cwiseAbs().dot(cell.size());
    return middle + reach >= slab->lo && middle - reach <= slab->hi;
  }
  return !intersect(cell, bounding_box(region)).empty();
}

// Regions are convex: one that has all corners of a cell has the cell.
bool is_within(const scene::Region& region, const Box& cell) {
  for (int corner = 0; corner < 8; ++corner) {
    Point3 x = cell.lo;
    for (int a = 0; a < 3; ++a)
      if (corner >> a & 1) x[a] = cell.hi[a];
    if (!contains(region, x)) return false;
  }
  return true;
}

// Along a side of a cell that no edge of a region cuts.
int samples_within(const scene::Medium& medium, double edge) {
  if (std::holds_alternative<scene::Homogeneous>(medium.field)) return 1;
  if (const scene::VoxelGrid* voxels = grid_of(medium.field))
    return std::clamp(int(std::ceil(edge / voxels->voxel_size)), 1, most_samples);
  const bool bounded = !std::holds_alternative<scene::Unbounded>(medium.region);
  return bounded && !std::holds_alternative<scene::GaussianSum>(medium.field) ? most_samples : samples_of_gaussians;
}

}  // namespace

Point3 NodeGrid::node(Eigen::Index i) const {
  const Eigen::Index nx = cells.size[0], ny = cells.size[1];
  return corner +
         cells.cell.cwiseProduct(Vec3(double(i % nx) + 0.5, double(i / nx % ny) + 0.5, double(i / nx / ny) + 0.5));
}

Box smoke_box(const scene::Medium& medium) {
  const auto* sum = std::get_if<scene::GaussianSum>(&medium.field);
  if (!sum || sum->cutoff <= widths_without_cutoff || sum->constant > 0) return bounding_box(medium);
  Box box;
  for (const scene::Gaussian& g : sum->gaussians) {
    const Vec3 reach = Vec3::Constant(widths_without_cutoff * g.width);
    box = unite(box, Box{g.center - reach, g.center + reach});
  }
  return intersect(box, bounding_box(medium));
}

NodeGrid node_grid(const Box& box, int cells) {
  const double edge = box.size().maxCoeff() / cells;
  NodeGrid grid;
  for (int a = 0; a < 3; ++a)
    grid.cells.size[std::size_t(a)] = std::clamp(int(std::ceil(box.size()[a] / edge * (1 - 1e-12))), 1, cells);
  grid.cells.cell = Vec3::Constant(edge);
  grid.corner = box.center() - 0.5 * edge * Vec3(grid.cells.size[0], grid.cells.size[1], grid.cells.size[2]);
  return grid;
}

Eigen::ArrayXd mean_densities(const scene::Medium& medium, const NodeGrid& grid, int threads) {
  const bool bounded = !std::holds_alternative<scene::Unbounded>(medium.region);
  const double edge = grid.cells.cell[0];
  const int across = samples_within(medium, edge);
  Eigen::ArrayXd means = Eigen::ArrayXd::Zero(grid.cells.nodes());
  const auto* gaussians = std::get_if<scene::GaussianSum>(&medium.field);
  if (gaussians && !bounded) {
    // Finer samples, `across` along each side of a cell.
    scene::VoxelGrid fine;
    for (int a = 0; a < 3; ++a) fine.size[a] = across * grid.cells.size[std::size_t(a)];
    fine.voxel_size = edge / across;
    fine.translation = grid.corner + Vec3::Constant(0.5 * fine.voxel_size);
    const std::vector<float> values = gaussian_samples(*gaussians, fine, threads);
    const double share = 1.0 / (double(across) * across * across);
    std::size_t at = 0;
    for (int k = 0; k < fine.size[2]; ++k)
      for (int j = 0; j < fine.size[1]; ++j)
        for (int i = 0; i < fine.size[0]; ++i, ++at) {
          const Eigen::Index row = j / across + Eigen::Index(grid.cells.size[1]) * (k / across);
          means[i / across + grid.cells.size[0] * row] += share * std::max(0.0F, values[at]);
        }
    return means;
  }
  scene::parallel_for(grid.cells.size[2], {threads, {}}, [&](int plane) {
    Eigen::Index at = plane * Eigen::Index(grid.cells.size[0]) * grid.cells.size[1];
    for (int y = 0; y < grid.cells.size[1]; ++y)
      for (int x = 0; x < grid.cells.size[0]; ++x, ++at) {
        const Point3 low = grid.corner + edge * Vec3(x, y, plane);
        const Box cell{low, low + Vec3::Constant(edge)};
        if (bounded && !meets(medium.region, cell)) continue;
        const int n = bounded && !is_within(medium.region, cell) ? most_samples : across;
        const Point3 first = grid.corner + Vec3::Constant(0.5 * (edge / n));
        double sum = 0;
        for (int k = n * plane; k < n * (plane + 1); ++k)
          for (int j = n * y; j < n * (y + 1); ++j)
            for (int i = n * x; i < n * (x + 1); ++i) sum += density(medium, first + edge / n * Vec3(i, j, k));
        means[at] = sum / (double(n) * n * n);
      }
  });
  return means;
}

std::vector<Eigen::Index> nodes_with_smoke(const NodeGrid& grid, const Eigen::ArrayXd& densities, double least) {
  const auto& size = grid.cells.size;
  std::vector<char> near(std::size_t(densities.size()), 0);
  for (Eigen::Index at = 0; at < densities.size(); ++at) {
    if (!(densities[at] > least)) continue;
    const int x = int(at % size[0]), y = int(at / size[0] % size[1]), z = int(at / size[0] / size[1]);
    for (int k = std::max(z - 1, 0); k <= std::min(z + 1, size[2] - 1); ++k)
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, size[1] - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, size[0] - 1); ++i)
          near[std::size_t(i) + std::size_t(size[0]) * (std::size_t(j) + std::size_t(size[1]) * std::size_t(k))] = 1;
  }
  std::vector<Eigen::Index> nodes;
  for (int z = 0; z < size[2]; z += block)
    for (int y = 0; y < size[1]; y += block)
      for (int x = 0; x < size[0]; x += block)
        for (int k = z; k < std::min(z + block, size[2]); ++k)
          for (int j = y; j < std::min(y + block, size[1]); ++j)
            for (int i = x; i < std::min(x + block, size[0]); ++i) {
              const Eigen::Index at = i + Eigen::Index(size[0]) * (j + Eigen::Index(size[1]) * k);
              if (near[std::size_t(at)]) nodes.push_back(at);
            }
  return nodes;
}

bool has_hard_edges(const scene::Medium& medium) {
  if (!std::holds_alternative<scene::Unbounded>(medium.region)) return true;
  const scene::VoxelGrid* voxels = grid_of(medium.field);
  return voxels ? voxels->clamp_border : !std::holds_alternative<scene::GaussianSum>(medium.field);
}

BeyondEdges beyond_edges(const scene::Medium& medium, const NodeGrid& grid) {
  BeyondEdges edges;
  edges.first.push_back(0);
  if (std::holds_alternative<scene::Unbounded>(medium.region)) return edges;
  const auto& size = grid.cells.size;
  std::vector<char> within(std::size_t(grid.cells.nodes()));
  for (Eigen::Index i = 0; i < grid.cells.nodes(); ++i) within[std::size_t(i)] = contains(medium.region, grid.node(i));
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i) {
        const auto at = [&](const Eigen::Vector3i& n) -> Eigen::Index {
          for (int a = 0; a < 3; ++a)
            if (n[a] < 0 || n[a] >= size[std::size_t(a)]) return -1;
          const Eigen::Index index = n[0] + Eigen::Index(size[0]) * (n[1] + Eigen::Index(size[1]) * n[2]);
          return within[std::size_t(index)] ? index : -1;
        };
        const Eigen::Vector3i here(i, j, k);
        if (at(here) >= 0) continue;
        double sum = 0;
        const std::size_t first = edges.from.size();
        const auto take = [&](Eigen::Index node, double weight) {
          edges.from.push_back(node);
          edges.weights.push_back(weight);
        };
        for (int d = 0; d < 27; ++d) {
          const Eigen::Vector3i step(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
          const Eigen::Index next = at(here + step), second = at(here + 2 * step);
          if (next < 0) continue;
          const double weight = 1.0 / step.squaredNorm();
          sum += weight;
          take(next, second < 0 ? weight : 2 * weight);
          if (second >= 0) take(second, -weight);
        }
        if (sum == 0) continue;
        for (std::size_t n = first; n < edges.weights.size(); ++n) edges.weights[n] /= sum;
        edges.nodes.push_back(i + Eigen::Index(size[0]) * (j + Eigen::Index(size[1]) * k));
        edges.first.push_back(edges.from.size());
      }
  return edges;
}

void BeyondEdges::go_on(std::vector<Rgb>& values) const {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Rgb sum = Rgb::Zero();
    Rgb most = Rgb::Constant(-infinity);
    for (std::size_t i = first[n]; i < first[n + 1]; ++i) {
      sum += weights[i] * values[std::size_t(from[i])];
      most = most.max(values[std::size_t(from[i])]);
    }
    values[std::size_t(nodes[n])] = sum.min(most + steepest);
  }
}

Rgb between_nodes(const NodeGrid& grid, const std::vector<Rgb>& values, const Point3& x) {
  const auto& size = grid.cells.size;
  std::size_t first[3], step[3] = {1, std::size_t(size[0]), std::size_t(size[0]) * std::size_t(size[1])};
  double share[3];
  for (int a = 0; a < 3; ++a) {
    const double place =
        std::clamp((x[a] - grid.corner[a]) / grid.cells.cell[a] - 0.5, -0.5, size[std::size_t(a)] - 0.5);
    const int low = std::clamp(int(place), 0, std::max(size[std::size_t(a)] - 2, 0));
    first[a] = std::size_t(low) * step[a];
    share[a] = place - low;
    if (size[std::size_t(a)] == 1) step[a] = 0;
  }
  const Rgb* v = values.data() + first[0] + first[1] + first[2];
  const auto along = [&](const Rgb* p) -> Rgb { return p[0] + share[0] * (p[step[0]] - p[0]); };
  const auto plane = [&](const Rgb* p) -> Rgb {
    const Rgb low = along(p);
    return low + share[1] * (along(p + step[1]) - low);
  };
  Rgb most = v[0];
  for (std::size_t c = 1; c < 8; ++c)
    most = most.max(v[(c & 1) * step[0] + (c >> 1 & 1) * step[1] + (c >> 2) * step[2]]);
  const Rgb low = plane(v);
  return (low + share[2] * (plane(v + step[2]) - low)).min(most + steepest);
}

}  // namespace airlight::compensated_ray_marching
