#include "experiments/cli/experiment_plan.h"

#include <fmt/format.h>

#include "experiments/application/json_value.h"
#include "experiments/application/progress.h"
#include "experiments/application/say.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/samples.h"
#include "experiments/driver/plan.h"
#include "experiments/driver/reference_cache.h"
#include "experiments/driver/run.h"
#include "experiments/driver/schedule.h"
#include "experiments/driver/sequences.h"
#include "reference/path_tracer/cache.h"
#include "scene/base/content_store.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

struct PlanOptions {
  std::string root, profile = "quick", cache, work = "airlight-plan", scene;
  std::vector<std::string> names;
  int tasks = 0, threads = 1, memory = 0;
  std::string samples;
  double least = 60;
  bool without_times = false, slurm = false, parallel = false, json = false;
};

std::vector<Experiment> read(const PlanOptions& options, const Folders& folders) {
  if (options.profile != "quick" && options.profile != "paper")
    throw Error(fmt::format("--profile '{}': expected quick or paper", options.profile));
  std::vector<Experiment> experiments;
  for (const std::string& id : choose_experiments(folders.root, options.names)) {
    experiments.push_back(read_experiment(folders, id, options.profile));
  }
  return experiments;
}

int plan(const PlanOptions& options) {
  if (options.tasks < 1) throw Error("--tasks is missing; see --help");
  if (options.memory > 0 && !options.slurm) throw Error("--memory: only Slurm is asked for memory; see --slurm");
  if (options.slurm + options.parallel + options.json > 1)
    throw Error("--slurm, --parallel and --json: expected one of them");
  const Folders folders{project_root(options.root), {}, options.cache};
  const Schedule made =
      schedule(read(options, folders), folders, {options.tasks, options.least, options.threads, options.without_times});
  std::string made_by = "airlight experiment plan";
  for (const std::string& name : options.names) made_by += " " + name;
  made_by += fmt::format(" --profile {} --tasks {}", options.profile, options.tasks);
  const ScriptOptions script{made_by,
                             std::filesystem::read_symlink("/proc/self/exe").string(),
                             std::filesystem::absolute(options.work).string(),
                             std::filesystem::absolute(folders.root).string(),
                             std::filesystem::absolute(folders.cache).string(),
                             options.threads,
                             options.memory};
  fmt::print("{}", options.slurm      ? slurm_script(made, script)
                   : options.parallel ? parallel_script(made, script)
                   : options.json     ? to_json(made).dump(1) + "\n"
                                      : schedule_text(made, options.tasks));
  return 0;
}

// Keeps the samples of the range; a later call without one makes the film of all that are kept.
void make_range(const PlannedScene& planned, const SampleRange& range, const scene::Execution& execution) {
  if (!planned.reference->monte_carlo())
    throw Error(fmt::format("--samples: the reference of scene '{}' is no path tracer and has no samples",
                            planned.scene->name));
  planned.reference->require_support(*planned.scene, *planned.reference_settings);
  const path_tracer::World world(planned.scene, path_tracer::parse_options(*planned.reference_settings));
  const std::string folder = path_tracer::samples_folder(*execution.store);
  if (!path_tracer::keep_range(world, scene::view_of(*planned.scene), folder, range.begin, range.end, execution))
    throw scene::Interrupted("interrupted: its samples are kept");
}

