#include "experiments/authoring/write_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string_view>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/load/assets.h"
#include "scene/load/parse_toml.h"
#include "scene/load/table_reader.h"
#include "scene/scene.h"

namespace airlight::experiments::authoring {
namespace {

namespace fs = std::filesystem;
using fogshop::authoring::Gaussian;

// Where in the text a position of toml++ lies: lines and columns from 1, columns in characters of UTF-8.
std::size_t offset_of(const std::string& text, const toml::source_position& position) {
  std::size_t at = 0;
  for (std::uint32_t line = 1; line < position.line; ++line) at = text.find('\n', at) + 1;
  for (std::uint32_t column = 1; column < position.column; ++column) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80) ++at;
  }
  return at;
}

// Keys of a scene whose text names a file.
bool names_file(std::string_view key) {
  for (const char* name : {"file", "image", "depth", "gaussians", "residual"})
    if (key == name) return true;
  return false;
}

// The file that a key names. Where the key names a sequence ("name#.vdb"), that of the frame which its table gives.
std::string file_of(const toml::table& table, const std::string& key, const std::string& text) {
  if (text.find('#') == std::string::npos) return text;
  scene::load::TableReader reader(table, "");
  std::vector<std::string> keys{"frame"};
  for (const auto& [name, value] : table) keys.emplace_back(name.str());
  reader.allow(keys);
  return scene::load::name_of_frame(reader, key);
}

// The text with the names of files in `from` made to hold for a scene in `to`. A file that is not beside the scene is
// one of the data folder: its name holds everywhere.
std::string with_moved_assets(std::string text, const fs::path& from, const fs::path& to, const std::string& name) {
  std::vector<std::pair<toml::source_region, std::string>> changes;
  const std::function<void(const toml::node&)> walk = [&](const toml::node& node) {
    if (const auto* list = node.as_array())
      for (const toml::node& item : *list) walk(item);
    const auto* table = node.as_table();
    if (!table) return;
    for (const auto& [key, value] : *table) {
      walk(value);
      const auto* file = value.as_string();
      if (!file || !names_file(key.str()) || fs::path(file->get()).is_absolute()) continue;
      if (fs::exists(from / file_of(*table, std::string(key.str()), file->get())))
        changes.emplace_back(file->source(), fs::proximate(from / file->get(), to).generic_string());
    }
  };
  walk(scene::load::parse_toml(text, name));
  // From the end, so that the positions before stay right.
  std::sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) { return b.first.begin < a.first.begin; });
  for (const auto& [where, path] : changes) {
    const std::size_t begin = offset_of(text, where.begin), end = offset_of(text, where.end);
    text.replace(begin, end - begin, scene::load::toml_string(path));
  }
  return text;
}

std::string camera_text(const fogshop::authoring::View& view) {
  const auto list = [](const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); };
  const scene::Camera& camera = view.camera;
  return fmt::format(
      "[film]\nwidth = {}\nheight = {}\n\n[camera]\nposition = {}\nlook_at = {}\nup = {}\nvertical_fov = {}\n",
      view.width, view.height, list(camera.position), list(camera.position + camera.forward), list(camera.up),
      camera.vertical_fov);
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code none;
  return fs::equivalent(a, b, none) || fs::weakly_canonical(a, none) == fs::weakly_canonical(b, none);
}

}  // namespace

SceneFiles scene_files(const Authored& authored, const std::string& script, const std::string& out) {
  const fs::path folder = fs::absolute(out).parent_path();
  SceneFiles files;
  files.toml = fmt::format("# Made by `airlight author {}`: change that and not this.\n",
                           scene::printable(fs::path(script).filename().string(), 200));
  if (same_file(script, out)) throw Error(fmt::format("{}: is the script, expected another file to write", out));
  if (!authored.base.empty()) {
    if (same_file(authored.base, out))
      throw Error(fmt::format("{}: is the base scene, expected another file to write", out));
    const fs::path from = fs::absolute(authored.base).parent_path();
    std::string text = scene::read_whole_file(authored.base);
    if (!same_file(from.string(), folder.string())) text = with_moved_assets(text, from, folder, authored.base);
    if (text.back() != '\n') text += '\n';
    files.toml += text;
  } else if (authored.view) {
    files.toml += camera_text(*authored.view);
  } else {
    throw Error(fmt::format("{}: found no camera, expected a 'scene' or a 'view' operation", script));
  }

  std::vector<std::pair<Rgb, SceneFiles::Table>> media;
  for (const Gaussian& g : authored.list.all()) {
    if (!g.b.allFinite() || !std::isfinite(1 / g.a) || !(g.a > 0) || !std::isfinite(g.a) || !std::isfinite(g.c))
      throw Error(fmt::format("{}: Gaussian {} leaves the range of numbers: a = {:g}, c = {:g}, b = [{:g}, {:g}, {:g}]",
                              script, g.id, g.a, g.c, g.b[0], g.b[1], g.b[2]));
    auto at = std::find_if(media.begin(), media.end(), [&](const auto& m) { return (m.first == g.color).all(); });
    if (at == media.end()) at = media.insert(media.end(), {g.color, {}});
    // Shortest decimals that give back the same number.
    at->second.csv += fmt::format("{},{},{},{},{}\n", g.b[0], g.b[1], g.b[2], 1 / g.a, g.c);
    ++at->second.gaussians;
  }
  const std::string stem = fs::path(out).stem().string();
  for (std::size_t i = 0; i < media.size(); ++i) {
    auto& [color, table] = media[i];
    table.name = media.size() == 1 ? stem + ".csv" : fmt::format("{}.{}.csv", stem, i + 1);
    table.csv = "center_x,center_y,center_z,width,amplitude\n" + table.csv;
    files.toml += fmt::format("\n[[medium]]\ntype = \"gaussians\"\nname = \"authored{}\"\nfile = {}\n",
                              media.size() == 1 ? "" : fmt::format(" {}", i + 1), scene::load::toml_string(table.name));
    if ((color != 1).any()) files.toml += fmt::format("albedo = [{}, {}, {}]\n", color[0], color[1], color[2]);
    files.tables.push_back(std::move(table));
  }
  try {
    scene::load::parse_toml(files.toml, out);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: media cannot be added at its end ({}), expected [[medium]] tables",
                            authored.base.empty() ? script : authored.base, e.what()));
  }
  return files;
}

void write_checked(const std::string& toml, const std::string& out, const std::vector<std::string>& beside) {
  const fs::path folder = fs::absolute(out).parent_path();
  try {
    scene::parse_scene(toml, out, folder.string());
  } catch (const Error& error) {
    std::error_code ignored;
    for (const std::string& name : beside) fs::remove(folder / name, ignored);
    throw Error(fmt::format("{}: not written, since no command could read it: {}", out, error.what()));
  }
  scene::write_file_atomically(out, toml);
}

void write(const SceneFiles& files, const std::string& out) {
  const fs::path folder = fs::path(out).parent_path();
  std::vector<std::string> names;
  for (const auto& table : files.tables) {
    scene::write_file_atomically((folder / table.name).string(), table.csv);
    names.push_back(table.name);
  }
  write_checked(files.toml, out, names);
}

}  // namespace airlight::experiments::authoring
