#include "experiments/driver/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "experiments/build_info.h"
#include "experiments/driver/content_key.h"
#include "experiments/driver/journal.h"
#include "experiments/driver/oracles.h"
#include "experiments/driver/plots.h"
#include "experiments/driver/reference_cache.h"
#include "experiments/driver/tables.h"
#include "experiments/driver/timing.h"
#include "experiments/folders.h"
#include "experiments/interrupt.h"
#include "experiments/progress.h"
#include "experiments/renderers.h"
#include "gpu/context.h"
#include "scene/atomic_file.h"
#include "scene/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string file_name(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' ? c : '_';
  return out;
}

// Powers of two that bring the 99th percentile of the luminance to 0.8.
double exposure_of(const scene::Film& film, const std::string& layer) {
  std::vector<double> y;
  const std::vector<float>& v = film.layer(layer);
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) y.push_back(luminance(Rgb(v[i], v[i + 1], v[i + 2])));
  if (y.empty()) return 0;
  const auto at = y.begin() + std::ptrdiff_t(0.99 * double(y.size() - 1));
  std::nth_element(y.begin(), at, y.end());
  return *at > 0 ? std::log2(0.8 / *at) : 0;
}

// The noise-free foreground: from the media themselves, not from a rendered layer.
std::vector<unsigned char> foreground_of(const scene::Scene& scene) {
  const scene::View view = scene::view_of(scene);
  std::vector<unsigned char> mask(std::size_t(view.width) * std::size_t(view.height), 0);
  scene::parallel_rows(view.height, quiet_execution(0), [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      const Ray ray = scene::camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
      const Rgb t = scene::transmittance(scene.media, ray, {0, scene::ray_end(scene, ray).t});
      mask[std::size_t(y) * std::size_t(view.width) + std::size_t(x)] = (1 - t > 1e-3).any();
    }
  });
  return mask;
}

// Without standard errors and batches an image counts as exact.
scene::Film without_noise_layers(scene::Film film) {
  for (auto it = film.layers.begin(); it != film.layers.end();) {
    const std::string& name = it->first;
    const bool noise = name == "se" || name.ends_with(".se") || name.find("batch.") != std::string::npos;
    it = noise ? film.layers.erase(it) : std::next(it);
  }
  return film;
}

// For looking at.
void keep_picture(const fs::path& images, const std::string& name, const scene::Film& film, const std::string& layer,
                  double exposure) {
  const fs::path file = images / name;
  make_folder(file.parent_path());
  require_finite(film, file.string() + ".exr");  // the noise layers too, which decide on intervals
  scene::write_exr(file.string() + ".exr", without_noise_layers(film));
  scene::write_png(file.string() + ".png", film, layer, exposure);
}

class Run {
 public:
  Run(Experiment experiment, const RunOptions& options)
      : options_(options),
        results_(options.root / "results"),
        journal_(results_ / "cache" / "rows" / (experiment.id + "." + experiment.profile + ".jsonl"), options.resume) {
    outcome_.experiment = std::move(experiment);
    name_ = results_name(outcome_.experiment.id, outcome_.experiment.profile);
    if (!options.resume) fs::remove_all(results_ / "images" / name_);
    if (options.threads > 0) outcome_.experiment.timing.threads = options.threads;
  }

  Outcome run() {
    const auto start = Clock::now();
    bool stopped = false;
    std::optional<Error> failure;
    for (const SceneCase& c : outcome_.experiment.scenes) {
      try {
        scene(c);
      } catch (const scene::Interrupted&) {
        stopped = true;
        break;
      } catch (const Error& error) {
        // A scene that cannot be read or judged takes nothing from the others.
        if (!failure) failure = error;
      }
    }
    outcome_.complete = !stopped && !failure;
    outcome_.seconds = since(start);
    outcome_.gates = judge(outcome_.experiment, outcome_.rows);
    write();
    if (stopped) throw scene::Interrupted("interrupted");
    if (failure) throw Error(*failure);
    return outcome_;
  }

 private:
  const Experiment& experiment() const { return outcome_.experiment; }

  static bool belongs(const SceneCase& c, const MethodCase& m) {
    return m.scenes.empty() || std::find(m.scenes.begin(), m.scenes.end(), c.name) != m.scenes.end();
  }

