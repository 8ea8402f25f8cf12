#include "experiments/compensated_ray_marching/nano_grid.h"

#include <nanovdb/util/GridBuilder.h>

#include <variant>

namespace airlight::experiments {
namespace {

template <class Build>
nanovdb::GridHandle<> handle_of(const Eigen::Vector3i& size, const std::vector<float>& values) {
  nanovdb::GridBuilder<float, Build> builder(0.0f, nanovdb::GridClass::FogVolume);
  auto to = builder.getAccessor();
  std::size_t i = 0;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x, ++i)
        if (values[i] != 0) to.setValue(nanovdb::Coord(x, y, z), values[i]);
  return builder.getHandle();
}

template <class Build>
double sum(const nanovdb::NanoGrid<Build>& grid, const std::vector<Eigen::Vector3i>& positions) {
  const auto from = grid.getAccessor();
  double sum = 0;
  for (const auto& p : positions) sum += from.getValue(nanovdb::Coord(p[0], p[1], p[2]));
  return sum;
}

}  // namespace

struct NanoGrid::Grid {
  nanovdb::GridHandle<> handle;
  Values values;
};

NanoGrid::NanoGrid(const Eigen::Vector3i& size, const std::vector<float>& values, Values kind)
    : grid_(std::make_unique<Grid>()) {
  grid_->values = kind;
  grid_->handle = kind == Values::floats ? handle_of<float>(size, values) : handle_of<nanovdb::Fp8>(size, values);
}

NanoGrid::~NanoGrid() = default;

std::size_t NanoGrid::bytes() const { return grid_->handle.size(); }

float NanoGrid::at(const Eigen::Vector3i& p) const { return float(sum_at({p})); }

double NanoGrid::sum_at(const std::vector<Eigen::Vector3i>& positions) const {
  return grid_->values == Values::floats ? sum(*grid_->handle.grid<float>(), positions)
                                         : sum(*grid_->handle.grid<nanovdb::Fp8>(), positions);
}

}  // namespace airlight::experiments
