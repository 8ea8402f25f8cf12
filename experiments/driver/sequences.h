// Sequences of smoke that scenes show: simulated when an experiment first asks for them, kept in sequences/ of the cache.
#pragma once
#include <string>

#include "experiments/application/probe.h"
#include "experiments/driver/experiment.h"

namespace airlight::experiments {

// The pattern of its files, as a `file` with a `frame`, whether they are there or not: of "NAME" its frames, of "NAME.csv" the coefficients
// of its density, of "NAME.OTHER.csv" those of another, of "NAME.particles.csv" the places of its particles; of a fit "NAME.csv" the
// Gaussians, "NAME.residual" what they leave; of a script "NAME.csv" the Gaussians. Throws Error, beginning with `where`: no such sequence in experiments/sequences.toml, no
// such files.
std::string sequence_files(const Folders&, const std::string& name, const std::string& profile,
                           const std::string& where);

// Overrides whose value is "sequence:NAME" become that pattern, and `names` gets NAME once. Throws Error as above.
void name_sequences(const Folders&, const std::string& profile, const std::string& where, Pairs& overrides,
                    std::vector<std::string>& names);

// Simulates it, fits Gaussians to it or runs its script, whatever the list says, unless it is there and of the same problem, settings and program; one
// that was stopped goes on. Throws Error (file, line, column), Interrupted.
void make_sequence(const Folders&, const std::string& name, const std::string& profile, int threads);

// The columns of its history.csv (frames.h); of a fit the numbers that its record holds of each frame. Throws Error.
Columns sequence_history(const Folders&, const std::string& name, const std::string& profile);

}  // namespace airlight::experiments
