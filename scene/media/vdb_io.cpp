// Reading and writing OpenVDB files: the only source that sees OpenVDB.
//
// OpenVDB reads past the end of a file without an error and leaves what it did not find at zero. So the file is read
// here through a stream that throws at its end, and every grid must end where its descriptor says; the counts of active
// voxels that writers store are compared with what was found.
#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <Eigen/SVD>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>

#include "scene/atomic_file.h"
#include "scene/error.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene {
namespace {

// Our own writer's note of the samples' box, which is larger than the active voxels' where samples at its sides are
// zero.
const char* const origin_key = "airlight_origin_index";
const char* const size_key = "airlight_size";

void initialize_once() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

// One line of at most 200 characters: messages of damaged files can hold anything.
[[noreturn]] void fail(const std::string& where, const std::string& what) {
  std::string line;
  for (char c : what.substr(0, 200)) line += c >= ' ' && c <= '~' ? c : ' ';
  throw Error(where + ": " + line);
}

// What io::File does, with the stream in our hands.
class Reader : public openvdb::io::Archive {
 public:
  openvdb::GridBase::Ptr read(std::istream& stream, std::int64_t bytes, const std::string& name, std::string& names) {
    readHeader(stream);
    openvdb::io::StreamMetadata::Ptr metadata(new openvdb::io::StreamMetadata);
    metadata->setSeekable(true);
    openvdb::io::setStreamMetadataPtr(stream, metadata, /*transfer=*/false);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    openvdb::MetaMap file_metadata;
    file_metadata.readMeta(stream);

    openvdb::GridBase::Ptr found;
    const std::int32_t count = readGridCount(stream);
    for (std::int32_t i = 0; i < count; ++i) {
      openvdb::io::GridDescriptor descriptor;
      openvdb::GridBase::Ptr grid = descriptor.read(stream);
      names += (names.empty() ? "" : ", ") + descriptor.gridName();
      const bool wanted = !found && descriptor.gridName() == name;
      if (inputHasGridOffsets()) {
        const std::int64_t begin = descriptor.getGridPos(), end = descriptor.getEndPos();
        if (end > bytes)
          OPENVDB_THROW(openvdb::IoError,
                        fmt::format("truncated: its grids end at byte {}, the file at {}", end, bytes));
        if (begin < stream.tellg() || end < begin || descriptor.getBlockPos() < begin || descriptor.getBlockPos() > end)
          OPENVDB_THROW(openvdb::IoError, "damaged: its grid offsets are out of order");
        if (wanted) {
          descriptor.seekToGrid(stream);
          readGrid(grid, descriptor, stream);
          if (stream.tellg() != end)
            OPENVDB_THROW(openvdb::IoError, fmt::format("damaged: the grid ended at byte {}, expected {}",
                                                        std::int64_t(stream.tellg()), end));
        }
        descriptor.seekToEnd(stream);
      } else {
        readGrid(grid, descriptor, stream);
      }
      if (wanted) found = grid;
    }
    return found;
  }
};

class Writer : public openvdb::io::Archive {
 public:
  void write_to(std::ostream& stream, const openvdb::GridBase::ConstPtr& grid) const {
    openvdb::GridCPtrVec grids{grid};
    Archive::write(stream, grids, /*seekable=*/true);
  }
};

// World = index * matrix in OpenVDB's rows; ours is the transpose.
void set_transform(VoxelGrid& grid, const openvdb::math::Transform& transform, const std::string& where) {
  if (!transform.isLinear()) fail(where, "its transform is a frustum, expected a uniform scale with rotation");
  const openvdb::math::Mat4d m = transform.baseMap()->getAffineMap()->getMat4();
  Mat3 linear;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) linear(row, column) = m(column, row);
  grid.translation = {m(3, 0), m(3, 1), m(3, 2)};
  if (!linear.allFinite() || !grid.translation.allFinite()) fail(where, "its transform is not finite");

  if (linear(0, 0) > 0 && linear.isApprox(linear(0, 0) * Mat3::Identity(), 0)) {
    grid.voxel_size = linear(0, 0);
    return;
  }
  const Eigen::JacobiSVD<Mat3> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 scale = svd.singularValues();
  // Exporters compute in float: 1e-6 is their rounding.
  if (!(scale[2] > 0) || scale[0] - scale[2] > 1e-6 * scale[0])
    fail(where, fmt::format("its voxels measure {} x {} x {}, expected a uniform scale", scale[0], scale[1], scale[2]));
  grid.voxel_size = scale.mean();
  grid.rotation = svd.matrixU() * svd.matrixV().transpose();
}

std::string text(const openvdb::Coord& c) { return fmt::format("({}, {}, {})", c.x(), c.y(), c.z()); }

void check_value(float value, const openvdb::Coord& at, const std::string& where) {
  if (std::isfinite(value) && value >= 0) return;
  fail(where, fmt::format("voxel {} is {}, expected a finite density >= 0", text(at), value));
}

// The box of everything that is active or not zero.
openvdb::CoordBBox check_values(const openvdb::FloatGrid& tree, const std::string& where) {
  openvdb::CoordBBox box;
  for (auto value = tree.cbeginValueAll(); value; ++value) {
    if (*value == 0 && !value.isValueOn()) continue;
    openvdb::CoordBBox here;
    value.getBoundingBox(here);
    check_value(*value, here.min(), where);
    box.expand(here);
  }
  return box;
}

