// Records of runs (run.json) in the forms that papers and notebooks read: `airlight results`.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

// What a record says of a run.
struct RecordedRun {
  std::string name;  // "group/name", or "group/name.paper" for profile paper
  std::filesystem::path folder;
  std::string experiment, profile, title, commit;
  std::string machine;  // "AMD EPYC, 2 threads"
  std::vector<Row> rows;
  std::size_t plots = 0;
};

// Names of all records below a results folder, sorted.
std::vector<std::string> record_names(const std::filesystem::path& results);

// Throws Error, one line, for a file that is no record of this version.
RecordedRun read_run(const std::filesystem::path& results, const std::string& name);

// A figure of a row under the name that experiment files use: metrics, "seconds", "prepare_seconds", "camera_seconds",
// "lights_seconds", "media_seconds", and "counter.NAME".
struct RecordedFigure {
  std::string metric;
  Estimate value;
  double floor = 0;    // noise of the reference in the metric's unit
  bool below = false;  // below that noise: only value.high is known
};
// All figures, or those of these names in this order.
std::vector<RecordedFigure> figures(const Row&, const std::vector<std::string>& metrics);

// A line for each figure of each row. A row without figures has one line with its note.
std::string long_csv(const std::vector<RecordedRun>&,
                     const std::vector<std::string>& metrics);  // a column for each setting
std::string long_jsonl(const std::vector<RecordedRun>&,
                       const std::vector<std::string>& metrics);  // settings are an object

// A table for booktabs and siunitx. In each scene the smallest error and the shortest time are bold; a value below noise
// counts by its upper bound. Without names: the first metric, and the time of one render.
std::string latex_table(const RecordedRun&, std::vector<std::string> metrics);

// Every plot of the run as a picture for pgfplots; `outcome` is its experiment with the rows of the record.
std::string pgfplots(const Outcome& outcome, const RecordedRun&);

// Text in which LaTeX takes no character for a command.
std::string latex_text(const std::string&);

}  // namespace airlight::experiments
