#include "experiments/driver/experiment.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/base/error.h"
#include "scene/base/nearest.h"

namespace airlight::experiments {
namespace fs = std::filesystem;

bool is_on(const MethodCase& m, const SceneCase& c) {
  return m.scenes.empty() || std::any_of(m.scenes.begin(), m.scenes.end(), [&](const std::string& name) {
           return name == c.name || name == c.swept_from;
         });
}

bool judges(const GateCase& gate, const std::string& scene, const std::string& method, const std::string& setting) {
  if (gate.by_row) return scene == gate.scene && method == gate.method && setting == gate.setting;
  return (gate.scene.empty() || scene == gate.scene || scene.rfind(gate.scene + " ", 0) == 0) &&
         (gate.method.empty() || method == gate.method) && (gate.setting.empty() || setting == gate.setting);
}

const ReferenceCase& reference_of(const Experiment& e, const SceneCase& c) {
  return c.reference ? *c.reference : e.reference;
}

std::string results_name(const std::string& id, const std::string& profile) {
  return profile == "quick" ? id : id + "." + profile;
}

std::vector<std::string> experiment_ids(const fs::path& root) {
  std::vector<std::string> ids;
  for (const auto& group : fs::directory_iterator(root / "experiments")) {
    const std::string name = group.path().filename().string();
    if (!group.is_directory() || name == "scenes" || name == "flows" || name == "data") continue;
    for (const auto& file : fs::directory_iterator(group.path()))
      if (file.path().extension() == ".toml") ids.push_back(name + "/" + file.path().stem().string());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<std::string> choose_experiments(const fs::path& root, const std::vector<std::string>& names) {
  auto all = experiment_ids(root);
  if (names.empty()) return all;
  std::vector<std::string> chosen;
  for (const std::string& name : names) {
    const std::size_t before = chosen.size();
    for (const std::string& id : all)
      if (id == name || id.rfind(name + "/", 0) == 0) chosen.push_back(id);
    if (chosen.size() == before)
      throw Error(fmt::format("unknown experiment '{}'{}; airlight experiment list names them", name,
                              scene::nearest_hint(name, all)));
  }
  return chosen;
}

}  // namespace airlight::experiments
