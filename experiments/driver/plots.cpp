#include "experiments/driver/plots.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "experiments/application/folders.h"
#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/application/say.h"
#include "experiments/driver/drawing.h"
#include "experiments/driver/pictures.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/printable.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

// The title in lines that fit the drawing.
std::string title_lines(const std::string& title) {
  constexpr std::size_t widest = 88;
  if (title.size() <= widest) return gnuplot_text(title);
  const auto cut = title.rfind(' ', widest);
  if (cut == std::string::npos) return gnuplot_text(title);
  return gnuplot_text(title.substr(0, cut)) + ".\"\\n\"." + title_lines(title.substr(cut + 1));
}

std::string script(const PlotCase& plot, const std::string& title, const std::string& name, const Drawing& drawing) {
  // Colours that colour-blind readers can tell apart (Okabe and Ito). More curves than colours differ in dash and mark.
  static const char* colors[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00",
                                 "#56B4E9", "#000000", "#7F3C8D", "#80BA5A", "#A5AA99"};
  static const int shapes[] = {7, 5, 9, 13, 11, 6, 4, 8, 12, 15};
  std::size_t widest = 12;
  for (const PlotCurve& curve : drawing.curves) widest = std::max(widest, curve.name.size());
  const auto [x, y] = axes_of(drawing, plot);
  std::string lines;
  const auto add = [&](const std::string& text) { lines += (lines.empty() ? "" : ", \\\n     ") + text; };
  for (std::size_t i = 0; i < drawing.curves.size(); ++i) {
    const std::size_t round = i / 10;
    const std::string style = fmt::format("lc rgb \"{}\" dt {} pt {} ps 0.7 lw 1.6", colors[i % 10], round + 1,
                                          shapes[(i + 5 * (round % 2) + round / 2) % 10]);
    const bool dense = drawing.curves[i].points.size() > 40;
    const std::string point = x.column(2) + ":" + y.column(5);
    add(fmt::format("data index {} using {} with {} {} title {}", 2 * i, point, dense ? "lines" : "linespoints", style,
                    gnuplot_text(drawing.curves[i].name)));
    if (!is_column(plot.x))
      add(fmt::format("data index {} using {}:{}:{}:{}:{} with xyerrorbars lc rgb \"{}\" pt 0 lw 0.8 notitle", 2 * i,
                      point, x.column(3), x.column(4), y.column(6), y.column(7), colors[i % 10]));
    const auto& points = drawing.curves[i].points;
    if (std::any_of(points.begin(), points.end(), [](const PlotPoint& p) { return p.bound; }))
      add(fmt::format("data index {} using {} with points lc rgb \"{}\" pt 10 ps 0.9 notitle", 2 * i + 1, point,
                      colors[i % 10]));
  }
  if (drawing.floor > 0)
    add(fmt::format("{:.6g} with lines dt 2 lw 1 lc rgb \"#888888\" title \"noise floor\"", drawing.floor));
  // The key stands below, so that the drawing stays wide where a page shows two of them side by side.
  const std::size_t columns = std::clamp<std::size_t>(620 / (9 * widest + 60), 1, 4);
  const std::size_t entries = drawing.curves.size() + (drawing.floor > 0);
  const std::size_t key_rows = (entries + columns - 1) / columns;
  const std::size_t height = 390 + 20 * key_rows;
  return fmt::format(
      "# Draws {0}.svg from {0}.csv: run gnuplot on this file in its folder.\n"
      "data = \"{0}.csv\"\n"
      "set datafile separator comma\n"
      "set title {1} noenhanced\nset xlabel {2} noenhanced\nset ylabel {3} noenhanced\n"
      "set key outside below center vertical maxrows {4} samplen 3 height 0.6 Left reverse noenhanced\n"
      "set grid xtics ytics lt 1 lw 0.5 lc rgb \"#cccccc\"\nset border 3 lc rgb \"#444444\"\nset tics nomirror\n"
      "{5}{6}set terminal svg size 640,{7} dynamic font \"sans-serif,13\"\nset output \"{0}.svg\"\nplot {8}\n",
      name, title_lines(title), gnuplot_text(axis_label(plot.x_label, plot.x)),
      gnuplot_text(axis_label(plot.y_label, plot.y)), key_rows, x.commands(), y.commands(), height, lines);
}

