#include "experiments/driver/run.h"

#include <fmt/format.h>

#include <exception>
#include <fstream>
#include <map>
#include <optional>

#include "experiments/driver/check.h"
#include "experiments/driver/journal.h"
#include "experiments/driver/oracles.h"
#include "experiments/driver/pictures.h"
#include "experiments/driver/plan.h"
#include "experiments/driver/plots.h"
#include "experiments/driver/reference_cache.h"
#include "experiments/driver/tables.h"
#include "experiments/driver/timing.h"
#include "experiments/folders.h"
#include "experiments/interrupt.h"
#include "experiments/machine.h"
#include "experiments/progress.h"
#include "gpu/context.h"
#include "scene/atomic_file.h"
#include "scene/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

// What is held ready at once, so that the runs of several rows can take turns.
constexpr std::size_t most_held = 16;
constexpr double most_held_gib = 2;

double since(double start) { return steady_seconds() - start; }

bool is_text_of(const fs::path& file, const std::string& text) {
  std::ifstream in(file, std::ios::binary);
  return in && std::string(std::istreambuf_iterator<char>(in), {}) == text;
}

// A row that is prepared and compared, and waits for its timed runs.
struct Held {
  std::size_t place = 0;  // among the scene's rows
  Row row;
  std::unique_ptr<scene::Prepared> prepared;
  double first = 0;  // [s] of the render that made the picture
  StageTimes stages;
};

// What all rows of a scene share.
struct Judged {
  const PlannedScene& planned;
  scene::View view;
  Masks masks;
  std::optional<Reference> reference;
  double exposure = 0;
};

class Run {
 public:
  Run(Experiment experiment, const RunOptions& options)
      : options_(options),
        results_(options.root / "results"),
        journal_(journal_file(options.root, experiment), options.resume) {
    outcome_.experiment = std::move(experiment);
    name_ = results_name(outcome_.experiment.id, outcome_.experiment.profile);
    if (options.resume) return;
    journal_.begin_anew();
    fs::remove_all(results_ / "images" / name_);
  }

  Outcome run() {
    const double start = steady_seconds();
    bool stopped = false;
    std::optional<Error> failure;
    for (const SceneCase& c : outcome_.experiment.scenes) {
      try {
        scene(c);
      } catch (const scene::Interrupted&) {
        stopped = true;
        break;
      } catch (const Error& error) {
        // A scene that cannot be judged takes nothing from the others.
        if (!failure) failure = error;
      }
    }
    outcome_.complete = !stopped && !failure;
    outcome_.seconds = since(start);
    outcome_.gates = judge(outcome_.experiment, outcome_.rows);
    if (!outcome_.rows.empty()) write();
    if (stopped) throw scene::Interrupted("interrupted");
    if (failure) throw Error(*failure);
    return outcome_;
  }

 private:
  const Experiment& experiment() const { return outcome_.experiment; }

  std::size_t row_count() const {
    std::size_t count = 0;
    for (const SceneCase& c : experiment().scenes)
      for (const MethodCase& m : experiment().methods) count += is_on(m, c);
    return count;
  }

  void scene(const SceneCase& c) {
    check_interrupted();
    const PlannedScene planned = plan_scene(experiment(), c);
    const scene::View view = scene::view_of(*planned.scene);
    Judged judged{planned, view, {scene::ball_mask(*planned.scene, view), foreground_of(*planned.scene, view)}, {}, 0};
    if (planned.reference) reference(c, judged);
    std::vector<std::optional<Row>> rows(planned.rows.size());
    std::exception_ptr failure;
    try {
      measure_rows(judged, rows);
    } catch (...) {
      failure = std::current_exception();
    }
    for (std::optional<Row>& row : rows)
      if (row) outcome_.rows.push_back(std::move(*row));
    if (failure) std::rethrow_exception(failure);
  }

  void reference(const SceneCase& c, Judged& judged) {
    const PlannedScene& planned = judged.planned;
    Progress progress(fmt::format("{}: reference of {}", experiment().id, c.name));
    judged.reference = reference_for(results_ / "cache", planned.scene, *planned.reference, *planned.reference_settings,
                                     progress.execution(experiment().timing.threads));
    const Reference& reference = *judged.reference;
    judged.exposure = exposure_of(reference.film, experiment().layer);
    ReferenceInfo info{c.name,
                       reference.key,
                       planned.reference->name(),
                       planned.reference_settings->canonical(),
                       name_ + "/" + file_name(c.name) + "/reference",
                       reference.seconds,
                       reference.cached,
                       judged.exposure,
                       ""};
    keep_picture(results_ / "images", info.image, reference.film, experiment().layer, judged.exposure);
    const auto samples = reference.film.metadata.find("samples");
    if (samples != reference.film.metadata.end()) info.samples = samples->second;
    outcome_.references.push_back(info);
  }

  // Rows that are finished are kept; the others are prepared and compared in groups, and timed in turns.
  void measure_rows(const Judged& judged, std::vector<std::optional<Row>>& rows) {
    std::vector<Held> group;
    double memory = resident_gib();
    std::optional<Error> failure;
    for (std::size_t i = 0; i < rows.size() && !failure; ++i) {
      check_interrupted();
      const PlannedRow& planned = judged.planned.rows[i];
      if (const Row* finished = journal_.find(planned.row.key)) {
        rows[i] = *finished;
        rows[i]->parameter = planned.row.parameter;  // only where it is plotted
        say(*rows[i], "kept");
        continue;
      }
      Row row = planned.row;
      row.exposure = judged.exposure;
      if (!planned.refusal.empty()) {
        row.note = "not supported: " + planned.refusal;
        finish(row, rows[i]);
        continue;
      }
      try {
        group.push_back(hold(i, planned, row, judged));
      } catch (const Unavailable& reason) {
        row.note = std::string("not available on this machine: ") + reason.what();  // the others go on
        row.unavailable = dynamic_cast<const NoDevice*>(&reason) && !gpu::Context::device_was_chosen();
        rows[i] = row;  // not into the journal: the next run may find what is missing
        say(row, "left out");
      } catch (const Error& error) {
        failure = error;
      }
      if (group.size() < most_held && resident_gib() - memory < most_held_gib) continue;
      time_group(group, judged, rows);
      memory = resident_gib();
    }
    time_group(group, judged, rows);
    if (failure) throw Error(*failure);
  }

