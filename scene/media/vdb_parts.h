// Common parts of reading and writing OpenVDB files: for vdb_*.cpp alone, the only sources that include OpenVDB.
#pragma once
#include <openvdb/openvdb.h>

#include <cmath>
#include <string>
#include <vector>

#include "scene/media/voxel_grid.h"

// OpenVDB's library instantiates these trees. Without these lines both files compile each function of a tree again. Clang calls inline
// members, such as cbeginValueAll() const, that a library built by GCC does not export.
#ifndef __clang__
extern template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
extern template class openvdb::tree::Tree<openvdb::Vec3STree::RootNodeType>;
#endif

namespace airlight::scene::vdb {

// Our own writer's notes of the samples' box, which is larger than the active voxels' where samples at its sides are
// zero, and of the checksum of its samples.
inline const char* const origin_key = "airlight_origin_index";
inline const char* const size_key = "airlight_size";
inline const char* const checksum_key = "airlight_xxh128";

void initialize_once();

// Messages of damaged files can hold anything.
[[noreturn]] void fail(const std::string& where, const std::string& what);

// Minus zero is kept: what is written comes back bit for bit.
inline bool is_plain_zero(float value) { return value == 0 && !std::signbit(value); }
inline bool is_plain_zero(const openvdb::Vec3s& v) {
  return is_plain_zero(v[0]) && is_plain_zero(v[1]) && is_plain_zero(v[2]);
}

std::string text(const openvdb::Coord&);

// Checksum of the samples and of the box that they fill.
std::string checksum(const Eigen::Vector3i& size, const Eigen::Vector3i& origin_index, const std::vector<float>&);

// The grid `name` of a file, each length in it checked before. Throws Error.
openvdb::GridBase::Ptr open_grid(const std::string& path, const std::string& name, const std::string& where,
                                 const std::string& type);
void check_statistics(const openvdb::GridBase&, const std::string& where);
// The samples' box: as our writer noted it, else what there is.
openvdb::CoordBBox sample_box(const openvdb::GridBase&, const openvdb::CoordBBox& active);
bool is_noted(const openvdb::GridBase&);
void note(openvdb::GridBase&, const Eigen::Vector3i& size, const Eigen::Vector3i& origin_index,
          const std::vector<float>& values);
void check_noted(const openvdb::GridBase&, const VoxelGrid& shape, const std::vector<float>& values,
                 const std::string& where);
// The place of a grid in the world, and the size of its samples' box. Throws Error.
VoxelGrid shape_of(const openvdb::GridBase&, const openvdb::CoordBBox& samples, std::size_t max_voxels,
                   const std::string& where);

// The bytes of a file with these grids. Equal grids give equal bytes.
std::string bytes_of(const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& notes = {});
openvdb::FloatGrid::Ptr fog_volume(const VoxelGrid&, const std::string& name);

template <class Grid>
struct Samples {
  typename Grid::Ptr grid;
  VoxelGrid shape;  // without values
  openvdb::CoordBBox box;

  // body(at, value) for all that are not zero; `at` counts the box's voxels, x fastest.
  template <class Body>
  void each(const Body& body) const {
    for (auto value = grid->cbeginValueAll(); value; ++value) {
      if (is_plain_zero(*value)) continue;
      openvdb::CoordBBox here;
      value.getBoundingBox(here);
      here.intersect(box);
      for (int z = here.min().z(); z <= here.max().z(); ++z)
        for (int y = here.min().y(); y <= here.max().y(); ++y)
          for (int x = here.min().x(); x <= here.max().x(); ++x)
            body((x - box.min().x()) + std::size_t(shape.size[0]) *
                                           ((y - box.min().y()) + std::size_t(shape.size[1]) * (z - box.min().z())),
                 *value);
    }
  }
};

// what_is_wrong(value): empty, or how the message about it goes on.
template <class Grid, class Wrong>
Samples<Grid> read_samples(const std::string& path, const std::string& name, const std::string& where,
                           std::size_t max_voxels, const Wrong& what_is_wrong) {
  initialize_once();
  Samples<Grid> samples;
  samples.grid = openvdb::gridPtrCast<Grid>(open_grid(path, name, where, Grid::TreeType::treeType()));
  if (!samples.grid) fail(where, "is of another type than it says");
  const typename Grid::ValueType zero(0.0f);
  if (samples.grid->background() != zero) fail(where, "has a background that is not 0, expected 0 (a fog volume)");
  check_statistics(*samples.grid, where);
  openvdb::CoordBBox used;  // the box of everything that is active or not zero
  for (auto value = samples.grid->cbeginValueAll(); value; ++value) {
    if (*value == zero && !value.isValueOn()) continue;
    openvdb::CoordBBox here;
    value.getBoundingBox(here);
    if (const std::string wrong = what_is_wrong(*value); !wrong.empty())
      fail(where, "voxel " + text(here.min()) + " is " + wrong);
    used.expand(here);
  }
  samples.box = sample_box(*samples.grid, used);
  samples.shape = shape_of(*samples.grid, samples.box, max_voxels, where);
  return samples;
}

}  // namespace airlight::scene::vdb
