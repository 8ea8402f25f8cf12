// The reading and the writing of whole files.
//
// A file is checked by vdb_layout.h before OpenVDB reads it. Then what it holds is compared with what its metadata
// says: the number and the box of active voxels (stored by every writer that uses the library) and the checksum of the
// samples (stored by ours). Damage within the compressed samples of other writers can go unseen: a checksum beside the
// file, PATH.xxh128 as `xxh128sum` prints it, closes that gap where there is one.
#include "scene/media/vdb_parts.h"

#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <xxhash.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>

#include "scene/base/error.h"
#include "scene/base/limits.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/media/vdb_layout.h"

namespace airlight::scene::vdb {

void initialize_once() {
  static std::once_flag once;
  std::call_once(once, [] {
    openvdb::initialize();
    // The table for lazy loading, which we do not use, is read without checks; as an unknown type it is skipped.
    openvdb::Metadata::unregisterType("__delayedload");
  });
}

void fail(const std::string& where, const std::string& what) { throw Error(where + ": " + printable(what, 200)); }

namespace {

std::string hex128(XXH128_hash_t hash) { return fmt::format("{:016x}{:016x}", hash.high64, hash.low64); }

}  // namespace

std::string checksum(const Eigen::Vector3i& size, const Eigen::Vector3i& origin_index,
                     const std::vector<float>& values) {
  const std::int32_t box[6] = {size[0], size[1], size[2], origin_index[0], origin_index[1], origin_index[2]};
  const XXH64_hash_t seed = XXH3_64bits(box, sizeof box);
  return hex128(XXH3_128bits_withSeed(values.data(), values.size() * sizeof(float), seed));
}

namespace {

// The checksum beside the file, if there is one.
void check_sidecar(const std::string& path, std::string_view file) {
  if (std::error_code code; !std::filesystem::is_regular_file(path + ".xxh128", code)) return;
  std::ifstream stream(path + ".xxh128");
  std::string expected;
  if (!stream || !(stream >> expected)) return;
  const std::string found = hex128(XXH3_128bits(file.data(), file.size()));
  if (found != expected)
    fail(path, fmt::format("damaged: its checksum is {}, {}.xxh128 says {}", found, path, expected.substr(0, 32)));
}

// Reads like io::File, from bytes that have been checked.
class Reader : public openvdb::io::Archive {
 public:
  openvdb::GridBase::Ptr read(std::istream& stream, const VdbEntry& entry) {
    readHeader(stream);
    openvdb::io::StreamMetadata::Ptr metadata(new openvdb::io::StreamMetadata);
    metadata->setSeekable(true);
    openvdb::io::setStreamMetadataPtr(stream, metadata, /*transfer=*/false);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    stream.seekg(entry.descriptor);
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid = descriptor.read(stream);
    stream.seekg(entry.begin);
    readGrid(grid, descriptor, stream);
    if (stream.tellg() != std::streamoff(entry.end))
      throw std::runtime_error(
          fmt::format("damaged: read to byte {}, expected {}", std::int64_t(stream.tellg()), entry.end));
    return grid;
  }
};

class Writer : public openvdb::io::Archive {
 public:
  // Equal grids give equal bytes: OpenVDB marks each file with a random number, which is here computed
  // from the content.
  std::string bytes_of(const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& notes = {}) const {
    // Doubled as it grows the text would take three times its length.
    std::string room;
    std::size_t most = 1 << 16;
    for (const auto& grid : grids) most += grid->memUsage();
    room.reserve(most);
    std::ostringstream stream(std::move(room));
    Archive::write(stream, grids, /*seekable=*/true, notes);
    std::string bytes = std::move(stream).str();
    constexpr std::size_t mark = 21, length = 36;  // after magic, three versions and a flag: 8-4-4-4-12 digits
    bytes.replace(mark, length, length, '0');
    std::string digits = hex128(XXH3_128bits(bytes.data(), bytes.size()));
    for (const std::size_t dash : {8, 13, 18, 23}) digits.insert(dash, "-");
    return bytes.replace(mark, length, digits);
  }
};

void set_transform(VoxelGrid& grid, const openvdb::math::Transform& transform, const std::string& where) {
  if (!transform.isLinear()) fail(where, "its transform is a frustum, expected a uniform scale with rotation");
  // Not by its matrix: OpenVDB takes one of a determinant below 1e-15, voxels of 10 um, for singular and throws.
  const openvdb::math::MapBase& map = *transform.baseMap();
  Mat3 linear;
  for (int axis = 0; axis < 3; ++axis) {
    openvdb::Vec3d unit(0.0);
    unit[axis] = 1;
    linear.col(axis) = Eigen::Map<const Vec3>(map.applyJacobian(unit).asPointer());
  }
  grid.translation = Eigen::Map<const Vec3>(map.applyMap(openvdb::Vec3d(0.0)).asPointer());
  if (!linear.allFinite() || !grid.translation.allFinite()) fail(where, "its transform is not finite");

  if (linear(0, 0) > 0 && linear.isApprox(linear(0, 0) * Mat3::Identity(), 0)) {
    grid.voxel_size = linear(0, 0);
    return;
  }
  const Eigen::JacobiSVD<Mat3> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3& scale = svd.singularValues();
  // Exporters compute in float: 1e-6 is their rounding.
  if (!(scale[2] > 0) || scale[0] - scale[2] > 1e-6 * scale[0])
    fail(where, fmt::format("its voxels measure {} x {} x {}, expected a uniform scale", scale[0], scale[1], scale[2]));
  grid.voxel_size = scale.mean();
  grid.rotation = svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace

std::string text(const openvdb::Coord& c) { return fmt::format("({}, {}, {})", c.x(), c.y(), c.z()); }

void check_statistics(const openvdb::GridBase& grid, const std::string& where) {
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

openvdb::CoordBBox sample_box(const openvdb::GridBase& grid, const openvdb::CoordBBox& active) {
  const auto origin = grid.getMetadata<openvdb::Vec3IMetadata>(origin_key);
  const auto size = grid.getMetadata<openvdb::Vec3IMetadata>(size_key);
  if (!origin || !size) return active;
  const openvdb::CoordBBox noted(openvdb::Coord(origin->value()),
                                 openvdb::Coord(origin->value() + size->value() - openvdb::Vec3i(1)));
  return noted.empty() || (!active.empty() && !noted.isInside(active)) ? active : noted;
}

bool is_noted(const openvdb::GridBase& grid) { return grid.getMetadata<openvdb::Vec3IMetadata>(size_key) != nullptr; }

void note(openvdb::GridBase& grid, const Eigen::Vector3i& size, const Eigen::Vector3i& origin_index,
          const std::vector<float>& values) {
  grid.insertMeta(origin_key, openvdb::Vec3IMetadata(openvdb::Vec3i(origin_index.data())));
  grid.insertMeta(size_key, openvdb::Vec3IMetadata(openvdb::Vec3i(size.data())));
  grid.insertMeta(checksum_key, openvdb::StringMetadata(checksum(size, origin_index, values)));
}

void check_noted(const openvdb::GridBase& grid, const VoxelGrid& shape, const std::vector<float>& values,
                 const std::string& where) {
  const auto noted = grid.getMetadata<openvdb::StringMetadata>(checksum_key);
  if (noted && noted->value() != checksum(shape.size, shape.origin_index, values))
    fail(where, "damaged: its samples do not match their checksum");
}

VoxelGrid shape_of(const openvdb::GridBase& grid, const openvdb::CoordBBox& box, std::size_t max_voxels,
                   const std::string& where) {
  VoxelGrid shape;
  set_transform(shape, grid.transform(), where);
  if (box.empty()) return shape;
  double all = 1;
  for (int a = 0; a < 3; ++a) all *= double(box.max()[a]) - box.min()[a] + 1;
  if (all > double(max_voxels)) fail(where, fmt::format("spans {:.0f} voxels, expected at most {}", all, max_voxels));
  require_memory(all * sizeof(float), fmt::format("{}: {:.0f} voxels", where, all));
  shape.size = {box.dim().x(), box.dim().y(), box.dim().z()};
  shape.origin_index = {box.min().x(), box.min().y(), box.min().z()};
  return shape;
}

namespace {

// NAME, or NAME[1] where several grids have that name, counted from 0.
const VdbEntry& find_entry(const std::vector<VdbEntry>& entries, const std::string& name) {
  const auto named = [&](const std::string& wanted) {
    std::vector<const VdbEntry*> found;
    for (const VdbEntry& entry : entries)
      if (entry.name == wanted) found.push_back(&entry);
    return found;
  };
  if (const auto found = named(name); found.size() == 1)
    return *found.front();
  else if (found.size() > 1)
    throw std::runtime_error(fmt::format("has {0} grids '{1}', expected one of '{1}[0]' to '{1}[{2}]'", found.size(),
                                         name, found.size() - 1));
  if (const std::size_t bracket = name.rfind('['); bracket != std::string::npos && name.ends_with(']')) {
    const auto found = named(name.substr(0, bracket));
    std::size_t index = 0;
    const char *begin = name.data() + bracket + 1, *end = name.data() + name.size() - 1;
    const auto [stop, code] = std::from_chars(begin, end, index);
    if (code == std::errc() && stop == end && index < found.size()) return *found[index];
  }
  std::string names;
  for (const VdbEntry& entry : entries)
    names += (names.empty() ? "" : ", ") + (entry.name.empty() ? "one without a name, \"\"" : entry.name);
  throw std::runtime_error(fmt::format("has no grid '{}', only: {}", name, names.empty() ? "(none)" : names));
}

void check_entry(std::string_view file, const VdbEntry& entry, const std::string& type) {
  if (!is_of_type(entry, type)) throw std::runtime_error(fmt::format("is of type {}, expected {}", entry.type, type));
  check_grid(file, entry);
}

}  // namespace

openvdb::GridBase::Ptr open_grid(const std::string& path, const std::string& name, const std::string& where,
                                 const std::string& type) {
  std::istringstream stream(read_whole_file(path, std::size_t(1) << 29));
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  const std::string_view file = stream.view();
  check_sidecar(path, file);
  std::string subject = path;
  try {
    const std::vector<VdbEntry> entries = vdb_grids(file);
    const VdbEntry& entry = find_entry(entries, name);
    subject = where;
    check_entry(file, entry, type);
    openvdb::GridBase::Ptr grid = Reader().read(stream, entry);
    if (entry.parent.empty()) return grid;
    // Another grid's samples, with a place and notes of its own.
    const auto parent = std::find_if(entries.begin(), entries.end(), [&](const VdbEntry& e) {
      return e.unique_name == entry.parent && e.parent.empty();
    });
    if (parent == entries.end())
      throw std::runtime_error(
          fmt::format("damaged: shares the samples of a grid '{}' that is not there", entry.parent));
    check_entry(file, *parent, type);
    stream.seekg(0);
    grid->setTree(Reader().read(stream, *parent)->baseTreePtr());
    return grid;
  } catch (const std::ios_base::failure&) {
    fail(subject, "damaged: OpenVDB reads beyond its end");
  } catch (const std::exception& e) {
    fail(subject, e.what());
  }
}

std::string bytes_of(const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& notes) {
  return Writer().bytes_of(grids, notes);
}

openvdb::FloatGrid::Ptr fog_volume(const VoxelGrid& grid, const std::string& name) {
  auto target = openvdb::FloatGrid::create(0.0f);
  target->setName(name);
  target->setGridClass(openvdb::GRID_FOG_VOLUME);
  openvdb::math::Mat4d m = openvdb::math::Mat4d::identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) m(column, row) = grid.voxel_size * grid.rotation(row, column);
  for (int axis = 0; axis < 3; ++axis) m(3, axis) = grid.translation[axis];
  target->setTransform(openvdb::math::Transform::createLinearTransform(m));
  note(*target, grid.size, grid.origin_index, grid.values);
  auto accessor = target->getAccessor();
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i)
        if (const float value = grid.at(i, j, k); !is_plain_zero(value))
          accessor.setValue(
              openvdb::Coord(grid.origin_index[0] + i, grid.origin_index[1] + j, grid.origin_index[2] + k), value);
  return target;
}

}  // namespace airlight::scene::vdb
