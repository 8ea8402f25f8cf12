#include "experiments/driver/drawing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

#include "experiments/driver/tables.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

const Measure* measure_of(const Row& row, const std::string& name) {
  for (const Measure& m : row.measures)
    if (m.name == name) return &m;
  return nullptr;
}

// One curve from two columns of a row, its points in their order.
std::optional<PlotCurve> curve_of_columns(const Row& row, const PlotCase& plot, const std::string& scene) {
  const auto x = row.columns.find(plot.x.substr(7)), y = row.columns.find(plot.y.substr(7));
  if (x == row.columns.end() || y == row.columns.end()) return std::nullopt;
  PlotCurve curve{row.setting.empty() ? row.method : row.method + " " + row.setting, {}};
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

}  // namespace

std::string with_device(std::string method, const std::string& device) {
  const auto at = method.rfind("GPU");
  if (at != std::string::npos && is_processor(device)) method.replace(at, 3, "llvmpipe (CPU)");
  return method;
}

bool is_column(const std::string& axis) { return axis.starts_with("column."); }

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
        std::find_if(drawing.curves.begin(), drawing.curves.end(), [&](const PlotCurve& c) { return c.name == name; });
    if (curve == drawing.curves.end()) curve = drawing.curves.insert(curve, {name, {}});
    curve->points.push_back(point);
  }
  // Against time a curve runs through the settings in their order.
  if (plot.x.ends_with("seconds")) return drawing;
  for (PlotCurve& curve : drawing.curves)
    std::stable_sort(curve.points.begin(), curve.points.end(),
                     [](const PlotPoint& a, const PlotPoint& b) { return a.x.value < b.x.value; });
  return drawing;
}

std::string data_csv(const Drawing& drawing) {
  std::string out = "# curve,x,x_low,x_high,y,y_low,y_high,floor\n";
  for (const PlotCurve& curve : drawing.curves)
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

Axis::Axis(std::string name, std::vector<double> values, bool linear) : name_(std::move(name)) {
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

std::string Axis::commands() const {
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

std::string Axis::column(int number) const {
  return logarithmic_ ? fmt::format("(${0} > {1:.6g} ? ${0} : {1:.6g})", number, low_) : fmt::format("{}", number);
}

std::string plot_title(const PlotCase& plot, const std::string& scene) {
  const std::string what = !plot.title.empty() ? plot.title
                                               : fmt::format("{} against {}", axis_label(plot.y_label, plot.y),
                                                             axis_label(plot.x_label, plot.x));
  return scene.empty() ? what : what + ": " + scene;
}

std::vector<std::string> plot_scenes(const Outcome& outcome, const PlotCase& plot) {
  if (!plot.per_scene) return {""};
  std::vector<std::string> scenes;
  for (const Row& row : outcome.rows)
    if (std::find(scenes.begin(), scenes.end(), row.scene) == scenes.end()) scenes.push_back(row.scene);
  return scenes;
}

Axes axes_of(const Drawing& drawing, const PlotCase& plot) {
  std::vector<double> xs, ys;
  for (const PlotCurve& curve : drawing.curves)
    for (const PlotPoint& p : curve.points) {
      xs.push_back(p.x.value);
      ys.push_back(p.bound ? p.y.high : p.y.value);
    }
  if (drawing.floor > 0) ys.push_back(drawing.floor);
  return {Axis("x", xs, is_column(plot.x)), Axis("y", ys, false)};
}

}  // namespace airlight::experiments
