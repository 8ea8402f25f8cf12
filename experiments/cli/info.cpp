#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/scene_option.h"
#include "scene/base/error.h"
#include "scene/base/file_ending.h"
#include "scene/film/color_image.h"
#include "scene/film/film.h"
#include "scene/geometry/mesh_io.h"
#include "scene/media/vdb_layout.h"
#include "scene/media/voxel_grid.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {
namespace {

std::string text(const Vec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]); }

std::string text(const Box& box) {
  return box.empty() ? "no extent" : fmt::format("from {} to {} m", text(box.lo), text(box.hi));
}

template <class Values>
std::string range(const Values& values) {
  if (values.empty()) return "no values";
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  double sum = 0;
  for (const auto v : values) sum += double(v);
  return fmt::format("values from {:.4g} to {:.4g}, mean {:.4g}", *least, *most, sum / double(values.size()));
}

std::string about_grid(const scene::VoxelGrid& grid) {
  const auto filled = std::count_if(grid.values.begin(), grid.values.end(), [](float v) { return v != 0; });
  return fmt::format("    {} x {} x {} voxels of {:.6g} m, {} of them not 0\n    {}\n    {}\n", grid.size[0],
                     grid.size[1], grid.size[2], grid.voxel_size, filled, text(support(grid)), range(grid.values));
}

std::string about_vdb(const std::string& path) {
  std::string out;
  for (const scene::VdbEntry& entry : scene::list_vdb(path)) {
    out += fmt::format("  grid '{}' of type {}\n", entry.name, entry.type);
    if (!entry.type.starts_with("Tree_float_5_4_3")) continue;
    try {
      out += about_grid(scene::read_vdb(path, entry.name));
    } catch (const Error& reason) {  // a temperature below 0, for one
      out += fmt::format("    not a density: {}\n", reason.what());
    }
  }
  return out;
}

std::string about_mesh(const std::string& path) {
  const scene::TriangleMesh mesh = scene::read_mesh(path);
  Box box;
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    area += (b - a).cross(c - a).norm() / 2;
    for (const Vec3& v : {a, b, c}) box = unite(box, {v, v});
  }
  return fmt::format("  {} triangles, {} vertices, area {:.6g} m^2, {} triangles without area dropped\n  {}\n",
                     mesh.triangles.size(), mesh.vertices.size(), area, mesh.removed_degenerate, text(box));
}

std::string about_film(const std::string& path) {
  const scene::Film film = scene::read_exr(path);
  std::string out = fmt::format("  {} x {} pixels\n", film.width, film.height);
  for (const auto& [name, values] : film.layers) out += fmt::format("  layer {}: {}\n", name, range(values));
  for (const auto& [name, value] : film.metadata) out += fmt::format("  {} = {}\n", name, value);
  return out;
}

std::string about_picture(const std::string& path) {
  const scene::ColorImage image = scene::read_color_image(path);
  return fmt::format("  {} x {} pixels, linear {}\n", image.width, image.height, range(image.rgb));
}

std::string about_toml(const std::string& path) {
  return is_flow_file(path) ? describe(scene::load_flow(path)) : describe(scene::load_scene(path));
}

struct Kind {
  std::string ending;
  std::string (*about)(const std::string& path);
};
const std::vector<Kind> kinds{{".toml", about_toml},   {".vdb", about_vdb},     {".obj", about_mesh},
                              {".ply", about_mesh},    {".off", about_mesh},    {".exr", about_film},
                              {".png", about_picture}, {".jpg", about_picture}, {".jpeg", about_picture},
                              {".hdr", about_picture}};

int info(const std::vector<std::string>& files) {
  for (const std::string& path : files) {
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.ending == scene::file_ending(path); });
    if (kind == kinds.end()) {
      std::vector<std::string> endings;
      for (const Kind& k : kinds) endings.push_back(k.ending);
      throw Error(fmt::format("{}: expected a file with one of the endings {}", path, fmt::join(endings, ", ")));
    }
    const std::string about = kind->about(path);
    fmt::print("{}: {} bytes\n{}", path, std::filesystem::file_size(path), about);
  }
  return 0;
}

}  // namespace

void add_info(Commands& commands) {
  const auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* c = add_command(commands.app, "info", "say what a file holds: a scene, a flow, a VDB, a mesh, a picture");
  c->add_option("FILE", *files,
                "files to describe (required): .toml, .vdb, .obj, .ply, .off, .exr, .hdr, .png or .jpg");
  commands.add_limit(c);
  commands.add_data(c);
  commands.on(c, [files] {
    if (files->empty()) throw Error("FILE is missing; see --help");
    return info(*files);
  });
}

}  // namespace airlight::experiments::cli
