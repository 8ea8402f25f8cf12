#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <filesystem>

#include "experiments/build_info.h"
#include "experiments/cli/commands.h"
#include "experiments/progress.h"
#include "experiments/renderers.h"
#include "scene/error.h"

namespace airlight::experiments::cli {
namespace {

// Better now than after an hour.
void require_folder(const std::string& file) {
  const auto folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw Error(fmt::format("{}: there is no folder {}", file, folder.string()));
}

// "N" or "A..B" as the settings `samples` and `first_sample`.
void put_samples(const std::string& text, Pairs& settings) {
  if (text.empty()) return;
  const std::size_t dots = text.find("..");
  const auto number = [&](const std::string& part) {
    long long value = -1;
    const auto [end, code] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (code != std::errc() || end != part.data() + part.size() || value < 0)
      throw Error(fmt::format("--samples '{}': expected N or A..B, whole numbers >= 0", text));
    return value;
  };
  const long long first = dots == std::string::npos ? 0 : number(text.substr(0, dots));
  const long long end = number(dots == std::string::npos ? text : text.substr(dots + 2));
  if (end <= first) throw Error(fmt::format("--samples '{}': expected a range that is not empty", text));
  settings["samples"] = std::to_string(end - first);
  if (first > 0) settings["first_sample"] = std::to_string(first);
}

}  // namespace

int render(const RenderOptions& options) {
  const scene::Renderer& renderer = find_renderer(options.method, "--method");
  Pairs given = options.settings;
  put_samples(options.samples, given);
  const scene::Settings settings(renderer.settings(), given, options.method);
  require_folder(options.out);
  if (!options.png.empty()) require_folder(options.png);
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(options.scene, options.overrides));
  const auto reasons = renderer.supports(*scene, settings);
  if (!reasons.empty())
    throw Error(fmt::format("{} cannot render {}: {}", options.method, options.scene, reasons.front()));

  Progress progress(fmt::format("{} {}", options.method, scene->name));
  const scene::Execution execution = progress.execution(options.threads);
  const auto start = std::chrono::steady_clock::now();
  const auto prepared = renderer.prepare(scene, settings, execution);
  scene::Rendering rendering = prepared->render(scene::view_of(*scene), execution);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  auto& metadata = rendering.film.metadata;
  metadata["scene"] = scene->name;
  metadata["scene_hash"] = scene->hash;
  metadata["renderer"] = renderer.name();
  metadata["settings"] = settings.canonical();
  metadata["commit"] = commit();
  metadata["seconds"] = fmt::format("{:.3f}", seconds);
  scene::write_exr(options.out, rendering.film);
  if (!options.png.empty()) scene::write_png(options.png, rendering.film, "mean", options.exposure);
  return 0;
}

}  // namespace airlight::experiments::cli
