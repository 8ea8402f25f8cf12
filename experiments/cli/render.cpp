#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "experiments/application/build_info.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/progress.h"
#include "experiments/application/renderers.h"
#include "experiments/application/say.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/output.h"
#include "experiments/cli/samples.h"
#include "scene/base/content_store.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

void add_distance(const scene::Scene& scene, scene::Film& film) {
  film.add("distance");
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x) {
      const double t = camera_end(scene, scene::camera_ray(scene.camera, x + 0.5, y + 0.5, film.width, film.height)).t;
      film.set("distance", x, y, Rgb::Constant(t < infinity ? t : 0));
    }
}

// Film with its record, and preview.
void write(const RenderOptions& options, const scene::Renderer& renderer, const scene::Scene& scene,
           const scene::Settings& settings, double seconds, scene::Film& film) {
  auto& metadata = film.metadata;
  metadata["scene"] = scene.name;
  metadata["scene_hash"] = scene.hash;
  metadata["renderer"] = renderer.name();
  metadata["settings"] = settings.canonical();
  metadata["commit"] = commit();
  metadata.try_emplace("seconds", fmt::format("{:.3f}", seconds));
  scene::write_exr(options.out, film);
  if (!options.png.empty()) scene::write_png(options.png, film, "mean", options.exposure);
  if (const auto warning = metadata.find("warning"); warning != metadata.end())
    say(fmt::format("{}: warning: {}", options.scene, warning->second));
}

}  // namespace

int render(const RenderOptions& options) {
  const scene::Renderer& renderer = find_renderer(options.method, "--method");
  const std::optional<SampleRange> range = sample_range(options.samples);
  Pairs given = options.settings;
  if (range) given["samples"] = std::to_string(range->end - range->begin);
  const bool part = range && range->explicit_range;
  if (part && !renderer.monte_carlo())
    throw Error(fmt::format("--samples {}: only path_tracer computes ranges of samples", options.samples));
  if (!options.cache.empty() && (part || !renderer.monte_carlo()))
    throw Error("--cache: only for path_tracer, and without a range of samples");
  const scene::Settings settings(renderer.settings(), given, options.method);
  require_output(options.out, ".exr");
  if (!options.png.empty()) require_output(options.png, ".png");
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(options.scene, options.overrides));

  Progress progress(fmt::format("{} {}", options.method, scene->name));
  std::optional<scene::CannotWrite> not_kept;
  const scene::ContentStore store(options.cache, say, [&](const scene::CannotWrite& error) { not_kept = error; });
  scene::Execution execution = progress.execution(options.threads);
  if (!options.cache.empty()) execution.store = &store;
  const auto start = std::chrono::steady_clock::now();
  scene::Film film;
  if (part) {
    renderer.require_support(*scene, settings);
    film = render_samples(scene, settings, *range, execution, options.out + ".samples");
  } else {
    film = renderer.prepare(scene, settings, execution)->render(scene::view_of(*scene), execution).film;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.distance) add_distance(*scene, film);
  write(options, renderer, *scene, settings, seconds, film);
  if (not_kept) say(fmt::format("warning: {}; {} is written, its samples are not kept", not_kept->what(), options.out));
  check_interrupted();
  return not_kept ? not_kept->exit_code() : 0;
}

}  // namespace airlight::experiments::cli
