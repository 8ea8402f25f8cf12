#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "experiments/application/folders.h"
#include "experiments/application/progress.h"
#include "experiments/application/say.h"
#include "experiments/choosing/choices.h"
#include "experiments/choosing/ranking.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/driver/comparisons.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"

namespace airlight::experiments::cli {
namespace {

struct ChooseOptions {
  std::string scene, budget, error, moves, orders = "all", rows, root, spend = "60s";
  Pairs overrides;
  TrialSetup setup;
};

constexpr std::size_t most_shown = 5;

double number_before(const std::string& text, const std::string& unit) {
  const std::string number = text.ends_with(unit) ? text.substr(0, text.size() - unit.size()) : "";
  char* end = nullptr;
  const double value = std::strtod(number.c_str(), &end);
  return number.empty() || *end != '\0' || !std::isfinite(value) ? -1 : value;
}

// "16ms", "0.5s", "2min": seconds above 0.
double read_duration(const std::string& option, const std::string& text) {
  double seconds = -1;
  for (const auto& [unit, factor] : {std::pair("s", 1.0), std::pair("ms", 1e-3), std::pair("min", 60.0)})
    if (const double value = number_before(text, unit); value > 0) seconds = factor * value;
  if (seconds <= 0)
    throw Error(fmt::format("{} {}: expected a time with its unit, as in 16ms, 0.5s or 2min", option, text));
  return seconds;
}

double read_percent(const std::string& option, const std::string& text) {
  const double value = number_before(text, "%");
  if (value <= 0) throw Error(fmt::format("{} {}: expected a share above 0 with its sign, as in 5%", option, text));
  return value / 100;
}

Moves read_moves(const std::string& text) {
  Moves moves;
  const std::vector<Moving::What> kinds{Moving::What::camera, Moving::What::lights, Moving::What::media};
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    if (word == "light") word = "lights";
    if (word == "medium") word = "media";
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](Moving::What what) { return name_of(what) == word; });
    if (found == kinds.end())
      throw Error(fmt::format("--moves {}: found '{}', expected some of camera, lights, media{}", text, word,
                              scene::nearest_hint(word, {"camera", "lights", "media"})));
    if (std::find(moves.begin(), moves.end(), *found) == moves.end()) moves.push_back(*found);
  }
  return moves;
}

std::string in_words(const Moves& moves) {
  if (moves.empty()) return "a still, prepared from nothing";
  std::vector<std::string> names;
  for (const Moving::What what : moves) names.push_back("the " + name_of(what));
  return fmt::format("a frame after {} moved", fmt::join(names, " and "));
}

std::string figures(const Trial& trial) {
  return fmt::format("error {}, {}", error_text(trial.error), frame_text(trial.times[0], trial.of_film));
}

void print_choice(const ChooseOptions& options, const std::vector<Trial>& trials, const Ranking& ranking,
                  const Goal& goal, const Truth& truth) {
  const std::vector<const Trial*> best = heads(ranking.fit);
  const std::size_t shown = std::min(best.size(), most_shown);
  for (std::size_t i = 0; i < shown; ++i) {
    const Trial& trial = *best[i];
    fmt::print("\n{}. {}: {}\n", i + 1, trial.candidate->name, figures(trial));
    std::vector<std::string> notes;
    if (!trial.left_out.empty()) notes.push_back("leaves out " + trial.left_out);
    if (trial.candidate->convert)
      notes.push_back(fmt::format("the converted density is {:.0f} % off", 100 * trial.density_error));
    if (!notes.empty()) fmt::print("   {}\n", fmt::join(notes, "; "));
    fmt::print("   {}\n", command_line(*trial.candidate, options.scene, options.overrides, options.setup.threads));
  }
  if (ranking.fit.size() > shown)
    fmt::print("\n{} more fit, with {} than the one of their renderer above.\n", ranking.fit.size() - shown,
               goal.seconds ? "a larger error" : "more time");
  const std::vector<const Trial*> better = worth_more(ranking, goal);
  if (!better.empty())
    fmt::print("\n{}:\n", goal.seconds ? "Smaller errors, over the budget" : "Less time, above the error");
  for (const Trial* trial : better) fmt::print("  {}: {}\n", trial->candidate->name, figures(*trial));
  fmt::print("\nHow sure: {}\n", fmt::join(doubts(ranking, goal, truth), " "));
  const auto lines = refusals(trials);
  if (!lines.empty()) fmt::print("\nNot tried:\n");
  for (const std::string& line : lines) fmt::print("  {}\n", line);
}

