#include "methods/compensated_ray_marching/node_grid.h"

#include <algorithm>
#include <cmath>

#include "scene/convert/gaussian_samples.h"
#include "scene/renderer.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr double widths_without_cutoff = 3;
constexpr int samples_of_gaussians = 3, most_samples = 8;  // along a side of a cell
constexpr int block = 4;                                   // nodes along a side

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
  const scene::VoxelGrid* voxels = grid_of(medium.field);
  const auto* gaussians = std::get_if<scene::GaussianSum>(&medium.field);
  const double edge = grid.cells.cell[0];
  const int across =
      voxels ? std::clamp(int(std::ceil(edge / voxels->voxel_size)), 1, most_samples) : samples_of_gaussians;
  // Finer samples, `across` along each side of a cell.
  scene::VoxelGrid fine;
  for (int a = 0; a < 3; ++a) fine.size[a] = across * grid.cells.size[std::size_t(a)];
  fine.voxel_size = edge / across;
  fine.translation = grid.corner + Vec3::Constant(0.5 * fine.voxel_size);
  Eigen::ArrayXd means = Eigen::ArrayXd::Zero(grid.cells.nodes());
  const auto cell = [&](int i, int j, int k) {
    return i / across +
           Eigen::Index(grid.cells.size[0]) * (j / across + Eigen::Index(grid.cells.size[1]) * (k / across));
  };
  const double share = 1.0 / (double(across) * across * across);
  if (gaussians && std::holds_alternative<scene::Unbounded>(medium.region)) {
    const std::vector<float> values = gaussian_samples(*gaussians, fine, threads);
    std::size_t at = 0;
    for (int k = 0; k < fine.size[2]; ++k)
      for (int j = 0; j < fine.size[1]; ++j)
        for (int i = 0; i < fine.size[0]; ++i, ++at) means[cell(i, j, k)] += share * std::max(0.0F, values[at]);
    return means;
  }
  scene::parallel_rows(grid.cells.size[2], {threads, {}}, [&](int plane) {
    for (int k = across * plane; k < across * (plane + 1); ++k)
      for (int j = 0; j < fine.size[1]; ++j)
        for (int i = 0; i < fine.size[0]; ++i)
          means[cell(i, j, k)] += share * density(medium, fine.translation + fine.voxel_size * Vec3(i, j, k));
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

Rgb between_nodes(const NodeGrid& grid, const std::vector<Rgb>& values, const Point3& x) {
  const auto& size = grid.cells.size;
  std::size_t first[3], step[3] = {1, std::size_t(size[0]), std::size_t(size[0]) * std::size_t(size[1])};
  double share[3];
  for (int a = 0; a < 3; ++a) {
    const double place =
        std::clamp((x[a] - grid.corner[a]) / grid.cells.cell[a] - 0.5, 0.0, double(size[std::size_t(a)] - 1));
    const int low = std::min(int(place), std::max(size[std::size_t(a)] - 2, 0));
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
  const Rgb low = plane(v);
  return low + share[2] * (plane(v + step[2]) - low);
}

}  // namespace airlight::compensated_ray_marching
