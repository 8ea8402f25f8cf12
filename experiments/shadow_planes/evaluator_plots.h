// Scripts and data of the plots of `airlight evaluators`.
#pragma once
#include <filesystem>
#include <vector>

#include "experiments/shadow_planes/evaluator_errors.h"

namespace airlight::experiments::shadow_planes {

// evaluator_times.csv and .gp in the folder: error against time, a curve for each evaluator and precision.
void write_time_plot(const std::filesystem::path& plots, const std::vector<TimedRow>&);

// stability_map.gp, which draws ../map.csv: extinction, h, then one column for each of `map_evaluators()`.
void write_map_plot(const std::filesystem::path& plots);

}  // namespace airlight::experiments::shadow_planes
