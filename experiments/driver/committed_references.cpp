#include "experiments/driver/committed_references.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "experiments/application/build_info.h"
#include "experiments/driver/packed_film.h"
#include "experiments/driver/plan.h"
#include "experiments/driver/reference_cache.h"
#include "scene/base/content_key.h"
#include "scene/base/content_store.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;

fs::path committed_file(const fs::path& folder, const scene::Scene& scene, const scene::Renderer& renderer,
                        const scene::Settings& settings, const std::string& layer) {
  const std::string key = content_key(
      {scene.hash, fmt::format("{}x{}", scene.width, scene.height), renderer.name(), settings.canonical(), layer});
  return folder / (key + ".exr");
}

std::vector<CommittedReference> committed_references(const std::vector<Experiment>& experiments) {
  std::vector<CommittedReference> all;
  for (const Experiment& e : experiments) {
    if (e.reference.committed.empty()) continue;
    for (const SceneCase& c : e.scenes) {
      const PlannedScene planned = plan_reference(e, c);
      const auto same = [&](const CommittedReference& r) { return r.file == planned.committed; };
      if (std::any_of(all.begin(), all.end(), same)) continue;
      all.push_back({fmt::format("{}, scene '{}'", e.id, c.name), planned.scene, planned.reference,
                     *planned.reference_settings, e.layer, planned.committed});
    }
  }
  return all;
}

bool is_committed(const fs::path& file) { return !file.empty() && fs::exists(file); }

std::string committed_checksum(const fs::path& file) {
  const fs::path beside = fs::path(file) += ".xxh128";
  std::string sum;
  if (fs::is_regular_file(beside)) {
    std::ifstream in(beside, std::ios::binary);
    sum.assign(std::istreambuf_iterator<char>(in), {});
  }
  if (sum.empty())
    throw Error(
        fmt::format("{0}: committed reference without its checksum {0}.xxh128; `git checkout -- {0}.xxh128` gets it "
                    "back, `airlight experiment run NAME --fresh-references` makes both again",
                    file.string()));
  return sum.substr(0, sum.find(' '));  // the film's name follows
}

scene::Film read_committed(const fs::path& file) {
  committed_checksum(file);
  if (!scene::ContentStore(file.parent_path()).find(file.filename().string()))
    throw Error(
        fmt::format("{0}: damaged committed reference: its content does not match {0}.xxh128; `git checkout -- "
                    "{0}` gets it back, `airlight experiment run NAME --fresh-references` makes it again",
                    file.string()));
  return read_packed(file.string());
}

double make_committed(const CommittedReference& r, const scene::Execution& execution) {
  scene::Execution without_cache = execution;
  without_cache.store = nullptr;
  const Reference reference = compute_reference(r.scene, *r.renderer, r.settings, without_cache);
  scene::Film film = reference.film;
  film.metadata["scene"] = r.scene->name;
  film.metadata["scene_hash"] = r.scene->hash;
  film.metadata["renderer"] = r.renderer->name();
  film.metadata["settings"] = r.settings.canonical();
  film.metadata["program"] = fmt::format("airlight {} ({})", version(), commit());
  scene::ContentStore(r.file.parent_path()).keep(r.file.filename().string(), [&](const fs::path& path) {
    write_packed(path.string(), film, r.layer);
  });
  return reference.seconds;
}

}  // namespace airlight::experiments
