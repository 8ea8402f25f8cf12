#include "experiments/driver/sequence_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "experiments/application/interrupt.h"
#include "experiments/driver/comparisons.h"
#include "experiments/driver/keeper.h"
#include "experiments/driver/pictures.h"
#include "experiments/driver/plan.h"
#include "experiments/driver/reference_cache.h"
#include "experiments/driver/timing.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

using scene::Film;

const char* flicker = "flicker";
const char* change_counter = "change";

// The value at this share of the way, as TOML text.
std::string value_at(const SequenceCase::Way& way, double share) {
  std::vector<double> at;
  for (std::size_t i = 0; i < way.from.size(); ++i) at.push_back(std::lerp(way.from[i], way.to[i], share));
  return at.size() == 1 ? fmt::format("{}", at[0]) : fmt::format("[{}]", fmt::join(at, ", "));
}

SequenceCase::Way read_way(scene::load::TableReader reader) {
  reader.allow({"path", "from", "to"});
  SequenceCase::Way way{reader.text("path"), reader.numbers("from", scene::load::any_number), {}};
  if (way.from.empty()) reader.expected("from", "a list of one number or more");
  way.to = reader.numbers("to", scene::load::any_number, way.from.size());
  return way;
}

std::shared_ptr<const scene::Scene> picture_scene(const SceneCase& c, int picture) {
  const SequenceCase& frames = *c.frames;
  Pairs overrides = c.overrides;
  if (!frames.key.empty()) overrides[frames.key] = std::to_string(frames.first + picture * frames.step);
  for (const SequenceCase::Way& way : frames.along)
    overrides[way.path] = value_at(way, double(picture) / (frames.count - 1));
  auto scene = std::make_shared<scene::Scene>(scene::load_scene(c.file.string(), overrides));
  turn_lights(*scene, frames.turn * picture);
  for (scene::Light& light : scene->lights) light = scene::moved(light, picture * frames.move);
  finish(*scene);
  return scene;
}

// Data shared by all rows of a sequence.
struct Judged {
  std::vector<PlannedScene> planned;
  std::vector<scene::View> views;
  std::vector<Masks> masks;
  std::vector<Film> truth;
  double exposure = 0;
};

std::vector<unsigned char> joined(const std::vector<Masks>& masks, std::vector<unsigned char> Masks::*of) {
  std::vector<unsigned char> all;
  for (const Masks& m : masks) all.insert(all.end(), (m.*of).begin(), (m.*of).end());
  return all;
}

void judge_by_reference(RowKeeper& keeper, const SceneCase& c, Judged& judged) {
  const Experiment& e = keeper.experiment();
  RunProgress::Step step = keeper.reference_step(c);
  scene::Execution execution = quiet_execution(e.timing.threads);
  execution.store = &keeper.store();
  std::vector<std::string> keys;
  ReferenceInfo info;
  info.cached = true;
  for (const PlannedScene& planned : judged.planned) {
    check_interrupted();
    const Reference one = reference_for(planned.scene, *planned.reference, *planned.reference_settings, execution);
    judged.truth.push_back(one.film);
    keys.push_back(one.key);
    info.seconds += one.seconds;
    info.cached = info.cached && one.cached;
    step.update(double(judged.truth.size()) / double(judged.planned.size()));
  }
  if (info.cached) step.spare();
  judged.exposure = exposure_of(judged.truth.back(), e.layer);
  info.scene = c.name;
  info.key = content_key(keys);
  info.renderer = judged.planned.front().reference->name();
  info.settings = judged.planned.front().reference_settings->canonical();
  info.image = keeper.name() + "/" + file_name(c.name) + "/reference";
  info.exposure = judged.exposure;
  keep_picture(keeper.images(), info.image, judged.truth.back(), e.layer, judged.exposure);
  keeper.add(info);
}

Film black_like(const Film& film, const std::string& layer) {
  Film black(film.width, film.height);
  black.add(layer);
  return black;
}

double size_of(const Film& film, const std::string& layer) {
  return measure({"rmse"}, black_like(film, layer), film, layer, {}, ImageNoise::removed).front().value;
}

std::vector<Measure> compare(const Experiment& e, const Judged& judged, const std::vector<Film>& films) {
  const Film all = stacked(films), truth = stacked(judged.truth);
  const Masks masks{joined(judged.masks, &Masks::left_out), joined(judged.masks, &Masks::foreground)};
  const std::size_t first = std::size_t(films.front().width) * std::size_t(films.front().height);
  std::vector<Measure> measures;
  for (const std::string& metric : e.metrics) {
    if (metric != flicker) {
      measures.push_back(measure({metric}, all, truth, e.layer, masks, ImageNoise::removed).front());
      continue;
    }
    const std::vector<unsigned char> left_out(
        masks.left_out.begin() + std::ptrdiff_t(masks.left_out.empty() ? 0 : first), masks.left_out.end());
    Measure m = measure({"rel_l2"}, changes(films, e.layer), changes(judged.truth, e.layer), e.layer, {left_out, {}},
                        ImageNoise::removed)
                    .front();
    m.name = flicker;
    measures.push_back(m);
  }
  return measures;
}

