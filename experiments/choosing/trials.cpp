#include "experiments/choosing/trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/application/build_info.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/machine.h"
#include "experiments/application/renderers.h"
#include "experiments/driver/left_out.h"
#include "experiments/driver/timing.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

using SharedScene = std::shared_ptr<const scene::Scene>;

constexpr double most_of_rest = 1.0 / 6;  // of the time that is left: for one candidate
constexpr double screening = 0.7;         // of the time to spend: the rest is for the scene's own film
constexpr double cheap = 1.0 / 60;        // of the time to spend: costs less on the scene's own film, at once
constexpr double near = 0.8;  // a time and the budget are near each other if the lesser is this share of the greater
constexpr std::size_t least_frames = 3, most_frames = 5;  // timed, of each candidate on each film
constexpr double hopeless = 4, hopeless_error = 2;        // times what is allowed: frames are not timed any more

// A device's frame is complete there: what is timed reads nothing back.
scene::Execution timed_on(const scene::Renderer& renderer, scene::Execution execution) {
  if (!renderer.device().empty()) execution.layers.emplace();
  return execution;
}

Estimate plus(const Estimate& e, double seconds) { return {e.value + seconds, e.low + seconds, e.high + seconds}; }

double pixels_of(const scene::View& view) { return double(view.width) * view.height; }

// Half as wide and high.
scene::View smaller_view(scene::View view) {
  view.width = std::max(1, view.width / 2);
  view.height = std::max(1, view.height / 2);
  return view;
}

bool is_hopeless(double seconds, const Goal& goal) { return goal.seconds && seconds > hopeless * *goal.seconds; }

bool converts(const Moves& moves) {
  return moves.empty() || std::find(moves.begin(), moves.end(), Moving::What::media) != moves.end();
}

}  // namespace

Estimate extrapolated(const Estimate& small, double small_pixels, const Estimate& smaller, double smaller_pixels,
                      double pixels) {
  const auto line = [&](double at_small, double at_smaller) {
    const double slope = small_pixels > smaller_pixels ? (at_small - at_smaller) / (small_pixels - smaller_pixels) : 0;
    return std::clamp(at_small + slope * (pixels - small_pixels), at_small, at_small * pixels / small_pixels);
  };
  return {line(small.value, smaller.value), line(small.low, smaller.high), line(small.high, smaller.low)};
}

struct Trials::Pass {
  scene::Film film;
  std::vector<scene::Stage> stages;
  double prepare = 0, render = 0;  // [s]
  std::optional<FramesAfter> after;
};

Trials::Trials(SharedScene scene, TrialSetup setup, std::vector<Moves> moves, Report report)
    : scene_(std::move(scene)),
      setup_(setup),
      moves_(std::move(moves)),
      report_(std::move(report)),
      start_(steady_seconds()),
      end_(start_ + setup.spend),
      deadline_(end_) {
  for (const Moves& all : moves_)
    for (const Moving::What what : all)
      if (!moved_back(*scene_, Moving{what}))
        throw Error(fmt::format("{}: the scene has no {} that could move", scene_->name, name_of(what)));
}

double Trials::left() const { return end_ - steady_seconds(); }

scene::Execution Trials::execution() const {
  return {setup_.threads, [this](double) {
            report_(done_);
            return !interrupted() && steady_seconds() < deadline_;
          }};
}

const Trials::Converted& Trials::scene_for(const Candidate& c) {
  const auto [found, is_new] = converted_.try_emplace(c.convert ? canonical(*c.convert) : "");
  Converted& made = found->second;
  if (!is_new) return made;
  if (!c.convert) {
    made.scene = scene_;
    return made;
  }
  try {
    const auto all =
        std::make_shared<const scene::ConvertedScene>(convert_media(*scene_, *c.convert, execution(), reference_id()));
    made.scene = {all, &all->scene};
    for (const scene::ConvertedMedium& medium : all->media) {
      made.seconds += medium.seconds;
      made.density_error = std::max(made.density_error, medium.density_error);
    }
  } catch (const scene::Interrupted&) {
    converted_.erase(found);
    throw;
  } catch (const scene::NotSupported& objection) {
    made.refused = objection.reason;
  } catch (const Error& error) {
    made.refused = error.what();
  }
  return made;
}

Trials::Pass Trials::pass(const Candidate& c, const Converted& converted, const scene::View& view) const {
  Pass pass;
  const scene::Execution how = execution();
  double start = steady_seconds();
  std::unique_ptr<scene::Prepared> prepared = c.renderer->prepare(converted.scene, c.settings, how);
  pass.prepare = steady_seconds() - start;
  // Drivers compile shaders at first use.
  if (!c.renderer->device().empty()) prepared->render(view, how);
  start = steady_seconds();
  pass.film = prepared->render(view, how).film;
  pass.render = steady_seconds() - start;
  if (!how.progress(1)) throw scene::Interrupted("stopped");  // a renderer may keep what it has
  require_finite(pass.film, c.name);
  pass.stages = prepared->stages();
  pass.after.emplace(*c.renderer, c.settings, converted.scene, std::move(prepared));
  return pass;
}

