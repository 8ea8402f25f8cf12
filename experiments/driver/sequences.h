// Sequences of smoke that scenes show: simulated when an experiment first asks for them, kept in results/cache/sequences.
#pragma once
#include <filesystem>
#include <string>

#include "experiments/driver/experiment.h"

namespace airlight::experiments {

// Overrides whose value is "sequence:NAME" become the pattern of that sequence's files ("frame" tells which), and `names`
// gets NAME once. Throws Error, beginning with `where`: no such sequence in experiments/sequences.toml.
void name_sequences(const std::filesystem::path& root, const std::string& profile, const std::string& where,
                    Pairs& overrides, std::vector<std::string>& names);

// Those that are not there yet, or of another problem, solver or program, with progress; one that was stopped goes on.
// Throws Error (file, line, column), Interrupted.
void make_sequences(const std::filesystem::path& root, const Experiment&);

}  // namespace airlight::experiments