// [s] A device's frame is complete there: its film's way to the host does not count.
double downloading(const scene::Rendering& rendering) {
  for (const scene::StageTime& stage : rendering.times)
    if (stage.name == download_stage) return stage.seconds;
  return 0;
}

// Renders the pictures in turn, each preparation becoming that of the next picture where it can. Errors, times and counts are of that pass.
MadeRow make_row(const RowKeeper& keeper, const Judged& judged, std::size_t method, Row row,
                 const scene::Execution& execution) {
  const Experiment& e = keeper.experiment();
  const MethodCase& m = *judged.planned.front().rows[method].method;
  std::unique_ptr<scene::Prepared> prepared;
  std::vector<Film> films;
  std::vector<double> seconds;
  row.counters.clear();
  for (std::size_t i = 0; i < judged.planned.size(); ++i) {
    const PlannedRow& planned = judged.planned[i].rows[method];
    if (!planned.refused.empty()) throw scene::NotSupported("", planned.refused);
    const double start = steady_seconds();
    if (!prepared || m.anew || !prepared->next(planned.scene, execution)) {
      prepared = planned.renderer->prepare(planned.scene, planned.settings, execution);
      if (i == 0) row.prepare_seconds = steady_seconds() - start;
      if (i > 0) ++row.counters["prepared anew"];
    }
    scene::Rendering rendering = prepared->render(judged.views[i], execution);
    double took = steady_seconds() - start - downloading(rendering);
    if (const auto found = planned.row.counters.find("conversion_seconds"); found != planned.row.counters.end())
      took += found->second;
    check_interrupted();
    if (i > 0) {
      seconds.push_back(took);
      for (const auto& [name, value] : rendering.counters) row.counters[name] += value;
    }
    if (m.layer != e.layer) rendering.film.layers[e.layer] = rendering.film.layer(m.layer);
    films.push_back(std::move(rendering.film));
  }
  for (auto& [name, value] : row.counters)
    if (name != "prepared anew") value /= double(seconds.size());
  row.device = judged.planned.front().rows[method].renderer->device();
  row.seconds = median_estimate(seconds);
  row.runs = int(seconds.size());
  row.coverage = median_ranks(row.runs).coverage;
  row.times = seconds;
  row.counters["worst frame"] = *std::max_element(seconds.begin(), seconds.end());
  if (!judged.truth.empty()) {
    row.measures = compare(e, judged, films);
    row.counters[change_counter] = change(judged.truth, e.layer);
  }
  row.image = keeper.name() + "/" + file_name(row.scene) + "/" + picture_name(row.method, row.setting);
  row.exposure = judged.truth.empty() ? exposure_of(films.back(), e.layer) : judged.exposure;
  keep_picture(keeper.images(), row.image, films.back(), e.layer, row.exposure);
  return {std::move(row), 0, {}};
}

// The row of the last picture, known by all of them.
Row row_of_sequence(const Judged& judged, std::size_t method) {
  std::vector<std::string> keys, figures_keys, scenes, references;
  for (const PlannedScene& planned : judged.planned) {
    const Row& one = planned.rows[method].row;
    keys.push_back(one.key);
    figures_keys.push_back(one.figures_key);
    scenes.push_back(one.scene_hash);
    references.push_back(one.reference_key);
  }
  Row row = judged.planned.back().rows[method].row;
  row.key = content_key(keys);
  row.figures_key = content_key(figures_keys);
  row.scene_hash = content_key(scenes);
  row.reference_key = content_key(references);
  row.exposure = judged.exposure;
  return row;
}

}  // namespace

Film stacked(const std::vector<Film>& films) {
  Film all(films.front().width, 0);
  for (const Film& film : films) all.height += film.height;
  for (const auto& [name, values] : films.front().layers) {
    std::vector<float> joined;
    for (const Film& film : films) {
      if (!film.has(name)) break;
      const auto& more = film.layer(name);
      joined.insert(joined.end(), more.begin(), more.end());
    }
    if (joined.size() == values.size() * films.size()) all.layers[name] = std::move(joined);
  }
  return all;
}

