#include "experiments/driver/reference_cache.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "experiments/build_info.h"
#include "experiments/driver/content_key.h"
#include "experiments/folders.h"
#include "experiments/say.h"
#include "gpu/shader_source.h"
#include "reference/path_tracer/cache.h"
#include "scene/atomic_file.h"
#include "scene/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

std::string file_bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool load(const fs::path& image, const fs::path& record, Reference& reference) {
  if (!fs::exists(image) || !fs::exists(record)) return false;
  const json j = json::parse(file_bytes(record), nullptr, false);
  if (!j.is_object()) return false;
  const auto checksum = j.find("checksum"), seconds = j.find("seconds");
  if (checksum == j.end() || !checksum->is_string() || seconds == j.end() || !seconds->is_number()) return false;
  if (content_key(std::string_view(file_bytes(image))) != checksum->get<std::string>()) {
    say(fmt::format("{}: checksum differs, computing it anew", image.string()));
    return false;
  }
  reference.film = scene::read_exr(image.string());
  reference.seconds = seconds->get<double>();
  reference.cached = true;
  return true;
}

void trace(const fs::path& folder, std::shared_ptr<const scene::Scene> scene, const scene::Settings& settings,
           const scene::Execution& execution, Reference& reference) {
  const scene::View view = scene::view_of(*scene);
  make_folder(folder);
  path_tracer::CachedRendering traced = path_tracer::render_cached(scene, settings, view, folder.string(), execution);
  for (const std::string& note : traced.notes) say(note);
  if (!traced.complete) throw scene::Interrupted("interrupted");
  reference.film = std::move(traced.film);
  reference.seconds = traced.seconds;
  reference.cached = traced.found >= std::uint64_t(settings.integer("samples"));
}

}  // namespace

std::string reference_key(const scene::Scene& scene, const scene::Renderer& renderer, const scene::Settings& settings) {
  // A method may stand as the reference of its twin on the GPU: it depends on more than the folder `reference`.
  bool below_reference = false;
  for (const char* name : {"deterministic", "path_tracer", "ray_marcher"}) below_reference |= renderer.name() == name;
  const std::string device = renderer.device();
  return content_key({scene.hash, fmt::format("{}x{}", scene.width, scene.height), renderer.name(),
                      settings.canonical(), below_reference ? reference_id() : source_id(), compiler(), device,
                      device.empty() ? "" : gpu::foreign_shaders()});
}

Reference reference_for(const fs::path& cache, std::shared_ptr<const scene::Scene> scene,
                        const scene::Renderer& renderer, const scene::Settings& settings,
                        const scene::Execution& execution) {
  Reference reference;
  reference.key = reference_key(*scene, renderer, settings);
  if (renderer.name() == "path_tracer") {
    trace(cache / "samples", scene, settings, execution, reference);
    return reference;
  }
  const fs::path folder = cache / "references";
  const fs::path image = folder / (reference.key + ".exr"), record = folder / (reference.key + ".json");
  if (load(image, record, reference)) return reference;

  const auto reasons = renderer.supports(*scene, settings);
  if (!reasons.empty())
    throw Error(fmt::format("reference {} cannot render {}: {}", renderer.name(), scene->name, reasons.front()));
  const auto start = std::chrono::steady_clock::now();
  reference.film = renderer.prepare(scene, settings, execution)->render(scene::view_of(*scene), execution).film;
  reference.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // A renderer may keep what it has when it is stopped: that is no reference.
  if (execution.progress && !execution.progress(1)) throw scene::Interrupted("interrupted");

  require_finite(reference.film, fmt::format("{}: reference {}", scene->name, renderer.name()));
  make_folder(folder);
  fs::remove(record);  // never a record beside another image
  scene::write_exr(image.string(), reference.film);
  const json j = {{"scene", scene->name},
                  {"scene_hash", scene->hash},
                  {"renderer", renderer.name()},
                  {"settings", settings.canonical()},
                  {"seconds", reference.seconds},
                  {"commit", commit()},
                  {"checksum", content_key(std::string_view(file_bytes(image)))}};
  scene::write_file_atomically(record.string(), j.dump(1) + "\n");
  return reference;
}

}  // namespace airlight::experiments
