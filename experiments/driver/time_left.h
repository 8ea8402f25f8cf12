// How long the rest of a run will take, from how long the same work took before, perhaps on another machine.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"

namespace airlight::experiments {

class TimeLeft {
 public:
  // [s] that all the work took there.
  explicit TimeLeft(double work) : work_(work) {}

  // A piece of the work took so many seconds here.
  void done(double piece, double seconds);
  // A piece of the work need not be done: a row that is kept, a reference that is there.
  void spared(double piece) { spared_ += piece; }

  // [s] For the work that is neither done nor spared, of which one piece has been under way for so many seconds and is
  // done to this share.
  double left(double piece, double share, double seconds) const;

 private:
  // How many times as long as there: what was measured, and as if `trusted_work` more had taken as long here as there, so
  // that the first rows decide little.
  double slowness() const;

  double work_, done_ = 0, spared_ = 0, seconds_ = 0;
};

// "about 21 min left", "about 40 s left", "a few seconds left".
std::string time_left_text(double seconds);

// [s] What an experiment took when its record was written.
struct PlannedWork {
  std::string name;                          // "fogshop/fig4_smooth (quick)"
  double rows = 0;                           // all of them
  std::map<std::string, double> references;  // by scene
  double total() const;
};

// From one record; nothing where there is none, or none that can be read: then it only does not help to plan. `reads_films`: its references are
// films that lie there. References whose keys are in `shared` are left out; the others' keys go there.
std::optional<PlannedWork> recorded_work(const std::filesystem::path& record, bool reads_films,
                                         std::set<std::string>& shared);

// From the records below the results folder. An experiment without one is taken to last as long as the others do on
// average. A reference that several experiments share is counted for the first of them.
std::vector<PlannedWork> planned_work(const std::vector<Experiment>&, const std::filesystem::path& results);

}  // namespace airlight::experiments