  std::size_t row_count() const {
    std::size_t count = 0;
    for (const SceneCase& c : experiment().scenes)
      for (const MethodCase& m : experiment().methods) count += belongs(c, m);
    return count;
  }

  void scene(const SceneCase& c) {
    check_interrupted();
    const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(c.file.string(), c.overrides));
    const scene::View view = scene::view_of(*scene);
    const Masks masks{scene::ball_mask(*scene, view), foreground_of(*scene)};
    std::optional<Reference> reference;
    double exposure = 0;
    if (!experiment().reference.renderer.empty()) {
      const scene::Renderer& renderer = find_renderer(experiment().reference.renderer, "reference");
      const scene::Settings settings(renderer.settings(), experiment().reference.settings, "reference");
      Progress progress(fmt::format("{}: reference of {}", experiment().id, c.name));
      reference =
          reference_for(results_ / "cache", scene, renderer, settings, progress.execution(experiment().timing.threads));
      exposure = exposure_of(reference->film, experiment().layer);
      ReferenceInfo info{c.name,
                         reference->key,
                         renderer.name(),
                         settings.canonical(),
                         name_ + "/" + file_name(c.name) + "/reference",
                         reference->seconds,
                         reference->cached,
                         exposure,
                         ""};
      keep_picture(results_ / "images", info.image, reference->film, experiment().layer, exposure);
      const auto samples = reference->film.metadata.find("samples");
      if (samples != reference->film.metadata.end()) info.samples = samples->second;
      outcome_.references.push_back(info);
    }
    for (const MethodCase& m : experiment().methods)
      if (belongs(c, m)) method(c, m, scene, masks, reference, exposure);
  }

  void method(const SceneCase& c, const MethodCase& m, std::shared_ptr<const scene::Scene> scene, const Masks& masks,
              const std::optional<Reference>& reference, double exposure) {
    check_interrupted();
    const scene::Renderer& renderer = find_renderer(m.renderer, m.name);
    const scene::Settings settings(renderer.settings(), m.settings, m.name);
    Row row;
    row.scene = c.name;
    row.method = m.name;
    row.setting = m.setting;
    row.renderer = m.renderer;
    row.settings = settings.canonical();
    row.layer = m.layer;
    row.parameter = c.parameter;
    row.scene_hash = scene->hash;
    row.width = scene->width;
    row.height = scene->height;
    row.exposure = exposure;
    if (reference) row.reference_key = reference->key;
    const TimingRule& rule = experiment().timing;
    std::vector<std::string> parts{
        source_id(),
        scene->hash,
        row.scene,
        row.method,
        row.setting,
        row.renderer,
        row.settings,
        row.layer,
        row.reference_key,
        experiment().layer,
        fmt::format("{} {} {} {}", rule.runs, rule.least_seconds, rule.budget, rule.threads)};
    parts.insert(parts.end(), experiment().metrics.begin(), experiment().metrics.end());
    parts.push_back(fmt::format("{} {}", m.picture_only, m.count_noise));
    parts.push_back(renderer.device());
    row.key = content_key(parts);
    if (const Row* finished = journal_.find(row.key)) {
      outcome_.rows.push_back(*finished);
      say(*finished, "kept");
      return;
    }
    const auto reasons = renderer.supports(*scene, settings);
    if (reasons.empty()) {
      try {
        measure_row(row, m, scene, masks, reference, renderer, settings);
      } catch (const Unavailable& reason) {
        row.note = std::string("not available on this machine: ") + reason.what();  // the others go on
        row.unavailable = dynamic_cast<const NoDevice*>(&reason) && !gpu::Context::device_was_chosen();
        // Not into the journal: the next run may find what is missing.
        outcome_.rows.push_back(row);
        say(row, "left out");
        return;
      }
    } else {
      row.note = "not supported: " + reasons.front();
    }
    journal_.add(row);
    outcome_.rows.push_back(row);
    say(row, "done");
  }

  void measure_row(Row& row, const MethodCase& m, std::shared_ptr<const scene::Scene> scene, const Masks& masks,
                   const std::optional<Reference>& reference, const scene::Renderer& renderer,
                   const scene::Settings& settings) {
    const TimingRule& rule = experiment().timing;
    Progress progress(fmt::format("{} [{} of {}]: {} on {}", experiment().id, outcome_.rows.size() + 1, row_count(),
                                  m.name, row.scene));
    const scene::Execution execution = progress.execution(rule.threads);
    const scene::View view = scene::view_of(*scene);
    std::vector<double> preparations;
    std::unique_ptr<scene::Prepared> prepared;
    const double allowed = std::min(0.25, rule.budget / 2);
    for (double spent = 0;
         preparations.empty() || (preparations.size() < 5 && spent + preparations.back() < allowed);) {
      const auto start = Clock::now();
      prepared = renderer.prepare(scene, settings, execution);
      preparations.push_back(since(start));
      spent += preparations.back();
    }
    row.prepare_seconds = median(preparations);
    for (const scene::Stage& stage : prepared->stages())
      if (stage.name == "device") row.device = stage.reason;
    if (!row.device.empty()) prepared->render(view, execution);  // drivers compile shaders when they are used first
    const auto start = Clock::now();
    scene::Rendering rendering = prepared->render(view, execution);
    const double first = since(start);
    check_interrupted();  // what a stopped renderer kept is no row
    row.counters = rendering.counters;
    const std::string& layer = experiment().layer;
    if (m.layer != layer) rendering.film.layers[layer] = rendering.film.layer(m.layer);
    if (reference && !m.picture_only)
      row.measures = measure(experiment().metrics, rendering.film, reference->film, layer, masks,
                             m.count_noise ? ImageNoise::counted : ImageNoise::removed);
    row.image = name_ + "/" + file_name(row.scene) + "/" +
                file_name(row.setting.empty() ? row.method : row.method + "_" + row.setting);
    if (!reference) row.exposure = exposure_of(rendering.film, layer);
    keep_picture(results_ / "images", row.image, rendering.film, m.layer, row.exposure);
    const scene::Execution timed = quiet_execution(rule.threads);
    StageTimes stages;
    stages.add(rendering.times);
    const Timing timing = time_runs(rule, first, [&] {
      stages.add(prepared->render(view, timed).times);
      check_interrupted();
    });
    row.stages = stages.medians();
    row.seconds = timing.seconds;
    row.coverage = timing.coverage;
    row.mad = timing.mad;
    row.runs = timing.runs;
  }

  void say(const Row& row, const char* how) const {
    if (!options_.talk) return;
    std::string line =
        fmt::format("{}: {} {}{}: ", how, row.scene, row.method, row.setting.empty() ? "" : " " + row.setting);
    if (!row.note.empty()) line += row.note;
    if (!row.measures.empty()) line += fmt::format("{} {}, ", row.measures[0].name, text(row.measures[0]));
    if (row.runs > 0) line += fmt::format("{:.3g} s", row.seconds.value);
    fmt::print("  {}\n", line);
    std::fflush(stdout);
  }

  void write() const {
    const fs::path folder = results_ / name_;
    make_folder(folder);
    const auto plots = draw_plots(outcome_, folder);
    const auto put = [&](const char* name, const std::string& text) {
      scene::write_file_atomically((folder / name).string(), text);
    };
    put("table.csv", table_csv(outcome_));
    put("summary.csv", summary_csv(outcome_));
    if (experiment().stages) put("stages.csv", stages_csv(outcome_));
    if (!experiment().expected.empty()) put("expected.csv", expected_csv(outcome_));
    if (!experiment().speed_ups.empty()) put("speed_up.csv", speed_up_csv(outcome_));
    put("table.md", table_markdown(outcome_, plots));
    put("run.json", run_record(outcome_, plots));
  }

  RunOptions options_;
  fs::path results_;
  std::string name_;  // of the folder with the results, and of that with the pictures
  Journal journal_;
  Outcome outcome_;
};

}  // namespace

Outcome run_experiment(Experiment experiment, const RunOptions& options) {
  if (experiment.kind == "oracles") return run_oracles(std::move(experiment), options);
  return Run(std::move(experiment), options).run();
}

}  // namespace airlight::experiments
