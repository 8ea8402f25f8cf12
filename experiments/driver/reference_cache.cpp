#include "experiments/driver/reference_cache.h"

#include <fmt/format.h>

#include <chrono>

#include "experiments/build_info.h"
#include "experiments/renderers.h"
#include "gpu/shader_source.h"
#include "scene/content_key.h"
#include "scene/content_store.h"

namespace airlight::experiments {

std::string reference_key(const scene::Scene& scene, const scene::Renderer& renderer, const scene::Settings& settings) {
  // A method may stand as the reference of its twin on the GPU: it depends on more than the folder `reference`.
  const std::string device = renderer.device();
  return content_key({scene.hash, fmt::format("{}x{}", scene.width, scene.height), renderer.name(),
                      settings.canonical(), is_reference(renderer) ? reference_id() : source_id(), compiler(), device,
                      device.empty() ? "" : gpu::foreign_shaders()});
}

Reference reference_for(std::shared_ptr<const scene::Scene> scene, const scene::Renderer& renderer,
                        const scene::Settings& settings, const scene::Execution& execution) {
  Reference reference;
  reference.key = reference_key(*scene, renderer, settings);
  const std::string name = "references/" + reference.key + ".exr";
  if (const auto kept = execution.store->find(name)) {
    reference.film = scene::read_exr(kept->string());
    reference.cached = true;
  } else {
    const auto start = std::chrono::steady_clock::now();
    reference.film = renderer.prepare(scene, settings, execution)->render(scene::view_of(*scene), execution).film;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    // A renderer may keep what it has when it is stopped: that is no reference.
    if (execution.progress && !execution.progress(1)) throw scene::Interrupted("interrupted");
    require_finite(reference.film, fmt::format("{}: reference {}", scene->name, renderer.name()));
    reference.film.metadata.try_emplace("seconds", fmt::format("{:.3f}", seconds));
    execution.store->keep(name, [&](const auto& path) { scene::write_exr(path.string(), reference.film); });
  }
  reference.seconds = std::stod(reference.film.metadata.at("seconds"));
  return reference;
}

}  // namespace airlight::experiments
