#include "experiments/driver/images.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/application/interrupt.h"
#include "experiments/application/renderers.h"
#include "experiments/driver/committed_references.h"
#include "experiments/driver/comparisons.h"
#include "experiments/driver/keeper.h"
#include "experiments/driver/left_out.h"
#include "experiments/driver/next_frames.h"
#include "experiments/driver/pictures.h"
#include "experiments/driver/plan.h"
#include "experiments/driver/reference_cache.h"
#include "experiments/driver/sequences.h"
#include "experiments/driver/timing.h"
#include "experiments/driver/trial.h"
#include "experiments/judging/metrics.h"

namespace airlight::experiments {
namespace {

// Data shared by all rows of a scene.
struct Judged {
  PlannedScene planned;
  scene::View view;
  Masks masks;
  std::optional<Reference> reference;
  double exposure = 0;
};

void judge_by_reference(RowKeeper& keeper, const SceneCase& c, Judged& judged) {
  const Experiment& e = keeper.experiment();
  const PlannedScene& planned = judged.planned;
  RunProgress::Step step = keeper.reference_step(c);
  scene::Execution execution = step.execution(e.timing.threads);
  execution.store = &keeper.store();
  judged.reference =
      reference_for(planned.scene, *planned.reference, *planned.reference_settings, execution, planned.committed);
  const Reference& reference = *judged.reference;
  if (reference.cached) step.spare();
  judged.exposure = exposure_of(reference.film, e.layer);
  ReferenceInfo info{c.name,
                     reference.key,
                     planned.reference->name(),
                     planned.reference_settings->canonical(),
                     keeper.name() + "/" + file_name(c.name) + "/reference",
                     reference.seconds,
                     reference.cached,
                     judged.exposure,
                     ""};
  keep_picture(keeper.images(), info.image, reference.film, e.layer, judged.exposure);
  const auto& metadata = reference.film.metadata;
  if (const auto samples = metadata.find("samples"); samples != metadata.end()) info.samples = samples->second;
  if (reference.committed) {
    info.committed = fmt::format("{}/{}", committed_folder, planned.committed.filename().string());
    info.program = metadata.at("program");
    info.kept = metadata.at("kept");
  }
  keeper.add(info);
}

// The median of several preparations where they are short.
std::shared_ptr<scene::Prepared> prepare(const Experiment& e, const PlannedRow& planned,
                                         const scene::Execution& execution, double& seconds) {
  std::shared_ptr<scene::Prepared> prepared;
  std::vector<double> preparations;
  const double allowed = std::min(0.25, e.timing.budget / 2);
  for (double spent = 0; preparations.empty() || (preparations.size() < 5 && spent + preparations.back() < allowed);) {
    const double start = steady_seconds();
    prepared = planned.renderer->prepare(planned.scene, planned.settings, execution);
    preparations.push_back(steady_seconds() - start);
    spent += preparations.back();
  }
  seconds = median(preparations);
  return prepared;
}

// The film of the converted media; the reference's own where nothing is converted, or nobody asks.
Reference truth_of_converted(const RowKeeper& keeper, const Judged& judged, const PlannedRow& planned) {
  const std::vector<std::string>& metrics = keeper.experiment().metrics;
  if (planned.scene == judged.planned.scene || std::none_of(metrics.begin(), metrics.end(), is_of_converted))
    return *judged.reference;
  scene::Execution execution = quiet_execution(keeper.experiment().timing.threads);
  execution.store = &keeper.store();
  return reference_for(planned.scene, *judged.planned.reference, *judged.planned.reference_settings, execution);
}

// A device's frame is complete there: what is timed reads nothing back.
scene::Execution as_timed(scene::Execution execution, const Row& row) {
  if (!row.device.empty()) execution.layers.emplace();
  return execution;
}

// [s] The stage "download" of renders that read everything back: of the first, or the median of more where they are short.
std::optional<double> download_seconds(const TimingRule& rule, const scene::Rendering& first, double seconds,
                                       const std::function<scene::Rendering()>& again) {
  const auto of = [](const scene::Rendering& rendering) {
    for (const scene::StageTime& stage : rendering.times)
      if (stage.name == download_stage) return std::optional(stage.seconds);
    return std::optional<double>();
  };
  std::vector<double> found;
  const double allowed = std::min(0.25, rule.budget / 4);
  for (double spent = seconds; of(first) && found.size() < 5 && spent < allowed; spent += seconds)
    found.push_back(*of(again()));
  return found.empty() ? of(first) : median(found);
}

// Prepares and renders once; the errors and the picture are those of that render.
MadeRow make_row(const RowKeeper& keeper, std::shared_ptr<const Judged> judged, const PlannedRow& planned, Row row,
                 const scene::Execution& execution) {
  const Experiment& e = keeper.experiment();
  const MethodCase& m = *planned.method;
  if (!planned.refused.empty()) throw scene::NotSupported("", planned.refused);
  const std::shared_ptr<scene::Prepared> prepared = prepare(e, planned, execution, row.prepare_seconds);
  row.device = planned.renderer->device();
  if (e.left_out) row.left_out = left_out(prepared->stages());
  const scene::Execution timed = as_timed(execution, row);
  if (!row.device.empty()) prepared->render(judged->view, timed);  // drivers compile shaders at first use
  const auto moving = m.moving ? std::make_shared<NextFrames>(prepared, planned.scene, *m.moving) : nullptr;
  double first = 0;
  const auto render = [&](const scene::Execution& how) {
    const double start = steady_seconds();
    scene::Rendering rendering = moving ? moving->render(judged->view, how) : prepared->render(judged->view, how);
    first = (steady_seconds() - start) / (moving ? m.moving->frames : 1);
    check_interrupted();
    return rendering;
  };
  scene::Rendering rendering = render(execution);
  row.counters.insert(rendering.counters.begin(), rendering.counters.end());
  std::vector<scene::StageTime> stages = rendering.times;
  std::optional<double> download;
  if (!row.device.empty()) {
    download = download_seconds(e.timing, rendering, first, [&] { return render(execution); });
    const scene::Rendering frame = render(timed);
    stages = frame.times;
    for (const auto& [name, value] : frame.counters) row.counters[name] = value;
  }
  for (const Moving::What what : e.moves)
    if (e.timing.budget > 0) {
      auto after = frame_after(what, *planned.renderer, planned.settings, planned.scene, judged->view, timed,
                               e.timing.budget / 2);
      if (!after) continue;
      // Media that moved are converted again.
      if (what == Moving::What::media && row.counters.contains("conversion_seconds"))
        after->seconds += row.counters.at("conversion_seconds");
      row.moved[name_of(what)] = *after;
      check_interrupted();
    }
  if (m.layer != e.layer) rendering.film.layers[e.layer] = rendering.film.layer(m.layer);
  if (judged->reference)
    row.measures = compare(e, m, rendering.film, judged->reference->film,
                           truth_of_converted(keeper, *judged, planned).film, judged->masks);
  row.image = keeper.name() + "/" + file_name(row.scene) + "/" + picture_name(row.method, row.setting);
  row.exposure = judged->reference ? judged->exposure : exposure_of(rendering.film, e.layer);
  keep_picture(keeper.images(), row.image, rendering.film, m.layer, row.exposure);
  return {row, first, stages, download, [prepared, moving, judged, row](const scene::Execution& execution) {
            const scene::Execution timed = as_timed(execution, row);
            return moving ? moving->again(judged->view, timed) : prepared->render(judged->view, timed).times;
          }};
}

// A column of a counter that only some rows have.
RowColumn counter(const std::string& head, const std::string& name, std::function<std::string(double)> as_text) {
  return {head, [name, as_text = std::move(as_text)](const Row& row) {
            const auto found = row.counters.find(name);
            return found == row.counters.end() ? "" : as_text(found->second);
          }};
}

// A column of the frame after something moved.
RowColumn after(const std::string& what, const std::string& head) {
  return {head, [what](const Row& row) {
            const auto found = row.moved.find(what);
            if (found == row.moved.end()) return std::string();
            return duration(found->second.seconds) + (found->second.anew ? ", anew" : "");
          }};
}

}  // namespace

const scene::Component& Images::find_component(const std::string& name, const std::string& position) const {
  return find_renderer(name, position);
}

void Images::read(const TableReader& top, Experiment& e) const {
  e.layer = top.text("layer", "mean");
  e.stages = top.flag("stages", false);
  e.left_out = top.flag("left_out", false);
  if (top.flag("moves", false)) e.moves = {Moving::What::camera, Moving::What::lights, Moving::What::media};
}

void Images::read_method(const TableReader& reader, const Experiment& e, MethodCase& method) const {
  method.layer = reader.text("layer", e.layer);
  method.picture_only = reader.flag("picture_only", false);
  method.count_noise = reader.flag("count_noise", false);
}

void Images::check_metrics(Experiment& e, const std::string& position) const {
  for (const std::string& metric : e.metrics) check_metric_name(metric, position);
  std::vector<std::string>& metrics = e.metrics;
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const std::string relative = "rel_l2";
    std::string rms = metrics[i];
    const std::size_t at = rms.find(relative);
    if (at == std::string::npos || rms.find("squared") != std::string::npos) continue;
    rms.replace(at, relative.size(), "rmse");
    if (std::find(metrics.begin(), metrics.end(), rms) == metrics.end())
      metrics.insert(metrics.begin() + std::ptrdiff_t(i) + 1, rms);
  }
}

