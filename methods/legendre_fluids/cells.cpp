#include "methods/legendre_fluids/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/limits.h"
#include "scene/media/legendre_box.h"

namespace airlight::legendre_fluids {

Cells::Cells(const ReferenceBox& reference, const Point3& corner, int along_longest)
    : box(reference), low(corner), size(2 * box.half.head(box.dimensions).maxCoeff() / along_longest) {
  for (int a = 0; a < box.dimensions; ++a) count[a] = std::max(1, int(std::lround(2 * box.half[a] / size)));
  // Measured: 70 bytes a cell where a frame is written.
  scene::require_memory(70 * count.cast<double>().prod(),
                        fmt::format("frames of {} x {} x {} cells", count[0], count[1], count[2]));
}

Components Cells::positions(int faces) const {
  Components at;
  for (int a = 0; a < box.dimensions; ++a) {
    const bool on_faces = a == faces;
    at[a].resize(count[a] + on_faces);
    for (Eigen::Index i = 0; i < at[a].size(); ++i)
      at[a][i] = std::clamp((double(i) + (on_faces ? 0 : 0.5)) * size / box.half[a] - 1, -1.0, 1.0);
  }
  return at;
}

std::vector<float> Cells::values(const ConfinedSpace& space, const Array& r) const {
  if (!r.size()) return {};
  const Array from = space.scalar_sampled(r, positions());
  std::vector<float> result(std::size_t(from.size()));
  Eigen::Index at = 0;
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k)
        result[i + std::size_t(count[0]) * (j + std::size_t(count[1]) * k)] = float(from[at++]);
  return result;
}

scene::GridPointer Cells::grid(const ConfinedSpace& space, const Array& density) const {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = count;
  grid->voxel_size = size;
  grid->translation = low + 0.5 * size * Vec3::Ones();
  if (box.dimensions == 2) grid->translation[2] = 0;
  grid->values = values(space, density);
  grid->values.resize(std::size_t(count.prod()), 0.0f);
  for (float& value : grid->values) value = std::max(0.0f, value);
  return grid;
}

scene::DensityField Cells::medium(const ConfinedSpace& space, const Array& density) const {
  if (space.n() > scene::LegendreBox::most) return grid(space, density);
  Array c = density.size() ? density : Array(Array::Zero(space.scalars()));
  Box where{box.center - box.half, box.center + box.half};
  if (box.dimensions == 2) {
    where.lo[2] = low[2] - 0.5 * size, where.hi[2] = low[2] + 0.5 * size;
    c *= std::sqrt(2.0);  // over L_0
  }
  return std::make_shared<const scene::LegendreBox>(where, space.shape(), std::move(c));
}

scene::Frame Cells::frame(const Fluid& fluid) const {
  scene::Frame f;
  f.size = count;
  f.cell = size;
  f.low = low;
  f.temperature = values(fluid.space(), fluid.temperature);
  const std::size_t nx = count[0] + 1, ny = count[1] + 1;
  f.velocity.assign(3 * nx * ny * std::size_t(count[2] + 1), 0.0f);
  for (int a = 0; a < box.dimensions; ++a) {
    const Components at = positions(a);
    const Array u = box.half[a] * fluid.sampled(a, at);
    const Eigen::Index last = box.dimensions == 3 ? at[2].size() : 1;
    Eigen::Index from = 0;
    for (Eigen::Index i = 0; i < at[0].size(); ++i)
      for (Eigen::Index j = 0; j < at[1].size(); ++j)
        for (Eigen::Index k = 0; k < last; ++k)
          f.velocity[3 * (std::size_t(i) + nx * (std::size_t(j) + ny * std::size_t(k))) + a] = float(u[from++]);
  }
  return f;
}

namespace {

void add_density(const ConfinedSpace& space, const Array& density, const Cells& cells, scene::Totals& t) {
  const int d = space.dimensions();
  const Array values = space.scalar_sampled(density, cells.positions());
  t.density_least = values.minCoeff(), t.density_greatest = values.maxCoeff();
  t.mass = space.half().head(d).prod() * std::pow(std::sqrt(2.0), d) * density[0];
  if (!(t.mass > 0) || space.n() == 1) return;
  const TensorShape s = space.shape();
  const std::array<int, 3> first{s[1] * s[2], s[2], 1};  // where the coefficient of L_1 along an axis is
  for (int a = 0; a < d; ++a)
    t.center_of_mass[a] += space.half()[a] * density[first[a]] / (std::sqrt(3.0) * density[0]);
}

// Enstrophy, and the greatest |div u| [1/s].
void add_gradients(const Fluid& fluid, scene::Totals& t) {
  const ConfinedSpace& space = fluid.space();
  const int d = space.dimensions();
  const Components points{space.nodes(), space.nodes(), space.nodes()};
  // d u_a / d x_b [1/s]
  const auto gradient = [&](int a, int b) -> Array {
    return space.half()[a] / space.half()[b] * fluid.sampled_gradient(a, b, points);
  };
  Array divergence = gradient(0, 0), squares = (gradient(1, 0) - gradient(0, 1)).cwiseAbs2();
  for (int a = 1; a < d; ++a) divergence += gradient(a, a);
  if (d == 3) squares += (gradient(2, 1) - gradient(1, 2)).cwiseAbs2() + (gradient(0, 2) - gradient(2, 0)).cwiseAbs2();
  t.enstrophy = 0.5 * space.integral(squares);
  t.divergence = divergence.cwiseAbs().maxCoeff();
}

}  // namespace

scene::Totals totals_of(const Fluid& fluid, const Array& density, const Cells& cells) {
  scene::Totals t;
  t.energy = fluid.energy();
  t.center_of_mass = cells.box.center;
  if (density.size()) add_density(fluid.space(), density, cells, t);
  for (int a = 0; a < cells.box.dimensions; ++a) {
    const Array u = cells.box.half[a] * fluid.sampled(a, cells.positions());
    t.greatest_speed = std::max(t.greatest_speed, u.cwiseAbs().maxCoeff());
  }
  add_gradients(fluid, t);
  t.divergence = t.greatest_speed > 0 ? t.divergence * cells.size / t.greatest_speed : 0;
  return t;
}

}  // namespace airlight::legendre_fluids
