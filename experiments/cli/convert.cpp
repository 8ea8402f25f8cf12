#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/file_ending.h"
#include "scene/convert/fogmap_columns.h"
#include "scene/convert/legendre_projection.h"
#include "scene/film/film.h"
#include "scene/film/grey_image.h"
#include "scene/load/parse_toml.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {
namespace {

struct ConvertOptions {
  std::vector<std::string> files;  // in, out, in, out, ...
  std::string layer = "mean";
  double exposure = 0;
  std::string tone = "clamp";
  std::optional<double>
      depth_scale;               // of a PNG, grey with 16 bits: the layer's first channel, this many metres are white
  std::string grid = "density";  // of an OpenVDB file
  int pixels = 64, samples = 2, degree = 1;
  std::string medium = "0";              // of a scene: its name, or its number
  std::vector<int> coefficients = {12};  // of a Legendre box: along all axes, or x, y, z
  int cells = 24;                        // that its projection integrates over, along an axis
  bool no_lanczos = false, no_limiter = false;
};

std::string kind_of(const std::string& out) {
  std::string kind = scene::file_ending(out);
  if (kind != ".png" && kind != ".pfm") throw Error(fmt::format("{}: expected a name in .png or .pfm", out));
  return kind;
}

bool is_grid(const std::string& in) { return scene::file_ending(in) == ".vdb"; }

// A voxel grid as a fogmap of its columns; prints the medium that shows it, and what it loses.
void convert_columns(const std::string& in, const std::string& out, const ConvertOptions& options) {
  const auto grid = std::make_shared<const scene::VoxelGrid>(scene::read_vdb(in, options.grid));
  const scene::GroundPixels pixels = scene::ground_pixels(grid, options.pixels);
  const scene::ColumnFogmap fog = scene::fogmap_from_columns(grid, pixels, options.samples, options.degree);
  scene::write_grey_image(out, {pixels.width, pixels.height, fog.map.map.coefficients(), ""});
  fmt::print("# columns: relative L2 error {:.2g}, sum {:.6f} of the grid's; density: relative L2 error {:.2g}\n",
             fog.column_error, fog.column_ratio, fog.density_error);
  fmt::print("[[medium]]\ntype = \"fogmap\"\nfile = {}\ncell = {}\ncorner = [{}, {}]\ndegree = {}\n",
             scene::load::toml_string(std::filesystem::path(out).filename().string()), pixels.cell, pixels.x0,
             pixels.z0, options.degree);
  fmt::print("region = {{ type = \"slab\", lo = {}, hi = {} }}\n", fog.heights.lo, fog.heights.hi);
}

bool is_scene(const std::string& in) { return scene::file_ending(in) == ".toml"; }
bool is_table(const std::string& out) { return scene::file_ending(out) == ".csv"; }

// By name, or by number.
const scene::Medium& chosen_medium(const scene::Scene& scene, const std::string& choice) {
  for (const scene::Medium& medium : scene.media)
    if (!medium.name.empty() && medium.name == choice) return medium;
  std::size_t number = 0;
  const auto [stop, code] = std::from_chars(choice.data(), choice.data() + choice.size(), number);
  if (code != std::errc() || stop != choice.data() + choice.size() || number >= scene.media.size())
    throw Error(fmt::format("--medium {}: expected the name of one of {} media, or its number from 0", choice,
                            scene.media.size()));
  return scene.media[number];
}

std::string list(const Vec3& x) { return fmt::format("[{}, {}, {}]", x[0], x[1], x[2]); }

// A medium as a Legendre box; prints a medium of its density, and what that loses.
void convert_projection(const std::string& in, const std::string& out, const ConvertOptions& options) {
  scene::Medium medium;
  if (is_grid(in))
    medium.field = std::make_shared<const scene::VoxelGrid>(scene::read_vdb(in, options.grid));
  else
    medium = chosen_medium(scene::load_scene(in), options.medium);
  const std::vector<int>& n = options.coefficients;
  if (n.size() != 1 && n.size() != 3)
    throw Error(fmt::format("--coefficients: found {} numbers, expected 1 or 3", n.size()));
  scene::ProjectionOptions projection;
  projection.shape = {n.front(), n[n.size() / 2], n.back()};
  projection.lanczos = !options.no_lanczos;
  projection.limiter = !options.no_limiter;
  projection.cells = options.cells;
  const scene::LegendreProjection result = scene::project_to_legendre(medium, projection);
  scene::write_legendre_csv(out, *result.field);
  fmt::print("# relative L2 error {:.2g} ({:.2g} clamped), mass {:.6f} of the medium's, from {:.3g} to {:.3g}\n",
             result.error, result.clamped_error, result.mass_ratio, result.values.lo, result.values.hi);
  fmt::print("# negative in {:.2g} of the box, limiter {:.4f}\n", result.negative_share, result.theta);
  const Box& box = result.field->box();
  fmt::print("[[medium]]\ntype = \"legendre\"\nfile = {}\nsize = [{}, {}, {}]\nlo = {}\nhi = {}\n",
             scene::load::toml_string(std::filesystem::path(out).filename().string()), projection.shape[0],
             projection.shape[1], projection.shape[2], list(box.lo), list(box.hi));
}

void convert(const std::string& in, const std::string& out, const ConvertOptions& options) {
  const scene::Film film = scene::read_exr(in);
  if (kind_of(out) == ".png" && options.depth_scale) {
    scene::GreyImage grey{film.width, film.height, {}, ""};
    const std::vector<float>& depth = film.layer(options.layer);
    for (std::size_t i = 0; i < depth.size(); i += 3) grey.values.push_back(float(depth[i] / *options.depth_scale));
    scene::write_grey_image(out, grey);
    return;
  }
  if (kind_of(out) == ".png") {
    scene::write_png(out, film, options.layer, options.exposure, tone_of(options.tone));
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

int convert(const ConvertOptions& options) {
  const std::vector<std::string>& files = options.files;
  if (const auto& scale = options.depth_scale; scale && !(*scale > 0 && std::isfinite(*scale)))
    throw Error(fmt::format("--depth-scale {}: expected metres above 0", *scale));
  for (std::size_t i = 0; i < files.size(); i += 2) {
    if (is_table(files[i + 1]) && (is_grid(files[i]) || is_scene(files[i]))) continue;
    if (is_scene(files[i])) throw Error(fmt::format("{}: expected a name in .csv for a Legendre box", files[i + 1]));
    if (!is_grid(files[i]))
      kind_of(files[i + 1]);
    else if (scene::file_ending(files[i + 1]) != ".exr")
      throw Error(
          fmt::format("{}: expected a name in .exr for the map of a grid, or .csv for a Legendre box", files[i + 1]));
  }
  for (std::size_t i = 0; i < files.size(); i += 2)
    if (is_table(files[i + 1]))
      convert_projection(files[i], files[i + 1], options);
    else if (is_grid(files[i]))
      convert_columns(files[i], files[i + 1], options);
    else
      convert(files[i], files[i + 1], options);
  return 0;
}

}  // namespace

void add_convert(Commands& commands) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* c =
      add_command(commands.app, "convert", "write a layer of a film as PNG or PFM, or a medium in another form");
  c->add_option(
      "FILES", options->files,
      "IN OUT: OpenEXR file, and .png (8-bit sRGB) or .pfm (linear floats); or OpenVDB file, and .exr: the map of its "
      "columns, whose [[medium]] and errors are printed; or OpenVDB file or scene, and .csv: a medium as a Legendre box, likewise; "
      "more pairs may follow");
  c->add_option("--layer", options->layer, "layer of the film (default mean: the whole picture)");
  c->add_option("--exposure", options->exposure, "exposure of a PNG in powers of two (default 0)");
  add_tone(c, options->tone);
  c->add_option(
      "--depth-scale", options->depth_scale,
      "write a 16-bit grey PNG for the depth of a [backdrop], in which this many metres are white; use with --layer distance");
  c->add_option("--grid", options->grid, "grid of an OpenVDB file (default density)");
  c->add_option("--pixels", options->pixels, "pixels of a fogmap along its longer side (default 64)")
      ->check(CLI::Range(1, 8192));
  c->add_option("--samples", options->samples,
                "vertical rays per pixel of a fogmap: the square of this number (default 2)")
      ->check(CLI::Range(1, 64));
  c->add_option("--degree", options->degree, "degree of a fogmap's splines (default 1)")->check(CLI::Range(0, 3));
  c->add_option("--medium", options->medium, "medium of a scene: its name or number (default 0)");
  c->add_option("--coefficients", options->coefficients,
                "coefficients of a Legendre box along its axes: N, or NX,NY,NZ (default 12)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 32));
  c->add_option("--cells", options->cells,
                "cells along each axis over which the projection onto a Legendre box integrates (default 24)")
      ->check(CLI::Range(1, 48));
  c->add_flag("--no-lanczos", options->no_lanczos, "do not damp the oscillations (Gibbs waves) of a Legendre box");
  c->add_flag("--no-limiter", options->no_limiter,
              "allow negative densities; else a Legendre box is drawn towards its mean until it is positive");
  commands.add_limit(c);
  commands.on(c, [options] {
    require(options->files.empty() ? "" : options->files.front(), "IN");
    require(options->files.size() % 2 == 0 ? options->files.back() : "", "OUT");
    check_exposure(options->exposure);
    tone_of(options->tone);
    return convert(*options);
  });
}

}  // namespace airlight::experiments::cli
