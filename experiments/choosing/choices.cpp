#include "experiments/choosing/choices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/application/interrupt.h"
#include "experiments/choosing/ranking.h"
#include "experiments/choosing/variations.h"
#include "experiments/choosing/verdict.h"
#include "experiments/driver/keeper.h"
#include "experiments/driver/plan.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"

namespace airlight::experiments {
namespace {

constexpr const char* all_scenes = "all scenes";
constexpr int judging_stream = 2;  // of the reference's random numbers; the choice has 0, path-traced rows 1
const std::vector<std::string> figure_names{"cases", "hits", "hit_rate", "worst_ratio"};

struct QuestionOptions {
  double budget = 0.016;
  Moving::What moves = Moving::What::camera;
  int variations = 3;
  long long samples = 256;
};

void bind(scene::SettingBinder& b, QuestionOptions& o) {
  b.real("budget", o.budget, 1e-6, 1e6, "time that a frame may take [s]");
  b.choice("moves", o.moves,
           {{"camera", Moving::What::camera}, {"lights", Moving::What::lights}, {"media", Moving::What::media}},
           "what moves from frame to frame");
  b.integer("samples", o.samples, 64, 1e9, "of the reference that judges");
  b.integer("variations", o.variations, 0, 1000, "of each scene, besides the scene as it is");
}

class Question : public scene::Component {
 public:
  std::string name() const override { return "first_choice"; }
  std::string about() const override { return "the first choice within a time"; }
  std::vector<scene::SettingSpec> settings() const override { return scene::list_settings<QuestionOptions>(bind); }
};

const Question& question() {
  static const Question only;
  return only;
}

QuestionOptions options_of(const MethodCase& m) {
  return scene::read_settings<QuestionOptions>(bind, scene::Settings(question().settings(), m.settings, m.name));
}

// A scene, tried as `airlight choose` does and judged.
struct Case {
  std::string name;
  std::shared_ptr<const scene::Scene> scene;
  std::vector<Trial> tried, judged;
  double waited = 0;  // share of the threads' time
};

// A frame of the small film takes longer than all times that are asked about, so that of the whole film does.
bool is_too_slow(const Candidate& c, const std::vector<Trial>& tried, double longest) {
  const auto trial = std::find_if(tried.begin(), tried.end(), [&](const Trial& t) { return t.candidate == &c; });
  return trial != tried.end() && trial->done() &&
         std::all_of(trial->screened.begin(), trial->screened.end(),
                     [&](const FrameTime& time) { return time.at_least && time.seconds.low > longest; });
}

// All questions about a scene share its trials: one run for the longest budget, of all that moves.
class SceneCases {
 public:
  SceneCases(const Experiment& e, std::shared_ptr<const scene::Scene> scene, const std::vector<Candidate>& candidates)
      : scene_(std::move(scene)), candidates_(candidates), threads_(e.timing.threads) {
    for (const MethodCase& m : e.methods) {
      const QuestionOptions o = options_of(m);
      if (std::find(moves_.begin(), moves_.end(), Moves{o.moves}) == moves_.end()) moves_.push_back({o.moves});
      samples_ = std::max(samples_, o.samples);
      longest_.seconds = std::max(longest_.seconds.value_or(0), o.budget);
    }
  }

  // Measures of a question, and the worst miss.
  void answer(const QuestionOptions& o, const scene::Execution& execution, Row& row) {
    const std::size_t move = std::size_t(std::find(moves_.begin(), moves_.end(), Moves{o.moves}) - moves_.begin());
    int hits = 0;
    double worst = 1;
    std::vector<std::string> misses;
    for (int variation = 0; variation <= o.variations; ++variation) {
      const Case& tried = of(variation, double(variation) / (o.variations + 1), execution);
      const Ranking ranking = rank(tried.tried, Goal{o.budget, {}}, move);
      const Trial* chosen = ranking.fit.empty() ? nullptr : ranking.fit.front();
      const Verdict verdict = judge_choice(chosen, tried.judged, o.budget, move);
      hits += verdict.hit;
      worst = std::max(worst, verdict.ratio);
      row.waited = std::max(row.waited, tried.waited);
      if (!verdict.hit) misses.push_back(fmt::format("variation {}: {}", variation, verdict.why));
    }
    row.measures = measures_of(o.variations + 1, hits, worst);
    row.note = fmt::format("{}", fmt::join(misses, "; "));
  }

  static std::vector<Measure> measures_of(double cases, double hits, double worst) {
    return {exactly("cases", cases), exactly("hits", hits), exactly("hit_rate", hits / cases),
            exactly("worst_ratio", worst)};
  }

