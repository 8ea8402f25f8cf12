#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/application/folders.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/driver/export.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"

namespace airlight::experiments::cli {
namespace {

struct ResultsOptions {
  std::vector<std::string> names, metrics, scenes, methods;
  std::string root, results, profile, format = "csv", out;
};

const std::vector<std::string> formats{"csv", "jsonl", "latex", "pgfplots"};

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// Records of the named experiments and groups, of the profile that was asked for.
std::vector<std::string> choose_records(const ResultsOptions& options, const std::filesystem::path& results) {
  const auto all = record_names(results);
  std::vector<std::string> words = all, chosen;
  for (const std::string& name : all) {
    const bool paper = name.ends_with(".paper");
    const std::string id = paper ? name.substr(0, name.size() - 6) : name;
    words.push_back(id);
    const bool named = std::any_of(options.names.begin(), options.names.end(), [&](const std::string& word) {
      return word == name || word == id || name.starts_with(word + "/");
    });
    if ((options.names.empty() || named) && (options.profile.empty() || (options.profile == "paper") == paper))
      chosen.push_back(name);
  }
  for (const std::string& word : options.names)
    if (std::none_of(words.begin(), words.end(),
                     [&](const std::string& name) { return name == word || name.starts_with(word + "/"); }))
      throw Error(fmt::format("no record '{}' below {}{}; airlight experiment run NAME writes one", word,
                              results.string(), scene::nearest_hint(word, words)));
  if (chosen.empty())
    throw Error(fmt::format("no records of profile {} below {}: `airlight experiment run NAME` writes them",
                            options.profile.empty() ? "quick or paper" : options.profile, results.string()));
  return chosen;
}

// Throws Error, with the nearest, for a word that no record has.
void check_words(const std::string& option, const std::vector<std::string>& words,
                 const std::vector<std::string>& there) {
  for (const std::string& word : words)
    if (!contains(there, word))
      throw Error(
          fmt::format("{} '{}': no row of these records has it{}", option, word, scene::nearest_hint(word, there)));
}

void keep_rows(const ResultsOptions& options, std::vector<RecordedRun>& runs) {
  std::vector<std::string> scenes, methods, metrics;
  const auto add = [](std::vector<std::string>& list, const std::string& word) {
    if (!contains(list, word)) list.push_back(word);
  };
  for (const RecordedRun& run : runs)
    for (const Row& row : run.rows) {
      add(scenes, row.scene);
      add(methods, row.method);
      for (const RecordedFigure& figure : figures(row, {})) add(metrics, figure.metric);
    }
  check_words("--scene", options.scenes, scenes);
  check_words("--method", options.methods, methods);
  check_words("--metric", options.metrics, metrics);
  for (RecordedRun& run : runs)
    std::erase_if(run.rows, [&](const Row& row) {
      return (!options.scenes.empty() && !contains(options.scenes, row.scene)) ||
             (!options.methods.empty() && !contains(options.methods, row.method));
    });
  std::erase_if(runs, [](const RecordedRun& run) { return run.rows.empty(); });
}

std::string plots_of(const Folders& folders, const std::vector<RecordedRun>& runs) {
  std::string out;
  for (const RecordedRun& run : runs) {
    if (run.plots == 0) continue;
    Outcome outcome;
    outcome.experiment = read_experiment(folders, run.experiment, run.profile);
    outcome.rows = run.rows;
    out += pgfplots(outcome, run);
  }
  if (out.empty()) throw Error("these records have no plots; expected an experiment with [[plot]]");
  return out;
}

int write_results(const ResultsOptions& options) {
  if (!contains(formats, options.format))
    throw Error(fmt::format("--format '{}': expected one of {}{}", options.format, fmt::join(formats, ", "),
                            scene::nearest_hint(options.format, formats)));
  if (!options.profile.empty() && options.profile != "quick" && options.profile != "paper")
    throw Error(fmt::format("--profile '{}': expected quick or paper", options.profile));
  if (options.format == "pgfplots" && !options.metrics.empty())
    throw Error("--metric: plots have the axes of their experiment; expected --format csv, jsonl or latex");
  const Folders folders{project_root(options.root), options.results};
  std::vector<RecordedRun> runs;
  for (const std::string& name : choose_records(options, folders.results))
    runs.push_back(read_run(folders.results, name));
  keep_rows(options, runs);
  std::string text;
  if (options.format == "csv") text = long_csv(runs, options.metrics);
  if (options.format == "jsonl") text = long_jsonl(runs, options.metrics);
  if (options.format == "pgfplots") text = plots_of(folders, runs);
  if (options.format == "latex")
    for (const RecordedRun& run : runs) text += latex_table(run, options.metrics);
  if (options.out.empty())
    fmt::print("{}", text);
  else
    scene::write_file_atomically(options.out, text);
  return 0;
}

}  // namespace

void add_results(Commands& commands) {
  const auto options = std::make_shared<ResultsOptions>();
  CLI::App* c = add_command(commands.app, "results", "print figures of finished experiments for papers and notebooks");
  c->add_option("NAME", options->names, "experiments: group/name, or a whole group (default: all that have a record)");
  c->add_option("--format", options->format,
                "csv (default): a line for each figure, a column for each setting; jsonl: these lines as JSON; latex: "
                "a table for each experiment (booktabs, siunitx); pgfplots: a picture for each plot");
  c->add_option("--metric", options->metrics,
                "only these figures, e.g. rel_l2, seconds, camera_seconds, counter.rays (default: all; latex: the "
                "first error and the time of one render)")
      ->type_name("NAME");
  c->add_option("--scene", options->scenes, "only rows of these scenes (default: all)")->type_name("NAME");
  c->add_option("--method", options->methods, "only rows of these methods (default: all)")->type_name("NAME");
  c->add_option("--profile", options->profile, "only records of this profile: quick or paper (default: both)");
  c->add_option("--results", options->results, "folder of the records (default: results/ of the project)")
      ->type_name("FOLDER");
  c->add_option("--root", options->root,
                "folder of the project (default: found above the current folder, else above the program)")
      ->type_name("FOLDER");
  c->add_option("-o,--out", options->out, "write this file (default: standard output)")->type_name("FILE");
  commands.on(c, [options] { return write_results(*options); });
}

}  // namespace airlight::experiments::cli