void Images::check(const Experiment& e, const RunOptions& options) const { try_pictures(e, options); }

std::vector<std::string> Images::times() const {
  std::vector<std::string> names = ExperimentKind::times();
  names.insert(names.end(), {"camera_seconds", "lights_seconds", "media_seconds"});
  return names;
}

std::vector<RowColumn> Images::time_columns() const { return {{"time of one render", time_text}}; }

std::vector<RowColumn> Images::preparation_columns() const {
  return {{"prepared once in", [](const Row& row) { return row.runs ? duration(row.prepare_seconds) : ""; }},
          after("camera", "camera moves"),
          after("lights", "lights move"),
          after("media", "media move"),
          counter("converted in", "conversion_seconds", duration),
          counter("numbers of the density", "numbers", [](double n) { return fmt::format("{:.0f}", n); }),
          counter("density error", "density_error", [](double e) { return fmt::format("{:.3g}", e); })};
}

std::string Images::conditions() const {
  return "Errors with [95 % interval] where the reference is noisy; times: median [ranks] of one render's wall clock, "
         "precomputation apart.";
}

void add_histories(RowKeeper& keeper, const RunOptions& options) {
  for (const std::string& name : keeper.experiment().sequences) {
    Row history;
    history.method = name;
    history.columns = sequence_history(options.folders, name, keeper.experiment().profile);
    keeper.add_history(std::move(history));
  }
}

Outcome Images::run(Experiment experiment, const RunOptions& options) const {
  RowKeeper keeper(std::move(experiment), options);
  add_histories(keeper, options);
  return keeper.run([&](const SceneCase& c) {
    const auto judged = std::make_shared<Judged>();
    judged->planned = plan_scene(keeper.experiment(), c, keeper.store());
    const scene::Scene& scene = *judged->planned.scene;
    judged->view = scene::view_of(scene);
    judged->masks = {scene::ball_mask(scene, judged->view), foreground_of(scene, judged->view)};
    if (judged->planned.reference) judge_by_reference(keeper, c, *judged);
    std::vector<RowPlan> rows;
    for (const PlannedRow& planned : judged->planned.rows) {
      Row row = planned.row;
      row.exposure = judged->exposure;
      rows.push_back({row, [&keeper, judged, &planned](Row known, const scene::Execution& execution) {
                        return make_row(keeper, judged, planned, std::move(known), execution);
                      }});
    }
    return rows;
  });
}

}  // namespace airlight::experiments
