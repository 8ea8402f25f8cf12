// Records of runs as tables and plots of a LaTeX document.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "experiments/driver/drawing.h"
#include "experiments/driver/export.h"
#include "experiments/driver/plots.h"

namespace airlight::experiments {
namespace {

bool is_timing(const std::string& metric) {
  static const std::set<std::string> times{"seconds", "prepare_seconds", "camera_seconds", "lights_seconds",
                                           "media_seconds"};
  return times.contains(metric);
}

// An error, of a picture or a flow, or a time: the smaller the better. Not so the figures of probes.
bool has_best(const std::string& metric) {
  static const std::set<std::string> errors{"rmse", "rel_l2", "rel_l2_squared", "rmse_range", "rel_mse", "bias",
                                            "p95",  "p99",    "p999",           "wrong",      "flip"};
  if (is_timing(metric)) return true;
  std::istringstream parts(metric.substr(0, metric.find('@')));
  for (std::string part; std::getline(parts, part, '.');)
    if (errors.contains(part)) return true;
  return metric.ends_with(".greatest");
}

// What two values are compared by. Below noise only the upper end of the interval is known.
double rank_of(const RecordedFigure& figure) {
  return figure.below ? std::max(std::abs(figure.value.low), std::abs(figure.value.high))
                      : std::abs(figure.value.value);
}

// How a column writes its numbers: three digits, all with an exponent or none.
class Format {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    negative_ |= value < 0;
    const double size = std::abs(value);
    if (size > 0) least_ = std::min(least_, size);
    greatest_ = std::max(greatest_, size);
  }
  std::string text(double value) const {
    if (value == 0) return "0";
    std::string scientific = fmt::format("{:.2e}", value);
    const int exponent = std::stoi(scientific.substr(scientific.find('e') + 1));
    if (exponents()) return fmt::format("{}e{}", scientific.substr(0, scientific.find('e')), exponent);
    return fmt::format("{:.{}f}", value, std::max(0, 2 - exponent));
  }
  // The option table-format of siunitx.
  std::string layout() const {
    const std::string sign = negative_ ? "-" : "";
    const auto exponent = [](double size) {
      return size > 0 && std::isfinite(size) ? int(std::floor(std::log10(size))) : 0;
    };
    const int low = exponent(least_), high = exponent(greatest_);
    if (exponents())
      return fmt::format("{}1.2e{}{}", sign, low < 0 ? "-" : "", std::max(std::abs(low), std::abs(high)) > 9 ? 2 : 1);
    return fmt::format("{}{}.{}", sign, std::max(1, high + 1), std::max(0, 2 - low));
  }

 private:
  bool exponents() const { return least_ < 1e-4 || greatest_ >= 1e5; }
  bool negative_ = false;
  double least_ = infinity, greatest_ = 0;
};

struct Column {
  std::string metric;
  std::vector<const RecordedFigure*> cells;  // null: no figure
  std::vector<bool> best;
  Format format;
  bool intervals = false;
  double scale = 1;
};

// Marks the smallest figure of each scene.
void mark_best(Column& column, const std::vector<Row>& rows) {
  column.best.assign(rows.size(), false);
  if (!has_best(column.metric)) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!column.cells[i] || std::isnan(column.cells[i]->value.value)) continue;
    bool best = true;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (column.cells[k] && rows[k].scene == rows[i].scene && rank_of(*column.cells[k]) < rank_of(*column.cells[i]))
        best = false;
    column.best[i] = best;
  }
}

std::string cell(const Column& column, std::size_t i) {
  const RecordedFigure* figure = column.cells[i];
  const std::string bold = column.best[i] ? "\\bfseries " : "";
  if (!figure) return "{--}";
  if (std::isnan(figure->value.value)) return "{undefined}";
  if (figure->below)
    return fmt::format("{{{}below noise, $\\le$ \\num{{{}}}}}", bold,
                       column.format.text(column.scale * rank_of(*figure)));
  return bold + column.format.text(column.scale * figure->value.value);
}

std::string interval(const Column& column, std::size_t i) {
  const RecordedFigure* figure = column.cells[i];
  if (!figure || figure->below || !(figure->value.low < figure->value.high)) return "";
  return fmt::format("{{[\\num{{{}}}, \\num{{{}}}]}}", column.format.text(column.scale * figure->value.low),
                     column.format.text(column.scale * figure->value.high));
}

std::string header(const std::string& metric) {
  std::string label = axis_label("", metric);
  if (const auto unit = label.find(" [s]"); unit != label.npos) label.replace(unit, 4, " [ms]");
  return latex_text(label);
}

template <class Get>
std::vector<std::string> different(const std::vector<Row>& rows, const Get& get) {
  std::vector<std::string> values;
  for (const Row& row : rows)
    if (std::find(values.begin(), values.end(), get(row)) == values.end()) values.push_back(get(row));
  return values;
}

std::string film_text(const Row& row) {
  return row.width > 0 ? fmt::format("{}x{} pixels", row.width, row.height) : "";
}

