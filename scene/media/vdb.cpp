// Reading and writing of OpenVDB files, by the library airlight_vdb.so, which is loaded on first use.
#include <dlfcn.h>

#include "scene/base/error.h"
#include "scene/media/vdb_module.h"

namespace airlight::scene {
namespace {

const vdb::Module& load() {
  void* const library = dlopen("airlight_vdb.so", RTLD_LAZY | RTLD_LOCAL);
  const void* const found = library ? dlsym(library, "airlight_vdb") : nullptr;
  if (!found) throw Error(std::string("OpenVDB files cannot be read or written: ") + dlerror());
  return *static_cast<const vdb::Module*>(found);
}

const vdb::Module& openvdb() {
  static const vdb::Module& loaded = load();
  return loaded;
}

}  // namespace

VoxelGrid read_vdb(const std::string& path, const std::string& name, std::size_t max_voxels) {
  return openvdb().read(path, name, max_voxels);
}

VoxelGrid read_temperature_vdb(const std::string& path, const std::string& name, std::size_t max_voxels) {
  return openvdb().read_temperature(path, name, max_voxels);
}

VelocityGrid read_velocity_vdb(const std::string& path, const std::string& name, std::size_t max_voxels) {
  return openvdb().read_velocity(path, name, max_voxels);
}

std::vector<VdbEntry> list_vdb(const std::string& path) { return openvdb().list(path); }

void write_vdb(const std::string& path, const VoxelGrid& grid, const std::string& name) {
  openvdb().write(path, grid, name);
}

void write_frame(const std::string& path, Frame frame, const std::map<std::string, std::string>& notes) {
  openvdb().write_frame(path, std::move(frame), notes);
}

}  // namespace airlight::scene
