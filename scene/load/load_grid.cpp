// A voxel grid: from an OpenVDB file, or a small one written in the scene file.
#include <fmt/format.h>

#include "scene/base/error.h"
#include "scene/load/assets.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene::load {
namespace {

// A file of a few bytes can span any number of voxels: these take a gigabyte.
constexpr std::size_t most_voxels = std::size_t(1) << 28;

VoxelGrid read_voxels(const TableReader& reader, const std::string& folder) {
  const std::string path = find_asset(reader, "file", name_of_frame(reader), folder);
  const std::string name = reader.text("grid", "density");
  try {
    return read_vdb(path, name, most_voxels);
  } catch (const Error& e) {
    reader.fail("file", e.what());
  }
}

VoxelGrid read_inline_voxels(const TableReader& reader) {
  VoxelGrid grid;
  const auto size = reader.integers("size", 3, 1, 1 << 20);
  grid.size = {int(size[0]), int(size[1]), int(size[2])};
  grid.voxel_size = reader.number("voxel_size", length);
  grid.translation = reader.vector("origin");
  const std::vector<double> values = reader.numbers("values", {0, density_range.greatest});
  const double expected = double(size[0]) * double(size[1]) * double(size[2]);
  if (double(values.size()) != expected)
    reader.fail("values", fmt::format("values has {} numbers, expected {} = {} x {} x {}, x fastest", values.size(),
                                      expected, size[0], size[1], size[2]));
  grid.values.assign(values.begin(), values.end());
  return grid;
}

}  // namespace

GridPointer read_grid(TableReader& reader, const std::string& folder) {
  reader.allow(medium_keys_and(
      {"file", "frame", "grid", "size", "voxel_size", "origin", "values", "clamp_border", "transform"}));
  const bool from_file = reader.one_of({"file", "values"}) == "file";
  if (from_file)
    reader.allow(medium_keys_and({"file", "frame", "grid", "clamp_border", "transform"}));
  else
    reader.allow(medium_keys_and({"size", "voxel_size", "origin", "values", "clamp_border", "transform"}));
  VoxelGrid grid = from_file ? read_voxels(reader, folder) : read_inline_voxels(reader);
  grid.clamp_border = reader.flag("clamp_border", grid.clamp_border);
  // world = outer(rotation * (voxel_size * index) + translation)
  const Similarity outer = read_transform(reader, "transform");
  grid.translation = outer(grid.translation);
  grid.rotation = outer.rotation * grid.rotation;
  grid.voxel_size *= outer.scale;
  require_near(reader, from_file ? "file" : "size", grid);
  return std::make_shared<const VoxelGrid>(std::move(grid));
}

}  // namespace airlight::scene::load
