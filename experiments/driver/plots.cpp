#include "experiments/driver/plots.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>

#include "experiments/application/folders.h"
#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
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

// The name of a method with the device that it ran on: a software renderer is no GPU.
std::string with_device(std::string method, const std::string& device) {
  const auto at = method.rfind("GPU");
  if (at != std::string::npos && is_processor(device)) method.replace(at, 3, "llvmpipe (CPU)");
  return method;
}

// One curve from two columns of a row, its points in their order.
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
    if (!x || !y || !std::isfinite(x->value) || !std::isfinite(y->value)) continue;
    PlotPoint point{*x, *y, false};
    if (const Measure* m = measure_of(row, plot.y)) {
      // Noise of the reference alone: the picture with the least noise shows it.
      if (m->floor > 0) drawing.floor = drawing.floor > 0 ? std::min(drawing.floor, m->floor) : m->floor;
      point.bound = m->below_floor;
      if (plot.y == "bias" || plot.y.find(".bias") != std::string::npos) {
        // A bias has a sign. Its absolute value is drawn.
        point.y = {std::abs(y->value), std::min(std::abs(y->low), std::abs(y->high)),
                   std::max(std::abs(y->low), std::abs(y->high))};
      }
    }
    std::string name = with_device(row.method, row.device);
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
        const double low = bound ? y : p.y.low;
        out += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", csv_field(curve.name), p.x.value,
                           p.x.low, p.x.high, y, low, p.y.high, drawing.floor);
      }
      if (empty) out += csv_field(curve.name) + ",,,,,,,\n";
      out += "\n\n";
    }
  return out;
}

// The curves of a data file that data_csv wrote, without their intervals: a record holds no columns.
Drawing read_data(const fs::path& file) {
  Drawing drawing;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const bool quoted = line.starts_with('"');
    const auto end = line.find(quoted ? "\"," : ",", 1);
    double x = 0, y = 0;
    if (line.starts_with('#') || end == std::string::npos ||
        std::sscanf(line.c_str() + end + quoted, ",%lf,%*f,%*f,%lf", &x, &y) != 2)
      continue;
    const std::string name = line.substr(quoted, end - quoted);
    if (drawing.curves.empty() || drawing.curves.back().name != name) drawing.curves.push_back({name, {}});
    drawing.curves.back().points.push_back({{x, x, x}, {y, y, y}, false});
  }
  return drawing;
}

std::string axis_label(const std::string& given, const std::string& axis) {
  if (!given.empty()) return given;
  static const std::map<std::string, std::string> labels = {
      {"seconds", "time of one render [s]"},
      {"prepare_seconds", "time of preparation [s]"},
      {"total_seconds", "time of preparation and one render [s]"},
      {"camera_seconds", "time of a frame after the camera moved [s]"},
      {"lights_seconds", "time of a frame after lights moved [s]"},
      {"media_seconds", "time of a frame after media moved [s]"},
      {"rel_l2", "relative L2 error"},
      {"rmse", "RMS error"},
      {"bias", "absolute value of the bias"},
      {"p95", "95th percentile of the error"},
      {"p99", "99th percentile of the error"},
      {"p999", "99.9th percentile of the error"},
  };
  if (const auto found = labels.find(axis); found != labels.end()) return found->second;
  if (axis.ends_with(".rel_l2")) return "relative L2 error of the " + axis.substr(0, axis.size() - 7);
  std::string name = axis.substr(is_column(axis) ? 7 : axis.starts_with("counter.") ? 8 : 0);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

// An axis that shows all its values. It is logarithmic where positive values span a factor of 4, or of 20 if there are
// values of 0, which then stand at its lower edge. With negative values it is linear.
class Axis {
 public:
  Axis(std::string name, std::vector<double> values, bool linear) : name_(std::move(name)) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) values = {0};
    const auto [lowest, greatest] = std::minmax_element(values.begin(), values.end());
    double least = std::numeric_limits<double>::infinity();  // of the positive values
    for (const double v : values)
      if (v > 0) least = std::min(least, v);
    const bool zeros = *lowest == 0;
    if (linear || *lowest < 0 || !(*greatest > 0)) {
      const double room = *greatest > *lowest ? 0.03 * (*greatest - *lowest) : 1;
      low_ = *lowest == 0 ? 0 : *lowest - room;
      high_ = *greatest + room;
    } else if (*greatest <= (zeros ? 20 : 4) * least) {
      low_ = 0;
      high_ = 1.15 * *greatest;
    } else {
      const double room = std::pow(*greatest / least, 0.06);
      logarithmic_ = true;
      zeros_ = zeros;
      low_ = least / (zeros ? room * room * room : room);
      high_ = *greatest * room;
    }
  }
  std::string commands() const {
    std::string out;
    if (logarithmic_) out += fmt::format("set logscale {0}\nset format {0} \"%g\"\n", name_);
    if (logarithmic_ && high_ < 200 * low_) {  // decades alone would be one label or none
      std::vector<std::string> ticks;
      for (double decade = std::pow(10, std::floor(std::log10(low_))); decade < high_; decade *= 10)
        for (const double tick : {decade, 2 * decade, 5 * decade})
          if (tick >= low_ && tick <= high_) ticks.push_back(fmt::format("{:.6g}", tick));
      out += fmt::format("set {}tics ({})\n", name_, fmt::join(ticks, ", "));
    }
    if (zeros_) out += fmt::format("set {}tics add (\"0\" {:.6g})\n", name_, low_);
    return out + fmt::format("set {}range [{:.6g}:{:.6g}]\n", name_, low_, high_);
  }
  // The gnuplot expression of a column of the data. What a logarithmic axis cannot show stands at its lower edge.
  std::string column(int number) const {
    return logarithmic_ ? fmt::format("(${0} > {1:.6g} ? ${0} : {1:.6g})", number, low_) : fmt::format("{}", number);
  }

 private:
  std::string name_;
  bool logarithmic_ = false, zeros_ = false;
  double low_ = 0, high_ = 1;
};

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
  std::vector<double> xs, ys;
  std::size_t widest = 12;
  for (const Curve& curve : drawing.curves) {
    widest = std::max(widest, curve.name.size());
    for (const PlotPoint& p : curve.points) {
      xs.push_back(p.x.value);
      ys.push_back(p.bound ? p.y.high : p.y.value);
    }
  }
  if (drawing.floor > 0) ys.push_back(drawing.floor);
  const Axis x("x", xs, is_column(plot.x)), y("y", ys, false);
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
    std::vector<std::string> scenes;
    if (plot.per_scene) {
      for (const Row& row : outcome.rows)
        if (std::find(scenes.begin(), scenes.end(), row.scene) == scenes.end()) scenes.push_back(row.scene);
    } else {
      scenes = {""};
    }
    for (const std::string& scene : scenes) {
      const std::string name = plot_name(plot, scene);
      Drawing drawing = collect(outcome, plot, scene);
      if (is_column(plot.x) && drawing.curves.empty()) drawing = read_data(plots / (name + ".csv"));
      if (drawing.curves.empty()) continue;
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