std::string caption(const RecordedRun& run, const std::vector<std::string>& scenes) {
  std::vector<std::string> parts;
  if (scenes.size() == 1 && !scenes[0].empty()) parts.push_back("Scene: " + scenes[0]);
  for (const auto& list : {different(run.rows, film_text), different(run.rows, [](const Row& r) { return r.device; })})
    for (const std::string& text : list)
      if (!text.empty()) parts.push_back(text);
  parts.insert(parts.end(), {"profile " + run.profile, run.machine, "airlight " + run.commit});
  return latex_text(fmt::format("{}. {}.", run.title, fmt::join(parts, "; ")));
}

// An interval may reach below what a logarithmic axis shows.
double on_axis(const Axis& axis, double value) { return axis.logarithmic() ? std::max(value, axis.low()) : value; }

std::string tick_at_zero(const char* name, const Axis& axis) {
  return axis.zeros_at_edge()
             ? fmt::format("  extra {0} ticks={{{1:.6g}}}, extra {0} tick labels={{0}},\n", name, axis.low())
             : "";
}

std::string point_lines(const PlotCurve& curve, bool bound, const Axes& axes) {
  std::string lines;
  for (const PlotPoint& p : curve.points) {
    if (p.bound != bound) continue;
    const double x = on_axis(axes.x, p.x.value), y = on_axis(axes.y, bound ? p.y.high : p.y.value);
    lines += fmt::format("{:.6g} {:.6g}", x, y);
    if (!bound)
      lines += fmt::format(" {:.6g} {:.6g} {:.6g} {:.6g}", x - on_axis(axes.x, p.x.low), p.x.high - x,
                           y - on_axis(axes.y, p.y.low), p.y.high - y);
    lines += "\\\\\n";
  }
  return lines;
}

std::string picture(const PlotCase& plot, const std::string& scene, const Drawing& drawing) {
  // Colours that colour-blind readers can tell apart (Okabe and Ito), as in the plots of gnuplot.
  static const char* colors[] = {"0072B2", "D55E00", "009E73", "CC79A7", "E69F00",
                                 "56B4E9", "000000", "7F3C8D", "80BA5A", "A5AA99"};
  static const char* marks[] = {"*", "square*", "triangle*", "diamond*", "pentagon*",
                                "o", "square",  "triangle",  "diamond",  "pentagon"};
  const Axes axes = axes_of(drawing, plot);
  std::string out = fmt::format(
      "% {}\n\\begin{{tikzpicture}}\n\\begin{{axis}}[\n  xlabel={{{}}}, ylabel={{{}}},\n  xmode={}, ymode={},\n"
      "  xmin={:.6g}, xmax={:.6g}, ymin={:.6g}, ymax={:.6g},\n{}{}"
      "  legend style={{at={{(0.5,-0.22)}}, anchor=north, draw=none, font=\\footnotesize, cells={{anchor=west}}}},\n"
      "  legend columns=2, grid=major, grid style={{gray!25}}]\n",
      plot_title(plot, scene), latex_text(axis_label(plot.x_label, plot.x)),
      latex_text(axis_label(plot.y_label, plot.y)), axes.x.logarithmic() ? "log" : "normal",
      axes.y.logarithmic() ? "log" : "normal", axes.x.low(), axes.x.high(), axes.y.low(), axes.y.high(),
      tick_at_zero("x", axes.x), tick_at_zero("y", axes.y));
  for (std::size_t i = 0; i < drawing.curves.size(); ++i) {
    const PlotCurve& curve = drawing.curves[i];
    const char* mark = curve.points.size() > 40 ? "none" : marks[(i + 5 * (i / 10 % 2)) % 10];
    out += fmt::format("\\definecolor{{airlight{}}}{{HTML}}{{{}}}\n", i % 10, colors[i % 10]);
    if (const std::string lines = point_lines(curve, false, axes); !lines.empty())
      out += fmt::format(
          "\\addplot[airlight{}, mark={}, mark size=1.5pt, {}error bars/.cd, x dir=both, x explicit, y dir=both, y explicit]\n"
          "  table[row sep=\\\\, x=x, y=y, x error minus=xm, x error plus=xp, y error minus=ym, y error plus=yp] {{\n"
          "x y xm xp ym yp\\\\\n{}}};\n\\addlegendentry{{{}}}\n",
          i % 10, mark, i < 10 ? "" : "dashed, ", lines, latex_text(curve.name));
    if (const std::string lines = point_lines(curve, true, axes); !lines.empty())
      out += fmt::format(
          "\\addplot[airlight{}, only marks, mark=triangle, mark options={{rotate=180}}, forget plot]  % below noise: upper bounds\n"
          "  table[row sep=\\\\, x=x, y=y] {{\nx y\\\\\n{}}};\n",
          i % 10, lines);
  }
  if (drawing.floor > 0)
    out += fmt::format(
        "\\addplot[gray, dashed] coordinates {{({:.6g},{:.6g}) ({:.6g},{:.6g})}};\n\\addlegendentry{{noise floor}}\n",
        axes.x.low(), drawing.floor, axes.x.high(), drawing.floor);
  return out + "\\end{axis}\n\\end{tikzpicture}\n";
}

}  // namespace

