// Which task of a cluster, or of one machine, computes what of some experiments.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/application/folders.h"
#include "experiments/driver/experiment.h"

namespace airlight::experiments {

// Shares jobs of so many seconds among tasks: each in turn, the longest first, to the task that has least. No task takes
// more than 4/3 - 1/(3 tasks) times as long as in the best plan (Graham 1969). There are fewer tasks where one would last
// less than `least` seconds. Gives the numbers of the jobs of each task, in their order.
std::vector<std::vector<std::size_t>> balanced(const std::vector<double>& seconds, int tasks, double least);

struct ScheduledTask {
  double seconds = 0;
  std::vector<std::string> commands;  // arguments of airlight, as a shell reads them; "$work" is the plan's folder
};

// A stage begins when all tasks of the stages before it have ended.
struct Stage {
  std::string name;  // "sequences", "references", "films", "rows", "times" or "gather"
  std::vector<ScheduledTask> tasks;
  bool alone = false;    // a task has its computer to itself
  bool unknown = false;  // nobody recorded how long its tasks take

  double seconds() const;  // of all tasks
  double longest() const;  // of one task
};

struct Schedule {
  std::vector<Stage> stages;  // none is empty
  std::size_t experiments = 0, rows = 0;
  std::vector<std::string> scaled;   // experiments whose seconds come from the record of the profile quick
  std::vector<std::string> guessed;  // experiments with rows that no record has: they take as long as the others do
  double bytes = 0;                  // of files with ranges of samples
};

struct ScheduleOptions {
  int tasks = 1;
  double least = 60;           // [s] of a task
  int threads = 1;             // of a task; those whose work is not timed take as much longer as the records had more
  bool without_times = false;  // else rows that are timed are computed in one task for each experiment
};

// From the seconds in the records below results/ of the project (expected_seconds.h). References that the cache has are left out; one that
// takes longer than a fair share is cut into ranges of samples, and the stage "films" joins them.
Schedule schedule(const std::vector<Experiment>&, const Folders&, const ScheduleOptions&);

// What the plan costs, for people; a script that hands it to Slurm or to GNU parallel, run from any folder; and all as data.
std::string schedule_text(const Schedule&, int tasks);
struct ScriptOptions {
  std::string made_by, program;   // command line, path of the program
  std::string work, root, cache;  // absolute folders that all computers see: of the plan, the project, the references
  int threads = 1;                // of a task
  int memory = 0;                 // [GiB] of a task; 0: what the site gives
};
std::string slurm_script(const Schedule&, const ScriptOptions&);
std::string parallel_script(const Schedule&, const ScriptOptions&);
nlohmann::json to_json(const Schedule&);

}  // namespace airlight::experiments
