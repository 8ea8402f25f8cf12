// Rows of one experiment that were computed in parts, on several computers.
#pragma once
#include <string>
#include <vector>

#include "experiments/application/folders.h"
#include "experiments/driver/experiment.h"

namespace airlight::experiments {

// Takes the finished rows of those folders, and their pictures, over into the folder of results, so that a run that resumes finds them.
// Throws Error for a folder that has no row of the experiment, and where two folders differ in the errors of a row.
void take_over_parts(const Folders&, const Experiment&, const std::vector<std::string>& parts);

}  // namespace airlight::experiments
