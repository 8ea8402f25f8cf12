#include "experiments/choosing/verdict.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/choosing/ranking.h"

namespace airlight::experiments {

Verdict judge_choice(const Trial* chosen, const std::vector<Trial>& judged, double seconds, std::size_t move) {
  const auto told = [&](const Trial& t) {
    return fmt::format("error {}, {}", error_text(t.error), frame_text(t.times[move], t.of_film));
  };
  const Trial *best = nullptr, *same = nullptr;
  for (const Trial& trial : judged) {
    if (!trial.done()) continue;
    const FrameTime& time = trial.times[move];
    if (chosen && trial.candidate == chosen->candidate) same = &trial;
    if (time.at_least || time.seconds.value > seconds / time_margin) continue;
    if (!best || likely(trial.error) < likely(best->error)) best = &trial;
  }
  if (!chosen && !best) return {true, 1, ""};
  if (!chosen) return {false, infinity, fmt::format("chose nothing; {} fits: {}", best->candidate->name, told(*best))};
  const std::string choice = fmt::format("chose {} ({})", chosen->candidate->name, told(*chosen));
  if (!same || same->times[move].at_least || same->times[move].seconds.value > seconds * time_margin)
    return {false, infinity, choice + (same ? "; judged: " + told(*same) : "; it could not be judged")};
  if (!best) return {true, 1, ""};
  const double ratio = std::max(1.0, best->error.high > 0 ? same->error.low / best->error.high : 1.0);
  if (ratio <= most_times_best) return {true, ratio, ""};
  return {false, ratio,
          fmt::format("{}; judged: {}; best: {}, {}", choice, told(*same), best->candidate->name, told(*best))};
}

void keep_lower_times(std::vector<Trial>& judged, const std::vector<Trial>& tried) {
  for (Trial& trial : judged)
    for (const Trial& other : tried) {
      if (other.candidate != trial.candidate || !other.of_film || !trial.done()) continue;
      for (std::size_t move = 0; move < trial.times.size(); ++move)
        if (!other.times[move].at_least && other.times[move].seconds.value < trial.times[move].seconds.value)
          trial.times[move] = other.times[move];
    }
}

}  // namespace airlight::experiments
