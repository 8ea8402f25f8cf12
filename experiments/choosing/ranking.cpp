#include "experiments/choosing/ranking.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "experiments/driver/comparisons.h"

namespace airlight::experiments {
namespace {

// Two significant digits.
std::string percent(double share) {
  const double value = 100 * share;
  return value >= 9.95    ? fmt::format("{:.0f}", value)
         : value >= 0.995 ? fmt::format("{:.1f}", value)
                          : fmt::format("{:.2g}", value);
}

// Candidates of one renderer fold to its name.
std::string renderers_of(const std::vector<const Trial*>& trials) {
  std::map<std::string, int> counts;
  for (const Trial* trial : trials) {
    const Candidate& c = *trial->candidate;
    ++counts[c.renderer->name() + (c.convert ? ", converted" : "")];
  }
  std::vector<std::string> texts;
  for (const auto& [name, count] : counts) texts.push_back(count > 1 ? fmt::format("{} ({} rows)", name, count) : name);
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace

double likely(const Measure& error) {
  return error.below_floor ? std::max(error.value, 0.5 * error.high) : error.value;
}

Ranking rank(const std::vector<Trial>& trials, const Goal& goal, std::size_t move) {
  Ranking ranking;
  for (const Trial& trial : trials) {
    if (!trial.done()) continue;
    const FrameTime &time = trial.times[move], &screened = trial.screened[move];
    const bool fits = goal.seconds ? !time.at_least && time.seconds.value <= *goal.seconds &&
                                         screened.seconds.low <= worth_trying * *goal.seconds
                                   : trial.error.high <= *goal.error;
    (fits ? ranking.fit : ranking.beyond).push_back(&trial);
  }
  const auto time = [&](const Trial* t) { return t->times[move].seconds.value; };
  const auto error = [](const Trial* t) { return likely(t->error); };
  const auto by = [](auto first, auto second) {
    return
        [=](const Trial* a, const Trial* b) { return std::pair(first(a), second(a)) < std::pair(first(b), second(b)); };
  };
  if (goal.seconds) {
    std::stable_sort(ranking.fit.begin(), ranking.fit.end(), by(error, time));
    std::stable_sort(ranking.beyond.begin(), ranking.beyond.end(), by(time, error));
  } else {
    std::stable_sort(ranking.fit.begin(), ranking.fit.end(), by(time, error));
    std::stable_sort(ranking.beyond.begin(), ranking.beyond.end(), by(error, time));
  }
  return ranking;
}

std::vector<const Trial*> heads(const std::vector<const Trial*>& trials) {
  std::vector<const Trial*> first;
  std::set<std::pair<const scene::Renderer*, bool>> seen;
  for (const Trial* trial : trials)
    if (seen.emplace(trial->candidate->renderer, trial->candidate->convert.has_value()).second) first.push_back(trial);
  return first;
}

std::vector<const Trial*> worth_more(const Ranking& ranking, const Goal& goal, std::size_t move) {
  const auto loss = [&](const Trial* t) { return goal.seconds ? likely(t->error) : t->times[move].seconds.value; };
  std::vector<const Trial*> better;
  double least = ranking.fit.empty() ? infinity : loss(ranking.fit.front());
  for (const Trial* trial : ranking.beyond) {
    if (loss(trial) >= least) continue;
    least = loss(trial);
    better.push_back(trial);
  }
  return better;
}

std::vector<std::string> doubts(const Ranking& ranking, const Goal& goal, const Truth& truth, std::size_t move) {
  std::vector<std::string> all;
  const auto name = [](const Trial* trial) { return trial->candidate->name; };
  const Trial* first = ranking.fit.empty() ? nullptr : ranking.fit.front();
  if (!first) all.push_back("Nothing that was tried reaches this.");
  if (first && !first->of_film)
    all.push_back("The first was tried on the small film alone; a longer --spend tries it on the scene's own film.");
  if (first && first->error.below_floor && truth.samples > 0)
    all.push_back(
        fmt::format("The noise of the reference hides the error of the first; --samples {} shows smaller errors.",
                    4 * truth.samples));
  if (goal.seconds) {
    const auto close = [&](const Trial* trial) { return trial != first && trial->error.low < first->error.high; };
    const auto rivals = first ? std::count_if(ranking.fit.begin(), ranking.fit.end(), close) : 0;
    if (rivals > 0) {
      const Trial* rival = *std::find_if(ranking.fit.begin(), ranking.fit.end(), close);
      all.push_back(fmt::format("The error of {} is the same within the intervals{}.", name(rival),
                                rivals > 1 ? fmt::format(", and that of {} more", rivals - 1) : ""));
    }
    if (first && first->times[move].seconds.high > 0.8 * *goal.seconds)
      all.push_back("The time of the first is within 20 % of the budget, or its interval reaches that.");
    for (const Trial* trial : ranking.beyond)
      if (trial->times[move].seconds.low <= *goal.seconds && !trial->times[move].at_least &&
          (!first || likely(trial->error) < likely(first->error))) {
        all.push_back(fmt::format("{} may fit, and its error is {}.", name(trial), error_text(trial->error)));
        break;
      }
  } else {
    for (const Trial* trial : ranking.beyond)
      if (trial->error.low <= *goal.error && likely(trial->error) < 2 * *goal.error &&
          (!first || trial->times[move].seconds.value < first->times[move].seconds.value)) {
        all.push_back(fmt::format("The error of {} may be small enough, and it is faster.", name(trial)));
        break;
      }
    if (first && ranking.fit.size() > 1 && ranking.fit[1]->times[move].seconds.low < first->times[move].seconds.high)
      all.push_back(fmt::format("{} takes the same time within the intervals.", name(ranking.fit[1])));
  }
  if (all.empty()) all.push_back("The choice is clear: no interval reaches the next one, or the goal.");
  return all;
}

std::vector<std::string> refusals(const std::vector<Trial>& trials) {
  std::vector<std::string> reasons;
  std::map<std::string, std::vector<const Trial*>> by_reason;
  for (const Trial& trial : trials) {
    const std::string& reason = trial.refused.empty() ? trial.stopped : trial.refused;
    if (reason.empty()) continue;
    if (by_reason[reason].empty()) reasons.push_back(reason);
    by_reason[reason].push_back(&trial);
  }
  std::vector<std::string> lines;
  for (const std::string& reason : reasons)
    lines.push_back(fmt::format("{}: {}", renderers_of(by_reason[reason]), reason));
  return lines;
}

std::string error_text(const Measure& error) {
  if (error.below_floor) return fmt::format("below noise, < {} %", percent(error.high));
  return fmt::format("{} % ({} to {})", percent(error.value), percent(error.low), percent(error.high));
}

std::string frame_text(const FrameTime& time, bool of_film) {
  if (time.at_least) return "over " + duration(time.seconds.low);
  return fmt::format("{}{} ({} to {})", of_film ? "" : "about ", duration(time.seconds.value),
                     duration(time.seconds.low), duration(time.seconds.high));
}

}  // namespace airlight::experiments
