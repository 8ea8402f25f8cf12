// Densities, temperatures, velocities and frames of flows as grids of OpenVDB.
#include <fmt/format.h>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"
#include "scene/flow/flow.h"
#include "scene/media/vdb_module.h"
#include "scene/media/vdb_parts.h"

namespace airlight::scene::vdb {
namespace {

// Converts exceptions of OpenVDB to an Error that says where.
template <class Body>
auto telling(const std::string& where, const Body& body) {
  try {
    return body();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    fail(where, e.what());
  }
}

std::string grid_of(const std::string& path, const std::string& name) {
  return fmt::format("{}: grid '{}'", path, name);
}

template <class Wrong>
VoxelGrid read_floats(const std::string& path, const std::string& name, std::size_t max_voxels, const Wrong& wrong) {
  const std::string where = grid_of(path, name);
  return telling(where, [&] {
    const auto samples = read_samples<openvdb::FloatGrid>(path, name, where, max_voxels, wrong);
    VoxelGrid grid = samples.shape;
    grid.values.assign(std::size_t(grid.size[0]) * grid.size[1] * grid.size[2], 0.0f);
    samples.each([&](std::size_t at, float value) { grid.values[at] = value; });
    check_noted(*samples.grid, grid, grid.values, where);
    return grid;
  });
}

}  // namespace

VoxelGrid read(const std::string& path, const std::string& name, std::size_t max_voxels) {
  return read_floats(path, name, max_voxels, [](float value) {
    if (std::isfinite(value) && value >= 0) return std::string();
    return fmt::format("{}, expected a finite density >= 0", value);
  });
}

VoxelGrid read_temperature(const std::string& path, const std::string& name, std::size_t max_voxels) {
  return read_floats(path, name, max_voxels, [](float value) {
    if (std::abs(value) <= greatest_start) return std::string();
    return fmt::format("{}, expected a temperature of at most {} K", value, greatest_start);
  });
}

VelocityGrid read_velocity(const std::string& path, const std::string& name, std::size_t max_voxels) {
  const std::string where = grid_of(path, name);
  return telling(where, [&] {
    const auto samples =
        read_samples<openvdb::Vec3SGrid>(path, name, where, max_voxels, [](const openvdb::Vec3s& v) -> std::string {
          bool good = true;
          for (int a = 0; a < 3; ++a) good &= std::abs(v[a]) <= greatest_start;
          if (good) return {};
          return fmt::format("({}, {}, {}), expected components of at most {} m/s", v[0], v[1], v[2], greatest_start);
        });
    const VoxelGrid& shape = samples.shape;
    if (shape.rotation != Mat3::Identity()) fail(where, "is rotated, expected axes along those of the world");
    std::vector<float> values(3 * std::size_t(shape.size[0]) * shape.size[1] * shape.size[2]);
    samples.each([&](std::size_t at, const openvdb::Vec3s& v) {
      for (int a = 0; a < 3; ++a) values[3 * at + a] = v[a];
    });
    check_noted(*samples.grid, shape, values, where);
    const bool staggered = samples.grid->getGridClass() == openvdb::GRID_STAGGERED;
    VelocityGrid velocity;
    for (int a = 0; a < 3; ++a) {
      VoxelGrid& grid = velocity[a] = shape;
      if (staggered) grid.translation[a] -= 0.5 * grid.voxel_size;
      // Frames have one cell more along each axis, of which there are the faces across it alone.
      if (staggered && is_noted(*samples.grid))
        for (int b = 0; b < 3; ++b) grid.size[b] -= b != a;
      for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
          for (int i = 0; i < grid.size[0]; ++i)
            grid.values.push_back(
                values[3 * (i + std::size_t(shape.size[0]) * (j + std::size_t(shape.size[1]) * k)) + a]);
    }
    return velocity;
  });
}

void write(const std::string& path, const VoxelGrid& grid, const std::string& name) {
  initialize_once();
  write_file_atomically(path, bytes_of({fog_volume(grid, name)}));
}

namespace {

openvdb::Vec3SGrid::Ptr staggered(const Frame& frame, const openvdb::math::Transform& transform) {
  auto target = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  target->setName("velocity");
  target->setGridClass(openvdb::GRID_STAGGERED);
  target->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
  target->setTransform(transform.copy());
  note(*target, frame.size + Eigen::Vector3i::Ones(), Eigen::Vector3i::Zero(), frame.velocity);
  auto accessor = target->getAccessor();
  const float* value = frame.velocity.data();
  for (int k = 0; k <= frame.size[2]; ++k)
    for (int j = 0; j <= frame.size[1]; ++j)
      for (int i = 0; i <= frame.size[0]; ++i, value += 3)
        if (const openvdb::Vec3s v(value); !is_plain_zero(v)) accessor.setValue(openvdb::Coord(i, j, k), v);
  return target;
}

}  // namespace

void write_frame(const std::string& path, Frame frame, const std::map<std::string, std::string>& notes) {
  initialize_once();
  VoxelGrid cells;
  cells.size = frame.size;
  cells.voxel_size = frame.cell;
  cells.translation = frame.low + 0.5 * frame.cell * Vec3::Ones();
  openvdb::GridCPtrVec grids;
  const auto add = [&](std::vector<float>& values, const std::string& name) {
    cells.values = std::move(values);
    cells.values.resize(std::size_t(frame.size[0]) * frame.size[1] * frame.size[2], 0.0f);
    grids.push_back(fog_volume(cells, name));
  };
  add(frame.density, "density");
  if (!frame.temperature.empty()) add(frame.temperature, "temperature");
  for (auto& [name, values] : frame.densities) add(values, name);
  cells.values = {};
  grids.push_back(staggered(frame, grids.front()->transform()));
  frame.velocity = {};
  openvdb::MetaMap metadata;
  for (const auto& [key, value] : notes) metadata.insertMeta(key, openvdb::StringMetadata(value));
  write_file_atomically(path, bytes_of(grids, metadata));
}

std::vector<VdbEntry> list(const std::string& path) {
  const std::string file = read_whole_file(path, std::size_t(1) << 29);
  return telling(path, [&] { return vdb_grids(file); });
}

}  // namespace airlight::scene::vdb

extern "C" const airlight::scene::vdb::Module airlight_vdb = {
    airlight::scene::vdb::read,          airlight::scene::vdb::read_temperature,
    airlight::scene::vdb::read_velocity, airlight::scene::vdb::list,
    airlight::scene::vdb::write,         airlight::scene::vdb::write_frame};
