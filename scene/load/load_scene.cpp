#include <fmt/format.h>

#include <filesystem>

#include "scene/base/error.h"
#include "scene/load/assets.h"
#include "scene/load/overrides.h"
#include "scene/load/parse_toml.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/scene.h"

namespace airlight::scene {
using namespace load;

Scene parse_scene(const std::string& text, const std::string& name, const std::string& folder,
                  const Overrides& overrides) {
  toml::table root = parse_toml(text, name);
  apply_overrides(root, overrides, name, {"film"});
  TableReader reader(root, "");
  reader.allow({"name", "ambient_in_scatter", "film", "camera", "light", "medium", "surface", "backdrop", "particles"});
  Scene scene;
  scene.name = reader.text("name", std::filesystem::path(name).stem().string());
  scene.ambient_in_scatter = reader.color("ambient_in_scatter", amount, Rgb::Zero());
  if (auto film = reader.table("film")) {
    film->allow({"width", "height"});
    scene.width = int(film->integer("width", 1, 16384, scene.width));
    scene.height = int(film->integer("height", 1, 16384, scene.height));
  }
  scene.camera = read_camera(reader.required_table("camera"));
  for (const TableReader& light : reader.tables("light")) scene.lights.push_back(read_light(light, folder));
  for (TableReader& medium : reader.tables("medium")) {
    scene.media.push_back(read_medium(medium, folder));
    require_resolved(medium, scene, scene.media.back());
  }
  for (const TableReader& surface : reader.tables("surface")) scene.surfaces.push_back(read_surface(surface, folder));
  if (const auto backdrop = reader.table("backdrop"))
    scene.backdrops.push_back(read_backdrop(*backdrop, folder, scene.camera));
  for (const TableReader& particles : reader.tables("particles"))
    scene.backdrops.push_back(read_particles(particles, folder, scene));
  try {
    finish(scene);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: {}", name, e.what()));
  }
  return scene;
}

Scene load_scene(const std::string& path, const Overrides& overrides) {
  return parse_scene(read_whole_file(path, most_toml_bytes), path, std::filesystem::path(path).parent_path().string(),
                     overrides);
}

}  // namespace airlight::scene
