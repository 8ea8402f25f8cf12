// Reading and writing OpenVDB files: the only source that sees OpenVDB.
//
// A file is checked by vdb_layout.h before OpenVDB reads it. Then what it holds is compared with what its metadata
// says: the number and the box of active voxels (stored by every writer that uses the library) and the checksum of the
// samples (stored by ours). Damage within the compressed samples of other writers can go unseen: a checksum beside the
// file, PATH.xxh128 as `xxh128sum` prints it, closes that gap where there is one.
#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>
#include <xxhash.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>

#include "scene/atomic_file.h"
#include "scene/error.h"
#include "scene/flow.h"
#include "scene/media/vdb_layout.h"
#include "scene/media/voxel_grid.h"
#include "scene/printable.h"
#include "scene/read_file.h"

namespace airlight::scene {
namespace {

// Our own writer's note of the samples' box, which is larger than the active voxels' where samples at its sides are
// zero.
const char* const origin_key = "airlight_origin_index";
const char* const size_key = "airlight_size";
const char* const checksum_key = "airlight_xxh128";

void initialize_once() {
  static std::once_flag once;
  std::call_once(once, [] {
    openvdb::initialize();
    // The table for lazy loading, which we do not use, is read without checks; as an unknown type it is skipped.
    openvdb::Metadata::unregisterType("__delayedload");
  });
}

// Messages of damaged files can hold anything.
[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Error(where + ": " + printable(what, 200));
}

// Minus zero is kept: what is written comes back bit for bit.
bool is_plain_zero(float value) { return value == 0 && !std::signbit(value); }

std::string hex128(XXH128_hash_t hash) { return fmt::format("{:016x}{:016x}", hash.high64, hash.low64); }

// Of the samples and their box.
std::string checksum(const VoxelGrid& grid) {
  const std::int32_t box[6] = {grid.size[0],         grid.size[1],         grid.size[2],
                               grid.origin_index[0], grid.origin_index[1], grid.origin_index[2]};
  const XXH64_hash_t seed = XXH3_64bits(box, sizeof box);
  return hex128(XXH3_128bits_withSeed(grid.values.data(), grid.values.size() * sizeof(float), seed));
}

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

// What io::File does, on bytes that have been checked.
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
  // The same grids give the same bytes: OpenVDB marks each file with a random number, which is made from the rest here.
  std::string bytes_of(const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& notes = {}) const {
    std::ostringstream stream;
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
    if (is_plain_zero(*value)) continue;
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

openvdb::FloatGrid::Ptr open_grid(const std::string& path, const std::string& name, const std::string& where) {
  std::istringstream stream(read_whole_file(path, std::size_t(1) << 29));
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  const std::string_view file = stream.view();
  check_sidecar(path, file);
  std::string subject = path;
  try {
    const std::vector<VdbEntry> entries = vdb_grids(file);
    std::string names;
    for (const VdbEntry& entry : entries) names += (names.empty() ? "" : ", ") + entry.name;
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const VdbEntry& e) { return e.name == name; });
    if (entry == entries.end())
      throw std::runtime_error(fmt::format("has no grid '{}', only: {}", name, names.empty() ? "(none)" : names));
    subject = where;
    if (!is_float_grid(*entry))
      throw std::runtime_error(fmt::format("is of type {}, expected Tree_float_5_4_3", entry->type));
    if (entry->is_instance) throw std::runtime_error("shares the samples of another grid, expected its own");
    check_float_grid(file, *entry);
    auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(Reader().read(stream, *entry));
    if (!grid) throw std::runtime_error("is not a float grid");
    return grid;
  } catch (const std::ios_base::failure&) {
    fail(subject, "damaged: OpenVDB reads beyond its end");
  } catch (const std::exception& e) {
    fail(subject, e.what());
  }
}

}  // namespace

VoxelGrid read_vdb(const std::string& path, const std::string& name, std::size_t max_voxels) {
  initialize_once();
  const std::string where = fmt::format("{}: grid '{}'", path, name);
  const openvdb::FloatGrid::Ptr source = open_grid(path, name, where);
  VoxelGrid grid;
  try {
    set_transform(grid, source->transform(), where);
    if (source->background() != 0)
      fail(where, fmt::format("has background {}, expected 0 (a fog volume)", source->background()));
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
    const auto noted = source->getMetadata<openvdb::StringMetadata>(checksum_key);
    if (noted && noted->value() != checksum(grid)) fail(where, "damaged: its samples do not match their checksum");
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    fail(where, e.what());
  }
  return grid;
}

namespace {

openvdb::FloatGrid::Ptr fog_volume(const VoxelGrid& grid, const std::string& name) {
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
  target->insertMeta(checksum_key, openvdb::StringMetadata(checksum(grid)));
  auto accessor = target->getAccessor();
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i)
        if (const float value = grid.at(i, j, k); !is_plain_zero(value))
          accessor.setValue(
              openvdb::Coord(grid.origin_index[0] + i, grid.origin_index[1] + j, grid.origin_index[2] + k), value);
  return target;
}

// Signed values, which read_vdb would refuse, are for other programs.
openvdb::Vec3SGrid::Ptr staggered(const Frame& frame, const openvdb::math::Transform& transform) {
  auto target = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  target->setName("velocity");
  target->setGridClass(openvdb::GRID_STAGGERED);
  target->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
  target->setTransform(transform.copy());
  auto accessor = target->getAccessor();
  const float* value = frame.velocity.data();
  for (int k = 0; k <= frame.size[2]; ++k)
    for (int j = 0; j <= frame.size[1]; ++j)
      for (int i = 0; i <= frame.size[0]; ++i, value += 3)
        if (value[0] != 0 || value[1] != 0 || value[2] != 0)
          accessor.setValue(openvdb::Coord(i, j, k), openvdb::Vec3s(value));
  return target;
}

}  // namespace

void write_vdb(const std::string& path, const VoxelGrid& grid, const std::string& name) {
  initialize_once();
  write_file_atomically(path, Writer().bytes_of({fog_volume(grid, name)}));
}

void write_frame(const std::string& path, const Frame& frame, const std::map<std::string, std::string>& notes) {
  initialize_once();
  VoxelGrid cells;
  cells.size = frame.size;
  cells.voxel_size = frame.cell;
  cells.translation = frame.low + 0.5 * frame.cell * Vec3::Ones();
  openvdb::GridCPtrVec grids;
  const auto add = [&](const std::vector<float>& values, const char* name) {
    cells.values = values.empty() ? std::vector<float>(std::size_t(frame.size.prod()), 0.0f) : values;
    grids.push_back(fog_volume(cells, name));
  };
  add(frame.density, "density");
  if (!frame.temperature.empty()) add(frame.temperature, "temperature");
  grids.push_back(staggered(frame, grids.front()->transform()));
  openvdb::MetaMap metadata;
  for (const auto& [key, value] : notes) metadata.insertMeta(key, openvdb::StringMetadata(value));
  write_file_atomically(path, Writer().bytes_of(grids, metadata));
}

}  // namespace airlight::scene