std::string latex_text(const std::string& text) {
  static const std::pair<char, const char*> commands[] = {{'\\', "\\textbackslash{}"},
                                                          {'{', "\\{"},
                                                          {'}', "\\}"},
                                                          {'&', "\\&"},
                                                          {'%', "\\%"},
                                                          {'$', "\\$"},
                                                          {'#', "\\#"},
                                                          {'_', "\\_"},
                                                          {'~', "\\textasciitilde{}"},
                                                          {'^', "\\textasciicircum{}"},
                                                          {'<', "\\textless{}"},
                                                          {'>', "\\textgreater{}"},
                                                          {'[', "{[}"},
                                                          {']', "{]}"}};
  std::string out;
  for (const char c : text) {
    const auto found =
        std::find_if(std::begin(commands), std::end(commands), [&](const auto& pair) { return pair.first == c; });
    if (found == std::end(commands))
      out += c;
    else
      out += found->second;
  }
  return out;
}

std::string latex_table(const RecordedRun& run, std::vector<std::string> metrics) {
  const std::vector<Row>& rows = run.rows;
  if (metrics.empty()) {
    for (const Row& row : rows)
      if (metrics.empty() && !row.measures.empty()) metrics.push_back(row.measures[0].name);
    metrics.push_back("seconds");
  }
  std::vector<std::vector<RecordedFigure>> all;
  for (const Row& row : rows) all.push_back(figures(row, metrics));
  std::vector<Column> columns;
  for (const std::string& metric : metrics) {
    Column column{metric, {}, {}, {}, false, is_timing(metric) ? 1e3 : 1};
    bool any = false;
    for (const std::vector<RecordedFigure>& of_row : all) {
      const auto found =
          std::find_if(of_row.begin(), of_row.end(), [&](const RecordedFigure& f) { return f.metric == metric; });
      const RecordedFigure* figure = found == of_row.end() ? nullptr : &*found;
      column.cells.push_back(figure);
      if (!figure) continue;
      any = true;
      column.format.add(column.scale * (figure->below ? rank_of(*figure) : figure->value.value));
      column.intervals |= !figure->below && figure->value.low < figure->value.high;
    }
    if (!any) continue;
    mark_best(column, rows);
    columns.push_back(std::move(column));
  }
  const auto scenes = different(rows, [](const Row& row) { return row.scene; });
  const bool setting = std::any_of(rows.begin(), rows.end(), [](const Row& row) { return !row.setting.empty(); });
  std::string layout = scenes.size() > 1 ? "ll" : "l", head = scenes.size() > 1 ? "scene & method" : "method";
  if (setting) {
    layout += "l";
    head += " & setting";
  }
  for (const Column& column : columns) {
    layout += fmt::format("S[table-format={}]{}", column.format.layout(), column.intervals ? "@{\\enspace}l" : "");
    head += fmt::format(" & {{{}}}", header(column.metric));
    // Fewer than six timed runs cannot reach 95 %.
    if (column.intervals) head += is_timing(column.metric) ? " & {interval}" : " & {95\\,\\% interval}";
  }
  std::string out = fmt::format(
      "% {0}: \\usepackage{{booktabs,siunitx}}\n% Bold: the smallest error and the shortest time of a scene. A value below "
      "noise counts by its upper bound.\n\\begin{{table}}\n\\centering\n\\sisetup{{detect-weight}}\n\\caption{{{1}}}\n\\label{{tab:{0}}}\n"
      "\\begin{{tabular}}{{{2}}}\n\\toprule\n{3} \\\\\n",
      run.name, caption(run, scenes), layout, head);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const bool next = i == 0 || rows[i - 1].scene != row.scene;
    if (next) out += "\\midrule\n";
    if (scenes.size() > 1) out += (next ? latex_text(row.scene) : "") + " & ";
    out += latex_text(with_device(row.method, row.device));
    if (setting) out += " & " + latex_text(row.setting);
    for (const Column& column : columns) {
      out += " & " + cell(column, i);
      if (column.intervals) out += " & " + interval(column, i);
    }
    out += " \\\\\n";
  }
  return out + "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}

std::string pgfplots(const Outcome& outcome, const RecordedRun& run) {
  std::string out;
  for (const PlotCase& plot : outcome.experiment.plots) {
    if (plot.map) {
      out +=
          fmt::format("% {}: plot {} is a map of colours, not curves: it has no pgfplots form\n", run.name, plot.name);
      continue;
    }
    for (const std::string& scene : plot_scenes(outcome, plot)) {
      Drawing drawing = collect(outcome, plot, scene);
      if (is_column(plot.x) && drawing.curves.empty())
        drawing = read_data(run.folder / "plots" / (plot_name(plot, scene) + ".csv"));
      if (!drawing.curves.empty())
        out += fmt::format("% {}: \\usepackage{{pgfplots}} \\pgfplotsset{{compat=1.18}}\n{}", run.name,
                           picture(plot, scene, drawing));
    }
  }
  return out;
}

}  // namespace airlight::experiments
