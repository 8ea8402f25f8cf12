// A plan as a script for an engine that runs tasks.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "experiments/driver/schedule.h"

namespace airlight::experiments {
namespace {

std::string rough_time(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// Eight of them at most.
std::string first_names(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  const std::vector<std::string> first(names.begin(), names.begin() + std::ptrdiff_t(std::min(most, names.size())));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > most ? ", ..." : "");
}

// What both scripts begin with: the folder, the lists of tasks, and what runs a task.
std::string head(const Schedule& plan, const ScriptOptions& options) {
  std::string out = fmt::format(
      "#!/bin/sh\n# Made by `{}`.\n# All computers see the folder of this plan. Running the script again goes on with what "
      "is unfinished.\nset -eu\nwork={}\nmkdir -p \"$work/log\" \"$work/tasks\"\n",
      options.made_by, quoted(options.work));
  for (const Stage& stage : plan.stages) {
    out += fmt::format("\ncat > \"$work/tasks/{}\" <<'END'\n", stage.name);
    for (std::size_t i = 0; i < stage.tasks.size(); ++i)
      for (const std::string& command : stage.tasks[i].commands) {
        const bool threads = !stage.alone && stage.name != "gather";
        out += fmt::format("{}\t{} {} --root {} --cache {}{}\n", i + 1, quoted(options.program), command,
                           quoted(options.root), quoted(options.cache),
                           threads ? fmt::format(" --threads {}", options.threads) : "");
      }
    out += "END\n";
  }
  return out + R"sh(
cat > "$work/task" <<'END'
#!/bin/sh
# task LIST NUMBER: runs the commands of one task; Slurm has the number in a variable.
# After SIGUSR1 it ends with 130, once the row in hand is finished.
wanted=${2:-${SLURM_ARRAY_TASK_ID:-}}
work=$(dirname "$(dirname "$1")")
export work
pid=
ended=
trap 'ended=1; [ -z "$pid" ] || kill -USR1 "$pid" 2>/dev/null' USR1
while IFS='	' read -r number command <&3; do
  [ "$number" = "$wanted" ] || continue
  sh -c "exec $command" 3<&- &
  pid=$!
  code=0
  wait "$pid" || code=$?
  while kill -0 "$pid" 2>/dev/null; do
    code=0
    wait "$pid" || code=$?
  done
  [ -z "$ended" ] || code=130
  [ "$code" = 0 ] || break
done 3< "$1"
if [ "${code:-0}" = 130 ] && [ -n "${SLURM_ARRAY_JOB_ID:-}" ]; then
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
fi
exit "${code:-0}"
END
chmod +x "$work/task"
)sh";
}

}  // namespace

std::string schedule_text(const Schedule& plan, int tasks) {
  std::string out = fmt::format("{} experiments, {} rows\n{:<12}{:>7}{:>10}{:>14}\n", plan.experiments, plan.rows,
                                "stage", "tasks", "work", "longest task");
  double work = 0, last = 0;
  const Stage* limit = nullptr;
  for (const Stage& stage : plan.stages) {
    out += fmt::format("{:<12}{:>7}{:>10}{:>14}{}\n", stage.name, stage.tasks.size(),
                       stage.unknown ? "unknown" : rough_time(stage.seconds()),
                       stage.unknown ? "unknown" : rough_time(stage.longest()),
                       stage.alone ? "  each on a computer of its own" : "");
    work += stage.seconds();
    last += stage.longest();
    if (!limit || stage.longest() > limit->longest()) limit = &stage;
  }
  const ScheduledTask* slowest = nullptr;
  for (const ScheduledTask& task : limit->tasks)
    if (!slowest || task.seconds > slowest->seconds) slowest = &task;
  out += fmt::format("With {} tasks at once {} takes {}: {:.1f} times as fast as one task at a time.\n", tasks,
                     plan.stages.front().unknown ? "all but the sequences" : "all", rough_time(last), work / last);
  out += fmt::format("The longest task, {}: {}{}\n", rough_time(slowest->seconds), slowest->commands.front(),
                     slowest->commands.size() > 1 ? fmt::format(" and {} more", slowest->commands.size() - 1) : "");
  if (plan.bytes > 0)
    out +=
        fmt::format("Ranges of samples take {:.2g} GB in the cache until films are made of them.\n", plan.bytes / 1e9);
  if (!plan.scaled.empty())
    out += fmt::format(
        "{} experiments have no record of this profile. Their seconds come from the profile quick, times pixels and samples.\n",
        plan.scaled.size());
  if (!plan.guessed.empty())
    out += fmt::format("{} experiments have rows without a record, which are taken to last as long as the others: {}\n",
                       plan.guessed.size(), first_names(plan.guessed));
  return out;
}

std::string slurm_script(const Schedule& plan, const ScriptOptions& options) {
  std::string out = head(plan, options) + R"sh(
# submit STAGE TASKS MINUTES OPTION...: prints the number of the job.
submit() {
  stage=$1 tasks=$2 minutes=$3
  shift 3
  sbatch --parsable --job-name="airlight-$stage" --array="1-$tasks" --time="$minutes" --requeue --signal=B:USR1@120 \
    --output="$work/log/$stage-%a.log" --open-mode=append "$@" "$work/task" "$work/tasks/$stage" | cut -d';' -f1
}

)sh";
  const std::string memory = options.memory > 0 ? fmt::format(" --mem={}G", options.memory) : "";
  std::string before;
  for (const Stage& stage : plan.stages) {
    // Twice what is expected, and the time in which a task finishes its row.
    const double minutes = stage.unknown ? 24 * 60 : std::ceil((2 * stage.longest() + 240) / 60);
    out += fmt::format("{}=$(submit {} {} {:.0f} {}{})\n", stage.name, stage.name, stage.tasks.size(), minutes,
                       (stage.alone ? "--exclusive" : fmt::format("--cpus-per-task={}", options.threads)) + memory,
                       before.empty() ? "" : fmt::format(" --dependency=afterok:\"${}\"", before));
    before = stage.name;
  }
  return out + "echo \"job $gather writes $work/results when all others are done\"\n";
}

std::string parallel_script(const Schedule& plan, const ScriptOptions& options) {
  std::string out = head(plan, options) + R"sh(
# Tasks at a time: JOBS, by default one per processor.
JOBS=${JOBS:-$(nproc)}
)sh";
  for (const Stage& stage : plan.stages)
    out += fmt::format(
        "seq {} | parallel --will-cite --joblog \"$work/{}.joblog\" --resume-failed --halt soon,fail=1 -j {} \"$work/task\" "
        "\"$work/tasks/{}\"\n",
        stage.tasks.size(), stage.name, stage.alone ? "1" : "\"$JOBS\"", stage.name);
  return out + "echo \"$work/results\"\n";
}

}  // namespace airlight::experiments