 private:
  const Case& of(int variation, double share, const scene::Execution& execution) {
    while (int(cases_.size()) <= variation) {
      Case next;
      next.scene = varied(*scene_, int(cases_.size()));
      const auto report = [&](double) {
        if (execution.progress) execution.progress(share);
      };
      TrialSetup setup;
      setup.threads = threads_;
      setup.spend *= double(moves_.size());
      setup.film = std::min(setup.film, next.scene->width / 3);  // some pixels alone, on small films too
      Trials choice(next.scene, setup, moves_, report);
      next.tried = choice.run(candidates_, trace_truth(next.scene, setup, setup.spend / 3, report), longest_);
      setup.film = next.scene->width;
      setup.stream = judging_stream;
      setup.samples = samples_;
      setup.spend = 3600;
      Trials judgement(next.scene, setup, moves_, report);
      next.judged = judgement.run(candidates_, trace_truth(next.scene, setup, setup.spend, report), longest_,
                                  [&](const Candidate& c) { return !is_too_slow(c, next.tried, *longest_.seconds); });
      next.waited = std::max(choice.waited(), judgement.waited());
      keep_lower_times(next.judged, next.tried);
      cases_.push_back(std::move(next));
    }
    return cases_[std::size_t(variation)];
  }

  std::shared_ptr<const scene::Scene> scene_;
  const std::vector<Candidate>& candidates_;
  int threads_;
  long long samples_ = 0;
  std::vector<Moves> moves_;
  Goal longest_;
  std::vector<Case> cases_;
};

double figure_of(const Row& row, const std::string& name) { return quantity(row, name)->value; }

// The row of all scenes, from theirs. Their notes tell of misses.
RowPlan total(const std::vector<Row>& rows) {
  Row row;
  row.scene = all_scenes;
  row.method = "all questions";
  std::vector<std::string> parts;
  double cases = 0, hits = 0, worst = 1;
  for (const Row& each : rows) {
    if (each.measures.empty()) continue;
    cases += figure_of(each, "cases");
    hits += figure_of(each, "hits");
    worst = std::max(worst, figure_of(each, "worst_ratio"));
    parts.push_back(each.key + fmt::format(" {}", figure_of(each, "hits")));
  }
  row.key = content_key(parts);
  return {row, [=](Row known, const scene::Execution&) {
            if (cases > 0) known.measures = SceneCases::measures_of(cases, hits, worst);
            return MadeRow{known, 0, {}};
          }};
}

std::string key_of(const std::vector<Candidate>& candidates) {
  std::vector<std::string> parts;
  for (const Candidate& c : candidates) {
    parts.push_back(c.renderer->name() + " " + c.settings.canonical());
    if (c.convert) parts.push_back(canonical(*c.convert));
  }
  return content_key(parts);
}

}  // namespace

const scene::Component& Choices::find_component(const std::string& name, const std::string& position) const {
  if (name != question().name())
    throw Error(fmt::format("{}: unknown question '{}', expected {}", position, name, question().name()));
  return question();
}

void Choices::check_metrics(Experiment& e, const std::string& position) const {
  for (const std::string& metric : e.metrics)
    if (std::find(figure_names.begin(), figure_names.end(), metric) == figure_names.end())
      throw Error(fmt::format("{}: unknown figure '{}', expected one of {}{}", position, metric,
                              fmt::join(figure_names, ", "), scene::nearest_hint(metric, figure_names)));
  SceneCase total;
  total.name = all_scenes;
  e.scenes.push_back(total);
}

void Choices::check(const Experiment& e, const RunOptions&) const {
  for (const SceneCase& c : e.scenes)
    if (!c.file.empty()) scene::load_scene(c.file.string(), c.overrides);
}

std::string Choices::conditions() const {
  return "hits: cases in which the first choice errs by at most 1.5 times the best that takes no longer, both judged on the "
         "whole film; worst_ratio: the greatest such ratio, as far as the intervals tell.";
}

Outcome Choices::run(Experiment experiment, const RunOptions& options) const {
  const std::vector<Candidate> candidates =
      candidates_of(read_experiment(options.folders, rows_of_all_orders, "quick"));
  RowKeeper keeper(std::move(experiment), options);
  const Experiment& e = keeper.experiment();
  return keeper.run([&](const SceneCase& c) -> std::vector<RowPlan> {
    if (c.file.empty()) return {total(keeper.rows())};
    const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(c.file.string(), c.overrides));
    const auto cases = std::make_shared<SceneCases>(e, scene, candidates);
    std::vector<RowPlan> rows;
    for (const MethodCase& m : e.methods) {
      if (!is_on(m, c)) continue;
      Row row = row_of(c, m, scene::Settings(question().settings(), m.settings, m.name), scene->hash);
      row.reference_key = key_of(candidates);
      set_keys(e, m, question(), row);
      rows.push_back({row, [cases, &m](Row known, const scene::Execution& execution) {
                        cases->answer(options_of(m), execution, known);
                        return MadeRow{std::move(known), 0, {}};
                      }});
    }
    return rows;
  });
}

}  // namespace airlight::experiments
