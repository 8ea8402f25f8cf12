#include "gpu/compensated_ray_marching/smoke_columns.h"

#include <algorithm>

namespace airlight::gpu::compensated_ray_marching {
namespace {

// Cells of a work group: of Gaussians, which it chooses, a cube; of voxels a row, whose rays go the same way.
const Eigen::Vector3i cube(4, 4, 4), row(32, 2, 1);
constexpr float blocked = 1e37F;  // [m]

Program& columns_program(Context& context, Definitions definitions) {
  const Eigen::Vector3i& block = definitions.at("GAUSSIANS") == "1" ? cube : row;
  definitions["LOCAL_SIZE_Z"] = std::to_string(block[2]);
  return program(context, "node_columns", block[0], block[1], definitions);
}

}  // namespace

void set_grid(Program& p, const airlight::compensated_ray_marching::NodeGrid& grid, const Point3& middle) {
  const auto& size = grid.cells.size;
  p.set("corner", Vec3(grid.corner - middle));
  p.set("cell_edge", grid.cells.cell[0]);
  p.set("cells_along", Vec3(size[0], size[1], size[2]));
}

SmokeColumns::SmokeColumns(Context& context, const scene::Scene& scene,
                           const airlight::compensated_ray_marching::LitGrid& grid, const SmokeDensity& density,
                           const Point3& middle)
    : context_(context),
      scene_(scene),
      grid_(grid),
      density_(density),
      middle_(middle),
      program_(columns_program(context, density.definitions())),
      nodes_(std::make_unique<Buffer>(context, "nodes", std::vector<int>(grid.nodes().begin(), grid.nodes().end()))) {
  std::vector<int> node_of_cell(std::size_t(grid.grid().cells.nodes()), -1);
  for (std::size_t i = 0; i < grid.nodes().size(); ++i) node_of_cell[std::size_t(grid.nodes()[i])] = int(i);
  node_of_cell_ = std::make_unique<Buffer>(context, "nodes of cells", node_of_cell);
  if (scene.geometry)
    hidden_ = std::make_unique<Buffer>(context, "hidden nodes", 4 * ((grid.nodes().size() + 31) / 32));
}

bool SmokeColumns::aim(const airlight::compensated_ray_marching::IncomingLight& light,
                       const scene::Execution& execution) {
  const std::size_t fixed = light.fixed(), lights = light.directions().size() - fixed, nodes = grid_.nodes().size();
  bool moved = !values_ || lights != lights_;
  if (!values_ || lights > towards_.size()) {
    std::vector<float> columns;
    for (std::size_t k = 0; k < fixed; ++k)
      for (const float c : grid_.columns()[k]) columns.push_back(std::min(c, blocked));
    values_ = std::make_unique<Buffer>(context_, "columns", 4 * nodes * (fixed + lights), Contents::undefined);
    values_->upload(columns);
    towards_.assign(lights, Vec3::Zero());
  }
  for (std::size_t l = 0; l < lights; ++l) {
    const Vec3& to_light = light.directions()[fixed + l];
    if (towards_[l] == to_light) continue;
    find(fixed + l, to_light, execution);
    towards_[l] = to_light;
    moved = true;
  }
  lights_ = lights;
  return moved;
}

void SmokeColumns::find(std::size_t direction, const Vec3& to_light, const scene::Execution& execution) {
  if (hidden_) hidden_->upload(hidden_from(to_light, execution));
  density_.bind(program_);
  node_of_cell_->bind(at::node_of_cell);
  values_->bind(at::found_columns);
  (hidden_ ? *hidden_ : *nodes_).bind(at::hidden_nodes);
  set_grid(program_, grid_.grid(), middle_);
  program_.set("has_objects", hidden_ != nullptr);
  program_.set("node_count", count());
  program_.set("direction", int(direction));
  program_.set("to_light", to_light);
  program_.set("widths2", density_.widths2());
  program_.set("loop_count", 3);
  const auto& size = grid_.grid().cells.size;
  program_.dispatch(size[0], size[1], size[2]);
}

std::vector<std::uint32_t> SmokeColumns::hidden_from(const Vec3& to_light, const scene::Execution& execution) const {
  std::vector<std::uint32_t> hidden(hidden_->bytes() / 4, 0);
  scene::parallel_for(int(hidden.size()), execution, [&](int word) {
    const std::size_t first = 32 * std::size_t(word), last = std::min(first + 32, grid_.nodes().size());
    for (std::size_t i = first; i < last; ++i)
      if (scene_.geometry->occluded({grid_.grid().node(grid_.nodes()[i]), to_light}))
        hidden[std::size_t(word)] |= 1u << (i % 32);
  });
  return hidden;
}

}  // namespace airlight::gpu::compensated_ray_marching
