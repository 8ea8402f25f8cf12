// Values that a paper prints, beside our measurements ([[expected]]), and the sentence for people that
// quotes them (summary).
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "experiments/driver/comparisons.h"
#include "experiments/driver/outcome.h"

namespace airlight::experiments {

// In what an [[expected]] may print its figure: percent, times, s, ms, us, ns, per second.
std::vector<std::string> expected_units();

// Can a figure of this metric be printed in that unit? An error as a share can be in percent, a time cannot.
bool fits_unit(const ExpectedCase&);

// "3.3 %", "31 times", "0.52 ms", "at most 0.12 %": two digits, in the entry's unit, or where it names none in the usual
// one of the metric. "not available" where this run has no such figure.
std::string figure_text(const Outcome&, const ExpectedCase&);

// Lines "what, printed, ours", the header first: ours with interval, film and frames per second.
TextTable expected_table(const Outcome&);

// The text with every {n} replaced by figure(n), n from 1. Throws Error for a brace without its partner and for what is no number.
std::string fill_in(const std::string& text, const std::function<std::string(std::size_t)>& figure);

// The experiment's summary with its figures; empty if it has none.
std::string summary_text(const Outcome&);

}  // namespace airlight::experiments
