// Interface of the library airlight_vdb.so: reading and writing of OpenVDB files. It is a separate library because
// loading OpenVDB takes 40 ms (57,000 relocations), three times as long as all else that happens before main. Only
// commands that read or write such files load it.
#pragma once
#include <map>
#include <string>

#include "scene/flow/flow.h"
#include "scene/media/start_grids.h"
#include "scene/media/vdb_layout.h"

namespace airlight::scene::vdb {

struct Module {
  VoxelGrid (*read)(const std::string& path, const std::string& name, std::size_t max_voxels);
  VoxelGrid (*read_temperature)(const std::string& path, const std::string& name, std::size_t max_voxels);
  VelocityGrid (*read_velocity)(const std::string& path, const std::string& name, std::size_t max_voxels);
  std::vector<VdbEntry> (*list)(const std::string& path);
  void (*write)(const std::string& path, const VoxelGrid&, const std::string& name);
  void (*write_frame)(const std::string& path, Frame, const std::map<std::string, std::string>& notes);
};

}  // namespace airlight::scene::vdb

// Defined in the library.
extern "C" const airlight::scene::vdb::Module airlight_vdb;
