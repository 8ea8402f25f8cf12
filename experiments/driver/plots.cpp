#include "experiments/driver/plots.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "experiments/application/folders.h"
#include "experiments/application/say.h"
#include "experiments/driver/pictures.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/printable.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

struct PlotPoint {
  Estimate x, y;
  bool bound = false;  // below the noise floor: only y.high is known
};

struct Curve {
  std::string name;
  std::vector<PlotPoint> points;
};

const Measure* measure_of(const Row& row, const std::string& name) {
  for (const Measure& m : row.measures)
    if (m.name == name) return &m;
  return nullptr;
}

struct Drawing {
  std::vector<Curve> curves;
  double floor = 0;
};

bool is_column(const std::string& axis) { return axis.starts_with("column."); }

// A curve of two columns of a row: all its points, in their order.
std::optional<Curve> curve_of_columns(const Row& row, const PlotCase& plot, const std::string& scene) {
  const auto x = row.columns.find(plot.x.substr(7)), y = row.columns.find(plot.y.substr(7));
  if (x == row.columns.end() || y == row.columns.end()) return std::nullopt;
  Curve curve{row.setting.empty() ? row.method : row.method + " " + row.setting, {}};
  if (scene.empty() && !row.scene.empty()) curve.name += ", " + row.scene;
  for (std::size_t i = 0; i < x->second.size(); ++i) {
    const double px = x->second[i], py = y->second[i];
    if (std::isfinite(px) && std::isfinite(py)) curve.points.push_back({{px, px, px}, {py, py, py}, false});
  }
  if (curve.points.empty()) return std::nullopt;
  return curve;
}

Drawing collect_columns(const Outcome& outcome, const PlotCase& plot, const std::string& scene) {
  Drawing drawing;
  for (const std::vector<Row>* rows : {&outcome.rows, &outcome.histories})
    for (const Row& row : *rows) {
      const bool wanted =
          plot.methods.empty() || std::find(plot.methods.begin(), plot.methods.end(), row.method) != plot.methods.end();
      if (!wanted || (!scene.empty() && row.scene != scene)) continue;
      if (auto curve = curve_of_columns(row, plot, scene)) drawing.curves.push_back(std::move(*curve));
    }
  return drawing;
}

Drawing collect(const Outcome& outcome, const PlotCase& plot, const std::string& scene) {
  if (is_column(plot.x)) return collect_columns(outcome, plot, scene);
  Drawing drawing;
  for (const Row& row : outcome.rows) {
    if (!scene.empty() && row.scene != scene) continue;
    if (!plot.methods.empty() && std::find(plot.methods.begin(), plot.methods.end(), row.method) == plot.methods.end())
      continue;
    const auto x = quantity(row, plot.x), y = quantity(row, plot.y);
    if (!x || !y || !(x->value > 0)) continue;
    PlotPoint point{*x, *y, false};
    if (const Measure* m = measure_of(row, plot.y)) {
      // The noise floor of the reference alone: the least noisy image shows it.
      if (m->floor > 0) drawing.floor = drawing.floor > 0 ? std::min(drawing.floor, m->floor) : m->floor;
      point.bound = m->below_floor;
      if (plot.y == "bias" || plot.y.find(".bias") != std::string::npos) {
        // Signed: its size is drawn.
        point.y = {std::abs(y->value), std::min(std::abs(y->low), std::abs(y->high)),
                   std::max(std::abs(y->low), std::abs(y->high))};
      }
    }
    if (!(point.bound ? point.y.high > 0 : point.y.value > 0)) continue;
    std::string name = row.method;
    if (plot.x == "parameter" && !row.setting.empty()) name += " " + row.setting;
    if (scene.empty() && plot.x != "parameter" && !row.scene.empty()) name += ", " + row.scene;
    auto curve =
        std::find_if(drawing.curves.begin(), drawing.curves.end(), [&](const Curve& c) { return c.name == name; });
    if (curve == drawing.curves.end()) curve = drawing.curves.insert(curve, {name, {}});
    curve->points.push_back(point);
  }
  // Against time a curve runs through the settings in their order.
  if (plot.x.ends_with("seconds")) return drawing;
  for (Curve& curve : drawing.curves)
    std::stable_sort(curve.points.begin(), curve.points.end(),
                     [](const PlotPoint& a, const PlotPoint& b) { return a.x.value < b.x.value; });
  return drawing;
}

// Blocks separated by two empty lines, as gnuplot counts them: per curve its values, then its upper bounds.
std::string data_csv(const Drawing& drawing) {
  std::string out = "# curve,x,x_low,x_high,y,y_low,y_high,floor\n";
  for (const Curve& curve : drawing.curves)
    for (const bool bound : {false, true}) {
      bool empty = true;
      for (const PlotPoint& p : curve.points) {
        if (p.bound != bound) continue;
        empty = false;
        const double y = bound ? p.y.high : p.y.value;
        // On a logarithmic axis an interval that reaches 0 ends a decade below its value.
        const double low = bound || !(y > 0) ? y : std::max(p.y.low, 0.1 * y);
        out += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", csv_field(curve.name), p.x.value,
                           p.x.low, p.x.high, y, low, p.y.high, drawing.floor);
      }
      if (empty) out += csv_field(curve.name) + ",,,,,,,\n";
      out += "\n\n";
    }
  return out;
}