  // Prepares and renders once; the errors and the picture are those of that render.
  Held hold(std::size_t place, const PlannedRow& planned, const Row& known, const Judged& judged) {
    const MethodCase& m = *planned.method;
    const TimingRule& rule = experiment().timing;
    Held held;
    held.place = place;
    Row& row = held.row = known;
    Progress progress(fmt::format("{} [{} of {}]: {} on {}", experiment().id, outcome_.rows.size() + place + 1,
                                  row_count(), m.name, row.scene));
    const scene::Execution execution = progress.execution(rule.threads);
    std::vector<double> preparations;
    const double allowed = std::min(0.25, rule.budget / 2);
    for (double spent = 0;
         preparations.empty() || (preparations.size() < 5 && spent + preparations.back() < allowed);) {
      const double start = steady_seconds();
      held.prepared = planned.renderer->prepare(judged.planned.scene, planned.settings, execution);
      preparations.push_back(since(start));
      spent += preparations.back();
    }
    row.prepare_seconds = median(preparations);
    for (const scene::Stage& stage : held.prepared->stages())
      if (stage.name == "device") row.device = stage.reason;
    if (!row.device.empty()) held.prepared->render(judged.view, execution);  // drivers compile shaders at first use
    const double start = steady_seconds();
    scene::Rendering rendering = held.prepared->render(judged.view, execution);
    held.first = since(start);
    check_interrupted();  // what a stopped renderer kept is no row
    row.counters = rendering.counters;
    held.stages.add(rendering.times);
    const std::string& layer = experiment().layer;
    if (m.layer != layer) rendering.film.layers[layer] = rendering.film.layer(m.layer);
    if (judged.reference) row.measures = compare(experiment(), m, rendering.film, judged.reference->film, judged.masks);
    row.image = name_ + "/" + file_name(row.scene) + "/" +
                file_name(row.setting.empty() ? row.method : row.method + "_" + row.setting);
    if (!judged.reference) row.exposure = exposure_of(rendering.film, layer);
    keep_picture(results_ / "images", row.image, rendering.film, m.layer, row.exposure);
    return held;
  }

  void time_group(std::vector<Held>& group, const Judged& judged, std::vector<std::optional<Row>>& rows) {
    if (group.empty()) return;
    const TimingRule& rule = experiment().timing;
    const scene::Execution execution = quiet_execution(rule.threads);
    std::vector<TimedJob> jobs;
    for (Held& held : group)
      jobs.push_back({held.first, [&held, &judged, execution] {
                        held.stages.add(held.prepared->render(judged.view, execution).times);
                        check_interrupted();
                      }});
    const std::vector<Timing> timings = time_runs(rule, jobs);
    for (std::size_t i = 0; i < group.size(); ++i) {
      Row& row = group[i].row;
      const Timing& timing = timings[i];
      row.stages = group[i].stages.medians();
      row.seconds = timing.seconds;
      row.coverage = timing.coverage;
      row.mad = timing.mad;
      row.runs = timing.runs;
      row.times = timing.times;
      row.waited = timing.waited;
      row.group = group.front().row.key;
      finish(row, rows[group[i].place]);
    }
    group.clear();
  }

  void finish(const Row& row, std::optional<Row>& place) {
    journal_.add(row);
    made_rows_ = true;
    place = row;
    say(row, "done");
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
    std::map<std::string, std::string> files{{"table.csv", table_csv(outcome_)},
                                             {"summary.csv", summary_csv(outcome_)},
                                             {"table.md", table_markdown(outcome_, plots)}};
    if (experiment().stages) files["stages.csv"] = stages_csv(outcome_);
    if (!experiment().expected.empty()) files["expected.csv"] = expected_csv(outcome_);
    if (!experiment().speed_ups.empty()) files["speed_up.csv"] = speed_up_csv(outcome_);
    bool changed = made_rows_;
    for (const auto& [name, text] : files) {
      if (is_text_of(folder / name, text)) continue;
      scene::write_file_atomically((folder / name).string(), text);
      changed = true;
    }
    // The record tells of the run that made the tables.
    if (changed || !fs::exists(folder / "run.json"))
      scene::write_file_atomically((folder / "run.json").string(), run_record(outcome_, plots));
  }

  RunOptions options_;
  fs::path results_;
  std::string name_;  // of the folder with the results, and of that with the pictures
  Journal journal_;
  Outcome outcome_;
  bool made_rows_ = false;  // not all of them were kept
};

}  // namespace

fs::path journal_file(const fs::path& root, const Experiment& e) {
  return root / "results" / "cache" / "rows" / (e.id + "." + e.profile + ".jsonl");
}

Outcome run_experiment(Experiment experiment, const RunOptions& options) {
  if (options.threads > 0) experiment.timing.threads = options.threads;
  if (!options.checked) check_experiment(experiment, options);
  if (experiment.kind == "oracles") return run_oracles(std::move(experiment), options);
  return Run(std::move(experiment), options).run();
}

}  // namespace airlight::experiments