std::vector<Estimate> Trials::stills(const Candidate& c, const Converted& converted,
                                     const std::vector<scene::View>& views) const {
  const scene::Execution how = timed_on(*c.renderer, execution());
  std::vector<Estimate> all;
  for (const scene::View& view : views) {
    std::vector<double> times;
    for (double spent = 0;
         times.size() < least_frames || (times.size() < most_frames && spent + times.back() < setup_.frames_seconds);
         spent += times.back()) {
      const double start = steady_seconds();
      c.renderer->prepare(converted.scene, c.settings, how)->render(view, how);
      times.push_back(steady_seconds() - start);
    }
    all.push_back(plus(median_estimate(times), converted.seconds));
  }
  return all;
}

std::vector<Estimate> Trials::frames(const Candidate& c, const Converted& converted, const Moves& moves, Pass& pass,
                                     const std::vector<scene::View>& views, const Goal& goal) const {
  const scene::Execution how = timed_on(*c.renderer, execution());
  const SharedScene other = all_moved_back(*converted.scene, moves);
  if (!other) throw scene::NotSupported("", "nothing in the converted scene moves so");
  if (const auto reasons = c.renderer->supports(*other, c.settings); !reasons.empty())
    throw scene::NotSupported("", reasons.front());
  const double conversion = converts(moves) ? converted.seconds : 0;
  pass.after->go_to(other, views.front(), how);
  if (is_hopeless(pass.after->one(views.front(), how) + conversion, goal)) return {};
  std::vector<Estimate> all;
  for (const scene::View& view : views)
    all.push_back(plus(median_estimate(pass.after->some(view, how, setup_.frames_seconds, least_frames)), conversion));
  return all;
}

// Times of a frame on each of the views; of one where it is far from the goal, as little as is known.
std::vector<FrameTime> Trials::times(const Trial& trial, const Converted& converted, const Moves& moves, Pass& first,
                                     const std::vector<scene::View>& views, const Goal& goal) const {
  const Candidate& c = *trial.candidate;
  const double least = first.render + (moves.empty() ? first.prepare : 0) + (converts(moves) ? converted.seconds : 0);
  std::vector<Estimate> found;
  if (!is_hopeless(least, goal) && !(goal.error && trial.error.low > hopeless_error * *goal.error))
    found = moves.empty() ? stills(c, converted, views) : frames(c, converted, moves, first, views, goal);
  if (found.empty()) return {{{least, least, infinity}, true}};
  std::vector<FrameTime> all;
  for (const Estimate& seconds : found) all.push_back({seconds, false});
  return all;
}

void Trials::screen(Trial& trial, const Truth& truth, const Goal& goal) {
  const Candidate& c = *trial.candidate;
  const Converted& converted = scene_for(c);
  trial.density_error = converted.density_error;
  if (!converted.scene) throw scene::NotSupported("", converted.refused);
  if (const auto reasons = c.renderer->supports(*converted.scene, c.settings); !reasons.empty())
    throw scene::NotSupported("", reasons.front());
  const SparseView& sparse = truth.sparse;
  Pass first = pass(c, converted, sparse.small);
  trial.left_out = experiments::left_out(first.stages);
  trial.error = error_of(first.film, truth, c.renderer->monte_carlo());
  if (!std::isfinite(trial.error.value)) throw Error("its error is not defined in this scene");
  trial.of_film = sparse.stride == 1;
  const double small = pixels_of(sparse.small), whole = pixels_of(sparse.whole);
  const double frames = double(least_frames + 3) * double(moves_.size());
  if (!trial.of_film && first.prepare + frames * first.render * whole / small < cheap * setup_.spend) {
    measure_on_film(trial, truth, goal);
  } else {
    std::vector<scene::View> views{sparse.small};
    if (!trial.of_film) views.push_back(smaller_view(sparse.small));
    costs_[&c] = first.prepare;
    for (const Moves& moves : moves_) {
      const std::vector<FrameTime> of_views = times(trial, converted, moves, first, views, goal);
      FrameTime time = of_views.front();
      if (time.at_least)
        time.seconds.value += first.render * (whole / small - 1);
      else if (!trial.of_film)
        time.seconds = extrapolated(of_views[0].seconds, small, of_views[1].seconds, pixels_of(views[1]), whole);
      trial.times.push_back(time);
      costs_[&c] += first.prepare + double(least_frames + 2) * time.seconds.value;
    }
  }
  trial.screened = trial.times;
}