std::string axis_label(const std::string& given, const std::string& axis) {
  if (!given.empty()) return given;
  if (axis == "seconds") return "time of one render [s]";
  if (axis == "prepare_seconds") return "time of preparation [s]";
  if (axis == "total_seconds") return "time of preparation and one render [s]";
  if (axis == "camera_seconds") return "time of a frame after the camera moved [s]";
  if (axis == "lights_seconds") return "time of a frame after lights moved [s]";
  if (axis == "media_seconds") return "time of a frame after media moved [s]";
  if (is_column(axis)) return axis.substr(7);
  return axis.starts_with("counter.") ? axis.substr(8) : axis;
}

// The range of an axis: logarithmic where values are positive and span a factor of 4, with some room at both ends.
struct Span {
  bool linear = false;
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
  void add(double value) {
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  std::string axis(const std::string& name) const {
    if (linear || !(least > 0)) {
      const double room = greatest > least ? 0.03 * (greatest - least) : 1;
      return fmt::format("set {}range [{:.6g}:{:.6g}]\n", name, least - room, greatest + room);
    }
    if (greatest <= 4 * least) return fmt::format("set {}range [0:{:.6g}]\n", name, 1.15 * greatest);
    const double room = std::pow(greatest / least, 0.06);
    return fmt::format("set logscale {0}\nset format {0} \"%g\"\nset {0}range [{1:.6g}:{2:.6g}]\n", name, least / room,
                       greatest * room);
  }
};

std::string script(const PlotCase& plot, const std::string& title, const std::string& name, const Drawing& drawing) {
  // Colours that the colour-blind tell apart (Okabe and Ito).
  static const char* colors[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00",
                                 "#56B4E9", "#000000", "#7F3C8D", "#80BA5A", "#A5AA99"};
  static const int shapes[] = {7, 5, 9, 13, 11, 6, 4, 8, 12, 15};
  Span x, y;
  x.linear = is_column(plot.x);
  for (const Curve& curve : drawing.curves)
    for (const PlotPoint& p : curve.points) {
      x.add(p.x.value);
      y.add(p.bound ? p.y.high : p.y.value);
    }
  if (drawing.floor > 0) y.add(drawing.floor);
  std::string lines;
  const auto add = [&](const std::string& text) { lines += (lines.empty() ? "" : ", \\\n     ") + text; };
  for (std::size_t i = 0; i < drawing.curves.size(); ++i) {
    const std::string style = fmt::format("lc rgb \"{}\" pt {} ps 0.7 lw 1.6", colors[i % 10], shapes[i % 10]);
    const bool dense = drawing.curves[i].points.size() > 40;
    add(fmt::format("data index {} using 2:5 with {} {} title {}", 2 * i, dense ? "lines" : "linespoints", style,
                    gnuplot_text(drawing.curves[i].name)));
    if (!is_column(plot.x))
      add(fmt::format("data index {} using 2:5:3:4:6:7 with xyerrorbars lc rgb \"{}\" pt 0 lw 0.8 notitle", 2 * i,
                      colors[i % 10]));
    const auto& points = drawing.curves[i].points;
    if (std::any_of(points.begin(), points.end(), [](const PlotPoint& p) { return p.bound; }))
      add(fmt::format("data index {} using 2:5 with points lc rgb \"{}\" pt 10 ps 0.9 notitle", 2 * i + 1,
                      colors[i % 10]));
  }
  if (drawing.floor > 0)
    add(fmt::format("{:.6g} with lines dt 2 lw 1 lc rgb \"#888888\" title \"noise floor\"", drawing.floor));
  return fmt::format(
      "# Draws {0}.svg from {0}.csv: run gnuplot on this file in its folder.\n"
      "data = \"{0}.csv\"\n"
      "set datafile separator comma\n"
      "set title {1} noenhanced\nset xlabel {2} noenhanced\nset ylabel {3} noenhanced\n"
      "set key outside right center vertical Left reverse noenhanced\n"
      "set grid xtics ytics lt 1 lw 0.5 lc rgb \"#cccccc\"\nset border 3 lc rgb \"#444444\"\nset tics nomirror\n"
      "{4}{5}set terminal svg size 820,440 dynamic font \"sans-serif,13\"\nset output \"{0}.svg\"\nplot {6}\n",
      name, gnuplot_text(title), gnuplot_text(axis_label(plot.x_label, plot.x)),
      gnuplot_text(axis_label(plot.y_label, plot.y)), x.axis("x"), y.axis("y"), lines);
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

std::vector<PlotFile> draw_plots(const Outcome& outcome, const fs::path& folder) {
  const fs::path plots = folder / "plots";
  std::vector<PlotFile> drawn;
  std::vector<std::string> scripts;
  fs::remove_all(plots);
  for (const PlotCase& plot : outcome.experiment.plots) {
    if (plot.map) {
      if (!write_map_plot(outcome.rows, plot, plots)) continue;
      scripts.push_back(plot_name(plot, "") + ".gp");
      drawn.push_back({"plots/" + plot_name(plot, "") + ".svg", plot.title});
      continue;
    }
    std::vector<std::string> scenes;
    if (plot.per_scene) {
      for (const Row& row : outcome.rows)
        if (std::find(scenes.begin(), scenes.end(), row.scene) == scenes.end()) scenes.push_back(row.scene);
    } else {
      scenes = {""};
    }
    for (const std::string& scene : scenes) {
      const Drawing drawing = collect(outcome, plot, scene);
      if (drawing.curves.empty()) continue;
      const std::string name = plot_name(plot, scene);
      const std::string what = !plot.title.empty() ? plot.title
                                                   : fmt::format("{} against {}", axis_label(plot.y_label, plot.y),
                                                                 axis_label(plot.x_label, plot.x));
      const std::string title = scene.empty() ? what : what + ": " + scene;
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

}  // namespace airlight::experiments