int make_reference(const PlanOptions& options) {
  if (options.names.size() != 1 || options.scene.empty()) throw Error("NAME or SCENE is missing; see --help");
  const std::optional<SampleRange> range = sample_range(options.samples);
  if (range && !range->explicit_range)
    throw Error(fmt::format("--samples '{}': expected a range A..B", options.samples));
  const Folders folders{project_root(options.root), {}, options.cache};
  const std::vector<Experiment> experiments = read(options, folders);
  const Experiment& e = experiments.front();
  for (const std::string& name : e.sequences) make_sequence(folders, name, options.profile, options.threads);
  if (experiments.size() != 1) throw Error(fmt::format("expected one experiment, found {}", experiments.size()));
  for (const SceneCase& c : e.scenes) {
    if (c.name != options.scene) continue;
    const PlannedScene planned = plan_reference(e, c);
    if (!planned.reference) throw Error(fmt::format("{}: scene '{}' has no reference", e.id, c.name));
    const scene::ContentStore store(folders.cache, say);
    Progress progress("reference of " + c.name);
    scene::Execution execution = progress.execution(options.threads);
    execution.store = &store;
    const bool there = is_there(planned, store);
    if (range && !there) {
      make_range(planned, *range, execution);
      fmt::print("reference of {}: samples {} are kept\n", c.name, options.samples);
      return 0;
    }
    const Reference made =
        reference_for(planned.scene, *planned.reference, *planned.reference_settings, execution, planned.committed);
    fmt::print("reference of {}: {}{}\n", c.name, made.key, there ? ", was there" : "");
    return 0;
  }
  throw Error(fmt::format("{}: there is no scene '{}'", e.id, options.scene));
}

void add_project(CLI::App* c, PlanOptions& options) {
  c->add_option("--root", options.root,
                "folder of the project (default: found above the current folder, else above the program)");
  c->add_option("--profile", options.profile, "quick or paper (default quick)");
  c->add_option("--cache", options.cache, "folder of references and simulated smoke (default: results/cache/)")
      ->type_name("FOLDER");
  c->add_option("--threads", options.threads, "number of threads of a task (default 1)")->check(CLI::Range(1, 4096));
}

}  // namespace

void add_plan(Commands& commands, CLI::App& experiment) {
  const auto options = std::make_shared<PlanOptions>();
  CLI::App* c =
      add_command(experiment, "plan",
                  "share the work of experiments among the tasks of a cluster, by the seconds in their records; "
                  "print what that costs, or a script");
  c->add_option("NAME", options->names, "experiments: group/name, or a whole group (default: all)");
  c->add_option("--tasks", options->tasks, "most tasks of a stage (required)")->check(CLI::Range(1, 100000));
  c->add_flag("--slurm", options->slurm, "print a script that submits the tasks to Slurm: plan ... --slurm | sh");
  c->add_flag("--parallel", options->parallel, "print a script that runs the tasks with GNU parallel");
  c->add_flag("--json", options->json, "print the tasks and their commands as JSON");
  c->add_option("--least", options->least, "seconds below which a task gets more work (default 60)")
      ->check(CLI::Range(0.001, 1e6));
  c->add_option("--work", options->work,
                "folder of the plan's rows, logs and results, which all computers see (default airlight-plan)")
      ->type_name("FOLDER");
  c->add_flag("--without-times", options->without_times,
              "render each picture once and keep no times; else an experiment that times its rows is one task, with a "
              "computer of its own");
  c->add_option("--memory", options->memory, "memory [GiB] that a task asks of Slurm (default: what the site gives)")
      ->check(CLI::Range(1, 65536));
  add_project(c, *options);
  commands.add_data(c);
  commands.add_gpu(c);
  commands.on(c, [options] { return plan(*options); });
}

void add_reference(Commands& commands, CLI::App& experiment) {
  const auto options = std::make_shared<PlanOptions>();
  CLI::App* c = add_command(experiment, "reference",
                            "compute the reference of one scene into the cache, or say that it is there");
  const auto name = std::make_shared<std::string>();
  c->add_option("NAME", *name, "the experiment: group/name (required)");
  c->add_option("SCENE", options->scene, "name of the scene in the experiment's tables (required)");
  c->add_option(
      "--samples", options->samples,
      "only the samples A..B of every pixel, A a multiple of 64 (path_tracer only): they are kept in the cache, "
      "and the command without this option makes the reference of all ranges there");
  add_project(c, *options);
  commands.add_limit(c);
  commands.add_data(c);
  commands.add_gpu(c);
  commands.on(c, [options, name] {
    if (!name->empty()) options->names = {*name};
    return make_reference(*options);
  });
}

}  // namespace airlight::experiments::cli
