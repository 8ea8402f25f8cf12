#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <chrono>
#include <optional>

#include "experiments/application/build_info.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/progress.h"
#include "experiments/application/renderers.h"
#include "experiments/application/say.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/output.h"
#include "experiments/cli/samples.h"
#include "experiments/cli/scene_option.h"
#include "experiments/cli/viewer.h"
#include "scene/base/content_store.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

struct RenderOptions {
  SceneOptions scene;
  std::string method, out, png, samples, cache, display;
  Pairs settings;
  int threads = 0;
  double exposure = 0;
  std::string tone = "clamp";
  bool distance = false;  // a layer `distance` too
};

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
  if (!options.scene.convert.empty()) metadata["converted"] = options.scene.convert;
  metadata["commit"] = commit();
  metadata.try_emplace("seconds", fmt::format("{:.3f}", seconds));
  scene::write_exr(options.out, film);
  if (!options.png.empty()) scene::write_png(options.png, film, "mean", options.exposure, tone_of(options.tone));
  if (const auto warning = metadata.find("warning"); warning != metadata.end())
    say(fmt::format("{}: warning: {}", options.scene.file, warning->second));
}

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
  const auto scene = load(options.scene, options.threads);
  std::optional<Viewer> viewer;
  if (!options.display.empty()) viewer.emplace(options.display);
  const auto show = [&](const scene::Film& film) { viewer->show(film, options.out); };

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
  } else if (viewer && renderer.monte_carlo() && options.cache.empty()) {
    renderer.require_support(*scene, settings);
    film = render_in_passes(scene, settings, execution, show);
  } else {
    film = renderer.prepare(scene, settings, execution)->render(scene::view_of(*scene), execution).film;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (viewer) show(film);
  if (options.distance) add_distance(*scene, film);
  write(options, renderer, *scene, settings, seconds, film);
  if (not_kept) say(fmt::format("warning: {}; {} is written, its samples are not kept", not_kept->what(), options.out));
  if (viewer && viewer->lost()) say(fmt::format("warning: the viewer at {} went away", options.display));
  check_interrupted();
  if (not_kept) return not_kept->exit_code();
  if (isatty(STDERR_FILENO)) {  // scripts read warnings alone
    const std::string files = options.out + (options.png.empty() ? "" : ", " + options.png);
    say(fmt::format("{}: {}, {} x {} pixels, {:.3g} s", files, renderer.name(), film.width, film.height, seconds));
  }
  return 0;
}

}  // namespace

void add_render(Commands& commands) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* c = add_command(commands.app, "render", "render a scene with a method or a reference");
  add_scene_options(c, options->scene, "scene file (required; its format is documented in scene/README.md)");
  c->add_option("--method,-m", options->method,
                fmt::format("method or reference that renders (required): {}", fmt::join(renderer_names(), ", ")));
  c->add_option("--out,-o", options->out, "OpenEXR file to write (required)");
  c->add_option("--png", options->png, "also write this 8-bit PNG preview");
  c->add_option("--exposure", options->exposure, "exposure of the preview in powers of two (default 0)");
  add_tone(c, options->tone);
  c->add_flag(
      "--distance", options->distance,
      "also write a layer `distance`: metres along the ray of each pixel's centre to the first surface, 0 without one");
  c->add_option("--threads", options->threads, "number of threads (default 0: all)")->check(CLI::Range(0, 4096));
  c->add_option("--samples", options->samples,
                "samples per pixel N, or a range A..B that `airlight merge` joins with others (path_tracer only)");
  c->add_option(
      "--display", options->display,
      "HOST:PORT of a viewer that speaks tev's protocol (tev listens on 127.0.0.1:14158): show the picture there; "
      "path_tracer shows it again whenever it has twice as many samples");
  c->add_option("--cache", options->cache,
                "folder that keeps samples, so that a stopped render continues (path_tracer only)");
  add_pairs(c, "--set", options->settings,
            "change a setting of the method (`airlight explain SCENE -m METHOD` lists them)");
  commands.add_limit(c);
  commands.add_data(c);
  commands.add_gpu(c);
  commands.add_unchecked(c);
  commands.on(c, [options] {
    require(options->scene.file, "SCENE");
    require(options->method, "--method");
    require(options->out, "--out");
    check_exposure(options->exposure);
    tone_of(options->tone);
    return render(*options);
  });
}

}  // namespace airlight::experiments::cli
