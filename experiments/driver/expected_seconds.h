// How long the rows and references of an experiment will take, from the records of finished runs.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"

namespace airlight::experiments {

// A scene's film and reference, as far as seconds depend on it.
struct PlannedFilm {
  double pixels = 0;
  double samples = 0;  // per pixel; 0: the reference takes none
};

struct ExpectedSeconds {
  enum class From { own_record, quick_record, nothing };
  From from = From::nothing;
  bool guessed = false;  // some rows have no like in the record, or there is no record
  // [s] of each row in the order of the table: one run with its preparation, and all timed runs.
  std::vector<double> once, timed;
  std::map<std::string, double> references;  // by scene
  double threads = 1;                        // that the record's run had

  double of_rows() const;  // timed
};

// From the record of the experiment's profile below `results`. Without one, from the record of the profile quick: times of pictures are scaled
// by their pixels, those of references by pixels and samples, and the number of runs follows the rule of timing. Rows of other kinds count
// only where overrides and settings are those of the profile quick. A row without its like takes as long as the others do on average.
// `films` by scene; a scene that is missing there counts as of the same size. Throws Error for a record of another version.
ExpectedSeconds expected_seconds(const Experiment&, const Folders&, const std::map<std::string, PlannedFilm>& films);

}  // namespace airlight::experiments