void Trials::measure_on_film(Trial& trial, const Truth& truth, const Goal& goal) {
  const Candidate& c = *trial.candidate;
  const Converted& converted = scene_for(c);
  Pass first = pass(c, converted, truth.sparse.whole);
  Trial measured = trial;
  measured.of_film = true;
  measured.error = error_of(pick(first.film, truth.sparse), truth, c.renderer->monte_carlo());
  measured.times.clear();
  for (const Moves& moves : moves_) {
    const auto timed = [&] { return times(measured, converted, moves, first, {truth.sparse.whole}, goal).front(); };
    FrameTime time = timed();
    // Near the budget a disturbance decides: of two timings the lower one counts.
    if (!time.at_least && goal.seconds && time.seconds.value > near * *goal.seconds &&
        time.seconds.low < *goal.seconds / near)
      if (const FrameTime again = timed(); !again.at_least && again.seconds.value < time.seconds.value) time = again;
    measured.times.push_back(time);
  }
  trial = measured;
}

// False, and says why in the trial, where there are no figures.
bool Trials::attempt(Trial& trial, const std::function<void()>& work) {
  deadline_ = steady_seconds() + std::max(0.0, most_of_rest * left());
  try {
    if (left() <= 0) throw scene::Interrupted("no time is left");
    work();
    // A stopped render may have been timed as if it was complete.
    if (steady_seconds() >= deadline_) throw scene::Interrupted("no time is left");
    return true;
  } catch (const scene::Interrupted&) {
    check_interrupted();
    trial.stopped = "no time was left";
  } catch (const scene::NotSupported& objection) {
    trial.refused = objection.reason;
  } catch (const Unavailable& reason) {
    trial.refused = fmt::format("not available on this machine: {}", reason.what());
  } catch (const Error& error) {
    trial.refused = error.what();
  }
  return false;
}

namespace {

// The first row of each renderer, then the second, and so on: where time is short, all of them have been tried.
std::vector<const Candidate*> in_turns(const std::vector<Candidate>& candidates) {
  std::map<std::pair<const scene::Renderer*, bool>, int> counts;
  std::vector<std::pair<int, const Candidate*>> turns;
  for (const Candidate& c : candidates) turns.emplace_back(counts[{c.renderer, c.convert.has_value()}]++, &c);
  std::stable_sort(turns.begin(), turns.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const Candidate*> ordered;
  for (const auto& [turn, c] : turns) ordered.push_back(c);
  return ordered;
}

}  // namespace

std::vector<Trial> Trials::run(const std::vector<Candidate>& candidates, const Truth& truth, const Goal& goal,
                               const std::function<bool(const Candidate&)>& wanted) {
  const ProcessorTime before = processor_time();
  end_ = start_ + screening * setup_.spend;
  std::vector<Trial> trials;
  for (const Candidate* each : in_turns(candidates)) {
    const Candidate& c = *each;
    done_ += 0.6 / double(candidates.size());
    report_(done_);
    if (wanted && !wanted(c)) continue;
    Trial trial;
    trial.candidate = &c;
    bool needed = true;
    const bool done = attempt(trial, [&] {
      // A conversion only loses where the renderer knows the scene as it is.
      needed = !c.convert || !c.renderer->supports(*scene_, c.settings).empty();
      if (needed) screen(trial, truth, goal);
    });
    if (!done) trial.times.clear();
    if (needed) trials.push_back(std::move(trial));
  }
  end_ = start_ + setup_.spend;
  std::vector<Trial*> open;
  for (Trial& trial : trials) {
    if (!trial.done() || trial.of_film) continue;
    const bool in_time = !goal.seconds || std::any_of(trial.times.begin(), trial.times.end(), [&](const FrameTime& t) {
      return !t.at_least && t.seconds.low <= worth_trying * *goal.seconds;
    });
    if (in_time && (!goal.error || trial.error.low <= worth_trying * *goal.error)) open.push_back(&trial);
  }
  std::stable_sort(open.begin(), open.end(), [&](const Trial* a, const Trial* b) {
    return goal.error ? a->times[0].seconds.value < b->times[0].seconds.value : a->error.value < b->error.value;
  });
  for (std::size_t i = 0; i < open.size(); ++i) {
    done_ = 0.6 + 0.4 * double(i) / double(open.size());
    report_(done_);
    if (costs_[open[i]->candidate] > left()) continue;
    Trial tried = *open[i];
    if (attempt(tried, [&] { measure_on_film(tried, truth, goal); })) *open[i] = tried;
  }
  const ProcessorTime after = processor_time();
  const double waited = after.waited - before.waited, used = after.run - before.run;
  waited_ = waited > 0 ? waited / (used + waited) : 0;
  return trials;
}

}  // namespace airlight::experiments
