#include "experiments/serve/scene_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/finish_copy.h"
#include "scene/load/overrides.h"
#include "scene/load/parse_toml.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"

namespace airlight::experiments::serve {
namespace {

using scene::load::TableReader;

const std::map<std::string, std::set<std::string>> changeable{
    {"camera", {"position", "look_at", "up", "vertical_fov", "height"}},
    {"light",
     {"position", "to_light", "axis", "target", "inner_angle", "outer_angle", "intensity", "irradiance", "radiance",
      "scale", "rotation", "radius"}},
    {"medium", {"sigma_t", "albedo", "phase", "frame"}}};

struct ValuePath {
  std::string group, key;
  std::size_t index = 0;
};
std::optional<ValuePath> parsed_path(const std::string& path) {
  const std::size_t first = path.find('.'), last = path.rfind('.');
  if (first == std::string::npos) return std::nullopt;
  ValuePath found{path.substr(0, first), path.substr(last + 1), 0};
  const auto group = changeable.find(found.group);
  if (group == changeable.end() || !group->second.count(found.key)) return std::nullopt;
  if (found.group == "camera") return first == last ? std::optional(found) : std::nullopt;
  const std::string number = first == last ? "" : path.substr(first + 1, last - first - 1);
  if (number.empty() || number.size() > 4 || number.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  found.index = std::stoul(number);
  return found;
}

// Media become homogeneous ones with the same coefficients, environments lose their pictures.
toml::table without_contents(const toml::table& root) {
  toml::table kept;
  for (const char* key : {"camera", "light", "medium"})
    if (const toml::node* node = root.get(key)) node->visit([&](const auto& value) { kept.insert(key, value); });
  const auto each = [&](const char* key, const auto& change) {
    if (toml::array* list = kept[key].as_array())
      for (toml::node& node : *list)
        if (toml::table* table = node.as_table()) change(*table);
  };
  each("medium", [](toml::table& medium) {
    toml::table small;
    for (const char* key : {"name", "sigma_t", "albedo", "phase"})
      if (const toml::node* node = medium.get(key)) node->visit([&](const auto& value) { small.insert(key, value); });
    small.insert("type", "homogeneous");
    medium = std::move(small);
  });
  each("light", [](toml::table& light) {
    light.erase("file");
    light.erase("sh");
  });
  return kept;
}

// As read_environment, for the map or the coefficients that are there.
scene::Light changed_environment(TableReader reader, const scene::EnvironmentLight& before) {
  if (!before.map && before.sh.empty()) return scene::load::read_environment(reader, "");
  reader.allow({"type", "scale", "rotation"});
  const Mat3 to_map = scene::load::read_rotation(reader, "rotation").transpose();
  const Rgb scale = reader.color("scale", scene::load::amount, Rgb::Ones());
  scene::EnvironmentLight after = before;
  after.to_map = to_map;
  if ((scale != before.scale).any())
    after = before.map ? scene::make_map_environment(before.map, to_map, scale, before.source)
                       : scene::make_sh_environment(before.sh, to_map, scale);
  scene::load::require_radiance(reader, after);
  return after;
}

scene::Light changed_light(const TableReader& reader, const scene::Light& before) {
  if (const auto* environment = std::get_if<scene::EnvironmentLight>(&before))
    return changed_environment(reader, *environment);
  return scene::load::read_light(reader, "");
}

void change_medium(const TableReader& reader, const scene::Scene& scene, scene::Medium& medium) {
  const scene::Medium coefficients = scene::load::read_medium(reader, "");
  medium.sigma_t = coefficients.sigma_t;
  medium.albedo = coefficients.albedo;
  medium.phase = coefficients.phase;
  scene::load::require_extinction(reader, medium);
  scene::load::require_resolved(reader, scene, medium);
}

}  // namespace

bool may_change(const std::string& path) { return parsed_path(path).has_value(); }

SceneSource::SceneSource(const std::string& file)
    : file_(file),
      folder_(std::filesystem::path(file).parent_path().string()),
      text_(scene::read_whole_file(file, scene::load::most_toml_bytes)),
      scene_(std::make_shared<const scene::Scene>(scene::parse_scene(text_, file, folder_))),
      whole_(scene::load::parse_toml(text_, file)),
      values_(without_contents(whole_)) {
  TableReader root(values_, "");
  root.allow({"camera", "light", "medium"});
  TableReader camera = root.required_table("camera");
  camera.allow({"type", "position", "look_at", "up", "vertical_fov", "height"});
  look_at_ = camera.vector("look_at");
  up_ = camera.direction("up", Vec3::UnitY());
}

std::shared_ptr<const scene::Scene> SceneSource::with(const scene::Overrides& values) const {
  if (values.empty()) return scene_;
  try {
    return changed(values);
  } catch (const Error& error) {
    // Copied values have forgotten where they stood.
    const std::string line = error.what(), nowhere = "scene:0:0: ";
    throw Error(line.starts_with(nowhere) ? fmt::format("{}: {}", file_, line.substr(nowhere.size())) : line);
  }
}

std::shared_ptr<const scene::Scene> SceneSource::changed(const scene::Overrides& values) const {
  std::set<std::size_t> lights, media, frames;
  scene::Overrides in_place, of_media;
  bool camera = false;
  for (const auto& [path, text] : values) {
    const std::optional<ValuePath> place = parsed_path(path);
    if (!place)
      throw Error(fmt::format("'{}' cannot be changed here, expected a value of camera, light or medium",
                              scene::printable(path, 100)));
    if (place->group == "light") lights.insert(place->index);
    if (place->group == "medium") (place->key == "frame" ? frames : media).insert(place->index);
    if (place->group == "medium") of_media[path] = text;
    if (place->key != "frame") in_place[path] = text;
    camera = camera || place->group == "camera";
  }
  if (camera && !scene_->backdrops.empty())
    throw Error(fmt::format("{}: the camera cannot move: a backdrop or particles are drawn for it alone", file_));
  toml::table root = values_;
  scene::load::apply_overrides(root, in_place, file_);
  TableReader reader(root, "");
  reader.allow({"camera", "light", "medium"});
  auto scene = std::make_shared<scene::Scene>(*scene_);
  if (camera) scene->camera = scene::load::read_camera(reader.required_table("camera"));
  const std::vector<TableReader> light_tables = reader.tables("light"), medium_tables = reader.tables("medium");
  for (const std::size_t i : lights) scene->lights.at(i) = changed_light(light_tables.at(i), scene_->lights.at(i));
  for (const std::size_t i : media) change_medium(medium_tables.at(i), *scene, scene->media.at(i));
  if (!frames.empty()) read_frames(frames, of_media, *scene);
  finish_copy(*scene);
  return scene;
}

// Media that show another frame are read as a whole.
void SceneSource::read_frames(const std::set<std::size_t>& media, const scene::Overrides& values,
                              scene::Scene& scene) const {
  toml::table root = whole_;
  scene::load::apply_overrides(root, values, file_);
  TableReader reader(root, "");
  reader.allow({"name", "ambient_in_scatter", "film", "camera", "light", "medium", "surface", "backdrop", "particles"});
  const std::vector<TableReader> tables = reader.tables("medium");
  for (const std::size_t i : media) {
    scene.media.at(i) = scene::load::read_medium(tables.at(i), folder_);
    scene::load::require_resolved(tables.at(i), scene, scene.media.at(i));
  }
}

std::optional<std::pair<long long, long long>> SceneSource::frames(std::size_t medium) const {
  const toml::node_view<const toml::node> table = whole_["medium"][medium];
  if (!table["frame"].is_integer()) return std::nullopt;
  const auto name =
      table["file"].is_string() ? table["file"].value<std::string>() : table["gaussians"].value<std::string>();
  if (!name) return std::nullopt;
  const std::filesystem::path path = std::filesystem::path(folder_) / *name;
  const std::string file = path.filename().string();
  const std::size_t begin = file.find('#'), end = file.find_last_of('#') + 1;
  if (begin == std::string::npos) return std::nullopt;
  std::optional<std::pair<long long, long long>> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path(), none)) {
    const std::string other = entry.path().filename().string();
    const std::size_t tail = file.size() - end;
    if (other.size() < file.size() || other.size() > file.size() + 9 || !other.starts_with(file.substr(0, begin)) ||
        !other.ends_with(file.substr(end)))
      continue;
    const std::string digits = other.substr(begin, other.size() - begin - tail);
    if (digits.find_first_not_of("0123456789") != std::string::npos || digits.size() > 9) continue;
    const long long frame = std::stoll(digits);
    if (!found) found = {frame, frame};
    found->first = std::min(found->first, frame);
    found->second = std::max(found->second, frame);
  }
  return found;
}

std::string SceneSource::text(const scene::Overrides& values) const {
  with(values);  // throws for what may not be
  toml::table root = scene::load::parse_toml(text_, file_);
  scene::load::apply_overrides(root, values, file_);
  std::ostringstream out;
  out << "# " << scene::printable(file_)
      << " with values changed in `airlight serve`. Keep it in the folder of that file.\n"
      << root << "\n";
  return out.str();
}

}  // namespace airlight::experiments::serve