// Runs a program in a folder, without a shell, and returns its exit status. Its output goes to a new file.
int exit_status(const fs::path& folder, const fs::path& log, std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int failure = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw Error(fmt::format("{}: cannot be run: {}", words[0], std::strerror(failure)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::string plot_name(const PlotCase& plot, const std::string& scene) {
  return file_name(scene.empty() ? plot.name : plot.name + "." + scene);
}

std::string gnuplot_text(std::string_view text) {
  // A quote stands apart: gnuplot 5.4 takes two of them at the beginning for the end.
  std::string quoted = "'";
  for (const char c : scene::printable(text)) quoted += c == '\'' ? R"('."'".')" : std::string(1, c);
  return quoted + "'";
}

bool has_gnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

void run_gnuplot(const fs::path& folder, const std::vector<std::string>& scripts) {
  if (!has_gnuplot()) throw Unavailable("gnuplot is not installed: no plots (Debian: gnuplot-nox)");
  for (const std::string& name : scripts) {
    const fs::path script = folder / name, log = folder / (name + ".log");
    // gnuplot would write through a link that has one of these names.
    for (const fs::path& written : {log, fs::path(script).replace_extension("svg")}) fs::remove(written);
    if (exit_status(folder, log, {"gnuplot", name}) != 0)
      throw Error(fmt::format("gnuplot failed on {}; see {}", script.string(), log.string()));
    fs::remove(log);
  }
}

namespace {

// Draws what the outcome or, for columns and maps, the files in `plots` have data for.
std::vector<PlotFile> draw(const Outcome& outcome, const fs::path& plots) {
  std::vector<PlotFile> drawn;
  std::vector<std::string> scripts;
  for (const PlotCase& plot : outcome.experiment.plots) {
    if (plot.map) {
      const std::string name = plot_name(plot, "");
      if (!write_map_plot(outcome.rows, plot, plots) && !fs::exists(plots / (name + ".gp"))) continue;
      scripts.push_back(name + ".gp");
      drawn.push_back({"plots/" + name + ".svg", plot.title});
      continue;
    }
    for (const std::string& scene : plot_scenes(outcome, plot)) {
      const std::string name = plot_name(plot, scene);
      Drawing drawing = collect(outcome, plot, scene);
      if (is_column(plot.x) && drawing.curves.empty()) drawing = read_data(plots / (name + ".csv"));
      if (drawing.curves.empty()) continue;
      const std::string title = plot_title(plot, scene);
      make_folder(plots);
      scene::write_file_atomically((plots / (name + ".csv")).string(), data_csv(drawing));
      scene::write_file_atomically((plots / (name + ".gp")).string(), script(plot, title, name, drawing));
      scripts.push_back(name + ".gp");
      drawn.push_back({"plots/" + name + ".svg", title});
    }
  }
  if (scripts.empty()) return {};
  if (!has_gnuplot()) {
    say("gnuplot is not installed: no plots (Debian: gnuplot-nox)");
    return {};
  }
  run_gnuplot(plots, scripts);
  return drawn;
}

}  // namespace

std::vector<PlotFile> draw_plots(const Outcome& outcome, const fs::path& folder) {
  fs::remove_all(folder / "plots");
  return draw(outcome, folder / "plots");
}

std::size_t redraw_plots(const Experiment& experiment, const fs::path& folder) {
  if (!fs::exists(folder / "run.json")) return 0;
  const nlohmann::json record = read_json((folder / "run.json").string());
  Outcome outcome;
  outcome.experiment = experiment;
  for (const nlohmann::json& row : record.at("rows")) outcome.rows.push_back(row_from_json(row));
  return draw(outcome, folder / "plots").size();
}

}  // namespace airlight::experiments
