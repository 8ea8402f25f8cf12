#include "experiments/shadow_planes/evaluator_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/atomic_file.h"

namespace airlight::experiments::shadow_planes {

// Data and script of error against time; a curve is a block.
void write_time_plot(const std::filesystem::path& plots, const std::vector<TimedRow>& rows) {
  std::string data = "curve,setting,nanoseconds,p99\n", script;
  int index = 0;
  const char* colors[] = {"#D55E00", "#E69F00", "#CC79A7", "#0072B2", "#56B4E9", "#009E73"};
  for (const char* evaluator : {"polynomial", "rule"})
    for (const char* precision : {"single", "double", "single, device"}) {
      if (std::none_of(rows.begin(), rows.end(), [&](const TimedRow& row) { return row.precision == precision; }))
        continue;
      const std::string curve = fmt::format("{}, {}", evaluator, precision);
      for (const TimedRow& row : rows)
        if (row.evaluator == evaluator && row.precision == precision)
          data += fmt::format("\"{}\",{},{:.1f},{:.3g}\n", curve, row.setting, row.nanoseconds, row.p99);
      data += "\n\n";
      script += fmt::format(
          "{}data index {} using 3:4 with linespoints lc rgb \"{}\" pt 7 ps 0.7 lw 1.6 title \"{}\", \\\n"
          "     data index {} using 3:4:2 with labels offset 0.6,0.6 font \",9\" tc rgb \"{}\" notitle",
          index ? ", \\\n     " : "plot ", index, colors[index], curve, index, colors[index]);
      ++index;
    }
  std::string out =
      "# Draws evaluator_times.svg and .png from evaluator_times.csv: run gnuplot on this file in its folder.\n"
      "data = \"evaluator_times.csv\"\nset datafile separator comma\n"
      "set title \"Error against time of one evaluation; labels: degree or nodes\" noenhanced\n"
      "set xlabel \"time, one thread or the whole device [ns]\"\nset ylabel \"relative error, 99th percentile\"\n"
      "set logscale xy\nset format y \"%g\"\nset key outside right center vertical Left reverse\n"
      "set grid xtics ytics lt 1 lw 0.5 lc rgb \"#cccccc\"\nset border 3 lc rgb \"#444444\"\nset tics nomirror\n";
  for (const auto& [terminal, file] :
       {std::pair<const char*, const char*>{"svg size 820,440 dynamic font \"sans-serif,13\"", "svg"},
        {"pngcairo size 1230,660 font \"Sans,13\"", "png"}})
    out += fmt::format("set terminal {}\nset output \"evaluator_times.{}\"\n{}\n", terminal, file, script);
  scene::write_file_atomically((plots / "evaluator_times.csv").string(), data);
  scene::write_file_atomically((plots / "evaluator_times.gp").string(), out);
}

void write_map_plot(const std::filesystem::path& plots) {
  std::string panels;
  for (std::size_t i = 0; i < map_evaluators().size(); ++i)
    panels += fmt::format(
        "set title \"{}\" noenhanced\n"
        "plot data using (log10($1)):(log10($2)):(log10(${} < 1e-16 ? 1e-16 : ${})) with image notitle, \\\n"
        "     -x with lines lw 1 lc rgb \"white\" notitle, $far using 1:2 with lines lw 1 dt 2 lc rgb \"white\" "
        "notitle\n",
        map_evaluators()[i], i + 3, i + 3);
  std::string out =
      "# Draws stability_map.svg and .png from ../map.csv: run gnuplot on this file in its folder.\n"
      "data = \"../map.csv\"\nset datafile separator comma\nset key autotitle columnhead\nset encoding utf8\n"
      "# White: a = extinction * h = 1; dashed: the light is 3 optical lengths away.\n"
      "$far << EOD\n";
  for (int i = 0; i <= 36; ++i) {
    const double h = std::pow(10, -6 + 0.25 * i);
    out += fmt::format("{:.4f},{:.4f}\n", std::log10(3 / std::hypot(map_foot, h)), std::log10(h));
  }
  out +=
      "EOD\nset xrange [-6.12:4.12]\nset yrange [-6.12:3.12]\nset cbrange [-16:2]\nset xtics 2\nset ytics 2\n"
      "set xlabel \"log10 extinction [1/m]\" offset 0,0.5\nset ylabel \"log10 h [m]\" offset 1,0\n"
      "set palette defined (0 \"#440154\", 1 \"#3b528b\", 2 \"#21918c\", 3 \"#5ec962\", 4 \"#fde725\", 4.5 "
      "\"#d55e00\")\n"
      "set cblabel \"log10 of the relative error\"\nset object rectangle from graph 0,0 to graph 1,1 behind "
      "fillcolor rgb \"#bbbbbb\" fillstyle solid noborder\n";
  for (const auto& [terminal, file] :
       {std::pair<const char*, const char*>{"svg size 1500,700 dynamic font \"sans-serif,11\"", "svg"},
        {"pngcairo size 1800,840 font \"Sans,11\"", "png"}})
    out +=
        fmt::format("set terminal {}\nset output \"stability_map.{}\"\nset multiplot layout 2,4\n{}unset multiplot\n",
                    terminal, file, panels);
  scene::write_file_atomically((plots / "stability_map.gp").string(), out);
}

}  // namespace airlight::experiments::shadow_planes