Film changes(const std::vector<Film>& films, const std::string& layer) {
  if (films.size() < 2) throw Error("changes: one picture has none");
  std::vector<Film> all;
  for (std::size_t i = 1; i < films.size(); ++i) {
    Film film(films[i].width, films[i].height);
    for (const auto& [name, values] : films[i].layers) {
      const bool batch = name.starts_with(layer == "mean" ? "batch." : layer + ".batch.");
      if (name != layer && !batch) continue;
      const std::vector<float>& before = films[i - 1].layer(name);
      std::vector<float>& change = film.add(name);
      for (std::size_t k = 0; k < values.size(); ++k) change[k] = values[k] - before[k];
    }
    all.push_back(std::move(film));
  }
  return stacked(all);
}

double change(const std::vector<Film>& films, const std::string& layer) {
  return size_of(changes(films, layer), layer) / size_of(stacked(films), layer);
}

void SequenceImages::read(const TableReader& top, Experiment& e) const { e.layer = top.text("layer", "mean"); }

void SequenceImages::read_scene(const TableReader& reader, SceneCase& c) const {
  TableReader frames = reader.required_table("frames");
  frames.allow({"count", "key", "first", "step", "turn", "move", "along"});
  c.frames.emplace();
  c.frames->count = int(frames.integer("count", 2, 1000));
  c.frames->key = frames.text("key", "");
  c.frames->first = int(frames.integer("first", 0, 1000000, 0));
  c.frames->step = int(frames.integer("step", 1, 1000, 1));
  c.frames->turn = frames.number("turn", {-10, 10}, 0.0);
  c.frames->move = frames.vector("move", Vec3::Zero());
  for (const TableReader& way : frames.tables("along")) c.frames->along.push_back(read_way(way));
}

void SequenceImages::read_method(const TableReader& reader, const Experiment& e, MethodCase& method) const {
  method.layer = reader.text("layer", e.layer);
  method.anew = reader.flag("anew", false);
}

void SequenceImages::check_metrics(Experiment& e, const std::string& position) const {
  for (const std::string& metric : e.metrics)
    if (metric == "flip" || is_of_converted(metric))
      throw Error(fmt::format("{}: metric '{}' is not known of sequences", position, metric));
    else if (metric != flicker)
      check_metric_name(metric, position);
}

void SequenceImages::check(const Experiment& e, const RunOptions&) const {
  for (const SceneCase& c : e.scenes)
    if (picture_scene(c, 0)->hash == picture_scene(c, c.frames->count - 1)->hash)
      throw Error(fmt::format(
          "{}: nothing changes from picture to picture: expected a key, a way along which values change, or a turn or "
          "a move of a light that can",
          c.position));
}

std::vector<RowColumn> SequenceImages::time_columns() const {
  return {{"time of one picture", time_text},
          {"the slowest", [](const Row& row) { return row.runs ? duration(row.counters.at("worst frame")) : ""; }}};
}

std::vector<RowColumn> SequenceImages::preparation_columns() const {
  return {{"prepared once in", [](const Row& row) { return row.runs ? duration(row.prepare_seconds) : ""; }},
          {"prepared anew", [](const Row& row) {
             const auto found = row.counters.find("prepared anew");
             return row.runs && found != row.counters.end()
                        ? fmt::format("{:.0f} of {} pictures", found->second, row.runs)
                        : "";
           }}};
}

std::string SequenceImages::conditions() const {
  return "Errors of all pictures together. flicker: what the error changes by from picture to picture, over what the true picture changes "
         "by. Times: median and greatest over the pictures after the first, preparation and conversion of media counted.";
}

Outcome SequenceImages::run(Experiment experiment, const RunOptions& options) const {
  RowKeeper keeper(std::move(experiment), options);
  add_histories(keeper, options);
  return keeper.run([&](const SceneCase& c) {
    const auto judged = std::make_shared<Judged>();
    for (int picture = 0; picture < c.frames->count; ++picture) {
      check_interrupted();
      const auto scene = picture_scene(c, picture);
      judged->planned.push_back(plan_scene(keeper.experiment(), c, scene, keeper.store()));
      const scene::View view = scene::view_of(*scene);
      judged->views.push_back(view);
      judged->masks.push_back({scene::ball_mask(*scene, view), foreground_of(*scene, view)});
    }
    if (judged->planned.front().reference) judge_by_reference(keeper, c, *judged);
    std::vector<RowPlan> rows;
    for (std::size_t method = 0; method < judged->planned.front().rows.size(); ++method)
      rows.push_back(
          {row_of_sequence(*judged, method), [&keeper, judged, method](Row known, const scene::Execution& execution) {
             return make_row(keeper, *judged, method, std::move(known), execution);
           }});
    return rows;
  });
}

}  // namespace airlight::experiments