void check_statistics(const openvdb::FloatGrid& grid, const std::string& where) {
  using openvdb::GridBase;
  const auto count = grid.getMetadata<openvdb::Int64Metadata>(GridBase::META_FILE_VOXEL_COUNT);
  if (count && count->value() != std::int64_t(grid.activeVoxelCount()))
    fail(where,
         fmt::format("damaged: {} active voxels, its metadata says {}", grid.activeVoxelCount(), count->value()));
  const auto lo = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MIN);
  const auto hi = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MAX);
  if (!lo || !hi || grid.activeVoxelCount() == 0) return;
  const openvdb::CoordBBox said(openvdb::Coord(lo->value()), openvdb::Coord(hi->value()));
  const openvdb::CoordBBox found = grid.evalActiveVoxelBoundingBox();
  if (said != found)
    fail(where, fmt::format("damaged: active voxels from {} to {}, its metadata says {} to {}", text(found.min()),
                            text(found.max()), text(said.min()), text(said.max())));
}

// The samples' box: as our writer noted it, else what there is.
openvdb::CoordBBox sample_box(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& active) {
  const auto origin = grid.getMetadata<openvdb::Vec3IMetadata>(origin_key);
  const auto size = grid.getMetadata<openvdb::Vec3IMetadata>(size_key);
  if (!origin || !size) return active;
  const openvdb::CoordBBox noted(openvdb::Coord(origin->value()),
                                 openvdb::Coord(origin->value() + size->value() - openvdb::Vec3i(1)));
  return noted.empty() || (!active.empty() && !noted.isInside(active)) ? active : noted;
}

void copy_values(VoxelGrid& grid, const openvdb::FloatGrid& source, const openvdb::CoordBBox& box) {
  for (auto value = source.cbeginValueAll(); value; ++value) {
    if (*value == 0) continue;
    openvdb::CoordBBox here;
    value.getBoundingBox(here);
    here.intersect(box);
    for (int z = here.min().z(); z <= here.max().z(); ++z)
      for (int y = here.min().y(); y <= here.max().y(); ++y)
        for (int x = here.min().x(); x <= here.max().x(); ++x)
          grid.values[(x - box.min().x()) +
                      std::size_t(grid.size[0]) *
                          ((y - box.min().y()) + std::size_t(grid.size[1]) * (z - box.min().z()))] = *value;
  }
}

openvdb::FloatGrid::Ptr open_grid(const std::string& path, const std::string& name) {
  const std::string where = fmt::format("{}: grid '{}'", path, name);
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream || std::filesystem::is_directory(path)) fail(path, "cannot be read, expected an OpenVDB file");
  const std::int64_t bytes = stream.tellg();
  if (bytes == 0) fail(path, "is empty, expected an OpenVDB file");
  stream.seekg(0);
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  openvdb::GridBase::Ptr grid;
  std::string names;
  try {
    grid = Reader().read(stream, bytes, name, names);
  } catch (const std::ios_base::failure&) {
    fail(path, "truncated or damaged: it ends in the middle of a grid, expected an OpenVDB file");
  } catch (const std::exception& e) {
    fail(path, fmt::format("{}, expected an OpenVDB file", std::string(e.what()).substr(0, 150)));
  }
  if (!grid) fail(path, fmt::format("has no grid '{}', expected one of: {}", name, names.empty() ? "(none)" : names));
  const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
  if (!floats) fail(where, fmt::format("is of type {}, expected a float grid", grid->valueType()));
  return floats;
}

}  // namespace

VoxelGrid read_vdb(const std::string& path, const std::string& name, std::size_t max_voxels) {
  initialize_once();
  const std::string where = fmt::format("{}: grid '{}'", path, name);
  const openvdb::FloatGrid::Ptr source = open_grid(path, name);
  VoxelGrid grid;
  set_transform(grid, source->transform(), where);
  if (source->background() != 0)
    fail(where, fmt::format("has background {}, expected 0 (a fog volume)", source->background()));
  try {
    check_statistics(*source, where);
    const openvdb::CoordBBox box = sample_box(*source, check_values(*source, where));
    if (box.empty()) return grid;
    const double voxels = double(box.max().x()) - box.min().x() + 1;
    const double all =
        voxels * (double(box.max().y()) - box.min().y() + 1) * (double(box.max().z()) - box.min().z() + 1);
    if (all > double(max_voxels)) fail(where, fmt::format("spans {:.0f} voxels, expected at most {}", all, max_voxels));
    grid.size = {box.dim().x(), box.dim().y(), box.dim().z()};
    grid.origin_index = {box.min().x(), box.min().y(), box.min().z()};
    grid.values.assign(std::size_t(all), 0.0f);
    copy_values(grid, *source, box);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    fail(where, e.what());
  }
  return grid;
}

void write_vdb(const std::string& path, const VoxelGrid& grid, const std::string& name) {
  initialize_once();
  auto target = openvdb::FloatGrid::create(0.0f);
  target->setName(name);
  target->setGridClass(openvdb::GRID_FOG_VOLUME);
  openvdb::math::Mat4d m = openvdb::math::Mat4d::identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) m(column, row) = grid.voxel_size * grid.rotation(row, column);
  for (int axis = 0; axis < 3; ++axis) m(3, axis) = grid.translation[axis];
  target->setTransform(openvdb::math::Transform::createLinearTransform(m));
  target->insertMeta(origin_key, openvdb::Vec3IMetadata(openvdb::Vec3i(grid.origin_index.data())));
  target->insertMeta(size_key, openvdb::Vec3IMetadata(openvdb::Vec3i(grid.size.data())));

  auto accessor = target->getAccessor();
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i)
        if (const float value = grid.at(i, j, k); value != 0)
          accessor.setValue(
              openvdb::Coord(grid.origin_index[0] + i, grid.origin_index[1] + j, grid.origin_index[2] + k), value);

  std::ostringstream stream;
  Writer().write_to(stream, target);
  write_file_atomically(path, stream.view());
}

}  // namespace airlight::scene
