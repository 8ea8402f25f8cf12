// A fitted grid: Gaussians as a CSV file, what they leave as a residual file, both as `airlight fit` writes them.
#include "scene/base/error.h"
#include "scene/convert/residual_file.h"
#include "scene/load/assets.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/media/fitted.h"

namespace airlight::scene::load {
namespace {

std::shared_ptr<const Residual> read_residual_of(const TableReader& reader, const std::string& folder) {
  const std::string path = find_asset(reader, "residual", name_of_frame(reader, "residual"), folder);
  try {
    return std::make_shared<const Residual>(read_residual(path));
  } catch (const Error& e) {
    reader.fail("residual", e.what());
  }
}

// The samples at which Gaussians without a residual are taken.
VoxelGrid read_layout(const TableReader& reader) {
  VoxelGrid grid;
  const auto size = reader.integers("size", 3, 1, 1 << 20);
  grid.size = {int(size[0]), int(size[1]), int(size[2])};
  if (double(size[0]) * double(size[1]) * double(size[2]) > 1 << 28) reader.expected("size", "2^28 samples or fewer");
  grid.voxel_size = reader.number("voxel_size", length);
  grid.translation = reader.vector("origin");
  grid.clamp_border = reader.flag("clamp_border", false);
  return grid;
}

}  // namespace

FittedPointer read_fitted(TableReader& reader, const std::string& folder) {
  reader.allow(medium_keys_and(
      {"gaussians", "residual", "frame", "with_residual", "size", "voxel_size", "origin", "cutoff", "clamp_border"}));
  auto fitted = std::make_shared<Fitted>();
  const std::string csv = find_asset(reader, "gaussians", name_of_frame(reader, "gaussians"), folder);
  fitted->gaussians.gaussians = read_gaussians_csv(csv);
  if (reader.one_of({"residual", "size"}) == "size") {
    reader.allow(medium_keys_and({"gaussians", "frame", "size", "voxel_size", "origin", "cutoff", "clamp_border"}));
    fitted->gaussians.cutoff = reader.number("cutoff", widths, infinity);
    const VoxelGrid layout = read_layout(reader);
    require_near(reader, "size", layout);
    fitted->grid = decoded(layout, fitted->gaussians, {});
    return fitted;
  }
  reader.allow(medium_keys_and({"gaussians", "residual", "frame", "with_residual"}));
  const auto residual = read_residual_of(reader, folder);
  require_near(reader, "residual", residual->layout);
  fitted->gaussians.cutoff = residual->cutoff;
  if (!belongs_to(*residual, fitted->gaussians))
    reader.fail("residual", "the residual is of other Gaussians than " + csv);
  if (reader.flag("with_residual", true)) {
    fitted->residual = residual;
    fitted->grid = decoded(fitted->gaussians, *residual);
  } else {
    fitted->grid = decoded(residual->layout, fitted->gaussians, {});
  }
  return fitted;
}

}  // namespace airlight::scene::load
