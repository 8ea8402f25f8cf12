#include <fmt/format.h>

#include <bit>
#include <filesystem>

#include "experiments/cli/commands.h"
#include "scene/atomic_file.h"
#include "scene/convert/fogmap_columns.h"
#include "scene/error.h"
#include "scene/film.h"
#include "scene/grey_image.h"

namespace airlight::experiments::cli {
namespace {

std::string kind_of(const std::string& out) {
  const std::string kind = std::filesystem::path(out).extension().string();
  if (kind != ".png" && kind != ".pfm") throw Error(fmt::format("{}: expected a name in .png or .pfm", out));
  return kind;
}

bool is_grid(const std::string& in) { return std::filesystem::path(in).extension() == ".vdb"; }

// A voxel grid as a fogmap of its columns; prints the medium that shows it, and what it loses.
void convert_columns(const std::string& in, const std::string& out, const ConvertOptions& options) {
  const auto grid = std::make_shared<const scene::VoxelGrid>(scene::read_vdb(in, options.grid));
  const scene::GroundPixels pixels = scene::ground_pixels(grid, options.pixels);
  const scene::ColumnFogmap fog = scene::fogmap_from_columns(grid, pixels, options.samples, options.degree);
  scene::write_grey_image(out, {pixels.width, pixels.height, fog.map.map.coefficients(), ""});
  fmt::print("# columns: relative L2 error {:.2g}, sum {:.6f} of the grid's; density: relative L2 error {:.2g}\n",
             fog.column_error, fog.column_ratio, fog.density_error);
  fmt::print("[[medium]]\ntype = \"fogmap\"\nfile = \"{}\"\ncell = {}\ncorner = [{}, {}]\ndegree = {}\n",
             std::filesystem::path(out).filename().string(), pixels.cell, pixels.x0, pixels.z0, options.degree);
  fmt::print("region = {{ type = \"slab\", lo = {}, hi = {} }}\n", fog.heights.lo, fog.heights.hi);
}

void convert(const std::string& in, const std::string& out, const ConvertOptions& options) {
  const scene::Film film = scene::read_exr(in);
  if (kind_of(out) == ".png") {
    scene::write_png(out, film, options.layer, options.exposure);
    return;
  }
  static_assert(std::endian::native == std::endian::little);
  const std::vector<float>& values = film.layer(options.layer);
  std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", film.width, film.height);
  const std::size_t row = std::size_t(film.width) * 3;
  for (int y = film.height - 1; y >= 0; --y)  // rows from bottom to top
    bytes.append(reinterpret_cast<const char*>(values.data() + row * std::size_t(y)), row * sizeof(float));
  scene::write_file_atomically(out, bytes);
}

}  // namespace

int convert(const ConvertOptions& options) {
  const std::vector<std::string>& files = options.files;
  for (std::size_t i = 0; i < files.size(); i += 2) {
    if (!is_grid(files[i]))
      kind_of(files[i + 1]);
    else if (std::filesystem::path(files[i + 1]).extension() != ".exr")
      throw Error(fmt::format("{}: expected a name in .exr for the map of a grid", files[i + 1]));
  }
  for (std::size_t i = 0; i < files.size(); i += 2)
    if (is_grid(files[i]))
      convert_columns(files[i], files[i + 1], options);
    else
      convert(files[i], files[i + 1], options);
  return 0;
}

}  // namespace airlight::experiments::cli
