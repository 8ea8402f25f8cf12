#include "experiments/driver/reference_cache.h"

#include <fmt/format.h>

#include <chrono>

#include "experiments/application/build_info.h"
#include "experiments/application/renderers.h"
#include "experiments/driver/committed_references.h"
#include "gpu/shader_source.h"
#include "scene/base/content_key.h"
#include "scene/base/content_store.h"

namespace airlight::experiments {

std::string reference_key(const scene::Scene& scene, const scene::Renderer& renderer, const scene::Settings& settings,
                          const std::filesystem::path& committed) {
  if (is_committed(committed)) return committed_checksum(committed);
  // A method may stand as the reference of its twin on the GPU: it depends on more than the folder `reference`.
  const std::string device = renderer.device();
  return content_key({scene.hash, fmt::format("{}x{}", scene.width, scene.height), renderer.name(),
                      settings.canonical(), is_reference(renderer) ? reference_id() : source_id(), compiler(), device,
                      device.empty() ? "" : gpu::foreign_shaders()});
}

Reference compute_reference(const std::shared_ptr<const scene::Scene>& scene, const scene::Renderer& renderer,
                            const scene::Settings& settings, const scene::Execution& execution) {
  Reference reference;
  const auto start = std::chrono::steady_clock::now();
  reference.film = renderer.prepare(scene, settings, execution)->render(scene::view_of(*scene), execution).film;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // A renderer may keep what it has when it is stopped: that is no reference.
  if (execution.progress && !execution.progress(1)) throw scene::Interrupted("interrupted");
  require_finite(reference.film, fmt::format("{}: reference {}", scene->name, renderer.name()));
  reference.film.metadata.try_emplace("seconds", fmt::format("{:.3f}", seconds));
  reference.seconds = std::stod(reference.film.metadata.at("seconds"));
  return reference;
}

Reference reference_for(const std::shared_ptr<const scene::Scene>& scene, const scene::Renderer& renderer,
                        const scene::Settings& settings, const scene::Execution& execution,
                        const std::filesystem::path& committed) {
  const std::string key = reference_key(*scene, renderer, settings, committed);
  const std::string name = "references/" + key + ".exr";
  Reference reference;
  if (is_committed(committed)) {
    reference.film = read_committed(committed);
    reference.committed = true;
  } else if (const auto kept = execution.store->find(name)) {
    reference.film = scene::read_exr(kept->string());
    reference.cached = true;
  } else {
    if (!committed.empty())
      execution.store->say(fmt::format(
          "reference of '{}' is not committed ({}): computing it, which may take long; `airlight experiment run "
          "NAME --fresh-references` makes the film",
          scene->name, committed.string()));
    reference = compute_reference(scene, renderer, settings, execution);
    execution.store->keep(name, [&](const auto& path) { scene::write_exr(path.string(), reference.film); });
  }
  reference.key = key;
  reference.seconds = std::stod(reference.film.metadata.at("seconds"));
  return reference;
}

}  // namespace airlight::experiments
