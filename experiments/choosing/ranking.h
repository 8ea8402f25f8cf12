// Choice among the tried candidates, and the confidence in it.
#pragma once
#include <string>
#include <vector>

#include "experiments/choosing/trials.h"

namespace airlight::experiments {

// Error for comparisons. If noise hides an error: at least half of its upper end.
double likely(const Measure& error);

// By trials' addresses; those without figures are in none of the lists.
struct Ranking {
  std::vector<const Trial*> fit;     // within the goal: by error where a time is given, by time where an error is
  std::vector<const Trial*> beyond;  // the others, the nearest to the goal first
};

// `move`: which of the moves' times counts. An error fits if its upper end does.
Ranking rank(const std::vector<Trial>&, const Goal&, std::size_t move = 0);

// The first of each renderer, apart with and without a conversion.
std::vector<const Trial*> heads(const std::vector<const Trial*>&);

// Trials beyond the goal that offer something: less error than the first choice and all that are nearer to the budget, or less time.
std::vector<const Trial*> worth_more(const Ranking&, const Goal&, std::size_t move = 0);

// One sentence each: what makes the first choice doubtful, or that nothing does.
std::vector<std::string> doubts(const Ranking&, const Goal&, const Truth&, std::size_t move = 0);

// A line for each reason for which candidates have no figures: "Fogshop, wavelet fog: medium 'fog' is ...".
std::vector<std::string> refusals(const std::vector<Trial>&);

// "16 % (15 to 17)", "below noise, < 0.4 %".
std::string error_text(const Measure&);
// "4.4 ms (4.2 to 4.9)"; "about ..." where it is extrapolated, "over ..." where it is only known to be longer.
std::string frame_text(const FrameTime&, bool of_film);

}  // namespace airlight::experiments