int choose(const ChooseOptions& options) {
  if (options.budget.empty() == options.error.empty())
    throw Error("expected one of --budget TIME and --error PERCENT; see airlight choose --help");
  Goal goal;
  if (!options.budget.empty()) goal.seconds = read_duration("--budget", options.budget);
  if (!options.error.empty()) goal.error = read_percent("--error", options.error);
  if (options.orders != "all" && options.orders != "one")
    throw Error(fmt::format("--orders {}: expected all or one", options.orders));
  const Moves moves = read_moves(options.moves);
  TrialSetup setup = options.setup;
  setup.all_orders = options.orders == "all";
  setup.spend = read_duration("--spend", options.spend);
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(options.scene, options.overrides));
  const std::string rows = !options.rows.empty() ? options.rows
                           : setup.all_orders    ? rows_of_all_orders
                                                 : rows_of_one_order;
  const Folders folders(project_root(options.root));
  if (choose_experiments(folders.root, {rows}) != std::vector{rows})
    throw Error(fmt::format("--rows {}: expected one experiment, as group/name", rows));
  const std::vector<Candidate> candidates = candidates_of(read_experiment(folders, rows, "quick"));

  Truth truth;
  std::optional<Progress> progress("trying what can render " + scene->name);
  Trials all(scene, setup, {moves}, [&](double share) { progress->update(share); });
  {
    Progress tracing("reference of " + scene->name);
    truth = trace_truth(scene, setup, setup.spend / 3, [&](double share) { tracing.update(share); });
  }
  const std::vector<Trial> trials = all.run(candidates, truth, goal);
  progress.reset();  // clears its line
  if (truth.samples > 0 && truth.samples < setup.samples)
    say(fmt::format("--samples {}: {} took a third of the time to spend ({})", setup.samples, truth.samples,
                    options.spend));
  const scene::View &small = truth.sparse.small, &whole = truth.sparse.whole;
  fmt::print("{}, {}x{} pixels: {}, {}\n", scene->name, whole.width, whole.height, in_words(moves),
             goal.seconds ? "within " + options.budget : "with an error of at most " + options.error);
  fmt::print("Errors: relative L2 at {}x{} of the pixels, by {}.\n", small.width, small.height, truth.about);
  if (all.waited() > much_waiting)
    say(fmt::format(
        "threads waited for a processor for {:.0f} % of their time: without other programs frames take less",
        100 * all.waited()));
  print_choice(options, trials, rank(trials, goal), goal, truth);
  return 0;
}

}  // namespace

void add_choose(Commands& commands) {
  const auto options = std::make_shared<ChooseOptions>();
  CLI::App* c =
      add_command(commands.app, "choose", "try all methods on a scene and rank them within a time or an error");
  c->add_option("SCENE", options->scene, "scene file");
  c->add_option("--budget", options->budget,
                "time that a frame may take, e.g. 16ms; ranks by error (this or --error is required)");
  c->add_option("--error", options->error,
                "relative L2 error that a picture may have, e.g. 5%; ranks by time (this or --budget is required)");
  c->add_option(
      "--moves", options->moves,
      "what moves from frame to frame: some of camera, lights, media, with commas between them (default: nothing; a "
      "still is converted, prepared and rendered)");
  c->add_option("--orders", options->orders, "orders of scattering in the reference: all, or one (default all)");
  c->add_option(
      "--rows", options->rows,
      "experiment whose [[method]] rows are tried (default common/all_orders, or common/one_order with --orders one)");
  c->add_option("--film", options->setup.film, "pixels along a row of the sparse reference, about (default 64)")
      ->check(CLI::Range(8, 65536));
  c->add_option("--samples", options->setup.samples, "samples per pixel of a path-traced reference (default 256)")
      ->check(CLI::Range(64LL, 1LL << 30));
  c->add_option("--spend", options->spend,
                "time for all trials (default 60s); methods that do not fit into it are named");
  c->add_option("--threads", options->setup.threads, "number of threads (default 0: all)")->check(CLI::Range(0, 4096));
  c->add_option("--root", options->root, "project folder (default: above the current folder, or above the program)");
  add_pairs(c, "--override", options->overrides, "change a value of the scene file, e.g. film.width=64");
  commands.add_limit(c);
  commands.add_data(c);
  commands.add_gpu(c);
  commands.add_unchecked(c);
  commands.on(c, [options] {
    require(options->scene, "SCENE");
    return choose(*options);
  });
}

}  // namespace airlight::experiments::cli
