// Was a choice good? Judged by trials of all candidates on the scene's whole film.
#pragma once
#include <string>
#include <vector>

#include "experiments/choosing/trials.h"

namespace airlight::experiments {

inline constexpr double most_times_best = 1.5;  // the best error
inline constexpr double time_margin = 1.1;      // what two timings of the same frame may differ by

struct Verdict {
  bool hit = false;
  // Error of the choice over the best error within the time, as far as the intervals tell: lower over upper end, at least 1. Infinite where
  // the choice takes too long, or nothing was chosen and something fits.
  double ratio = 1;
  std::string why;  // of a miss
};

// `chosen`: by its own trial, null if nothing was. The best is the least error of those that take at most `seconds` / time_margin; the choice
// may take `seconds` * time_margin.
Verdict judge_choice(const Trial* chosen, const std::vector<Trial>& judged, double seconds, std::size_t move);

// Takes the times of `tried` where these are lower and of the scene's own film: the slower of two timings of one frame was disturbed.
void keep_lower_times(std::vector<Trial>& judged, const std::vector<Trial>& tried);

}  // namespace airlight::experiments
