#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/application/folders.h"
#include "experiments/driver/plots.h"
#include "experiments/driver/tables.h"
#include "scene/base/atomic_file.h"
#include "scene/base/printable.h"

namespace airlight::experiments {
namespace {

// One panel: the map as an image over the logarithms of its axes, and its lines on top.
std::string panel(const Row& row, std::size_t block) {
  std::string out = fmt::format(
      "set title {} noenhanced\nset xlabel {} offset 0,0.5 noenhanced\nset ylabel {} offset 1,0 noenhanced\n"
      "plot data index {} using (log10($1)):(log10($2)):(log10($3 < least ? least : $3)) with image notitle",
      gnuplot_text(row.setting.empty() ? row.method : row.method + " " + row.setting),
      gnuplot_text("log10 " + row.map->x.label), gnuplot_text("log10 " + row.map->y.label), block);
  for (std::size_t i = 0; i < row.map->lines.size(); ++i)
    out += fmt::format(", $line{} using 1:2 with lines lw 1 dt {} lc rgb \"white\" notitle", i, i + 1);
  return out + "\n";
}

// Colours from the least to the greatest value. Where most of the range lies below 1, values above 1 are orange.
std::string colours(double low, double high) {
  if (high - low < 0.1) {
    low -= 0.05;
    high += 0.05;
  }
  static const char* ramp[] = {"#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"};
  const bool both = high > 0 && -low > high;
  const double end = both ? 0 : high;
  std::string out = fmt::format("set cbrange [{:.4g}:{:.4g}]\nset palette defined (", low, high);
  for (int i = 0; i < 5; ++i) out += fmt::format("{:.4g} \"{}\", ", low + 0.25 * i * (end - low), ramp[i]);
  return out.substr(0, out.size() - 2) + (both ? fmt::format(", {:.4g} \"#d55e00\"", high) : "") + ")\n";
}

}  // namespace

bool write_map_plot(const std::vector<Row>& rows, const PlotCase& plot, const std::filesystem::path& folder) {
  std::string data = "# x,y,value; a block for each row\n", panels;
  std::size_t blocks = 0;
  const FigureMap* first = nullptr;
  double least = std::numeric_limits<double>::infinity(), greatest = 0;  // of the positive values
  for (const Row& row : rows) {
    if (!row.map) continue;
    const FigureMap& map = *row.map;
    if (!first) first = &map;
    for (const double value : map.values) {
      if (!(value > 0)) continue;
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
    data += fmt::format("# {}\n", scene::printable(fmt::format("{}, {}, {}", row.scene, row.method, row.setting)));
    for (std::size_t i = 0; i < map.x.values.size(); ++i)
      for (std::size_t k = 0; k < map.y.values.size(); ++k)
        data += fmt::format("{:.4g},{:.4g},{:.2g}\n", map.x.values[i], map.y.values[k],
                            map.values[i * map.y.values.size() + k]);
    data += "\n\n";
    panels += panel(row, blocks++);
  }
  if (!first) return false;
  const auto range = [](const FigureMap::Axis& axis) {
    const double low = std::log10(axis.values.front()), high = std::log10(axis.values.back());
    const double half = 0.5 * (high - low) / double(axis.values.size() - 1);
    return fmt::format("[{:.4f}:{:.4f}]", low - half, high + half);
  };
  // Colours are kept for values that differ: below 1e-16 is rounding, above 1e4 is overflow.
  least = std::clamp(least, 1e-16, 1e4);
  greatest = std::clamp(greatest, least, 1e4);
  const std::string name = plot_name(plot, "");
  std::string out = fmt::format(
      "# Draws {0}.svg from {0}.csv: run gnuplot on this file in its folder.\n"
      "data = \"{0}.csv\"\nset datafile separator comma\nset encoding utf8\nleast = {5:.3g}\n"
      "set xrange {1}\nset yrange {2}\n{4}set xtics 2\nset ytics 2\n"
      "set cblabel {3} noenhanced\nset object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb "
      "\"#bbbbbb\" fillstyle solid noborder\n",
      name, range(first->x), range(first->y), gnuplot_text("log10 of the " + first->label),
      colours(std::log10(least), std::log10(greatest)), least);
  for (std::size_t i = 0; i < first->lines.size(); ++i) {
    out += fmt::format("$line{} << EOD\n", i);
    for (const auto& [x, y] : first->lines[i]) out += fmt::format("{:.4f},{:.4f}\n", std::log10(x), std::log10(y));
    out += "EOD\n";
  }
  const std::size_t columns = std::min<std::size_t>(4, blocks), across = (blocks + columns - 1) / columns;
  out += fmt::format(
      "set terminal svg dynamic size {},{} font \"sans-serif,11\"\nset output \"{}.svg\"\nset multiplot layout "
      "{},{} title {} noenhanced font \",13\"\n{}unset multiplot\n",
      375 * columns, 355 * across + 30, name, across, columns, gnuplot_text(plot.title), panels);
  make_folder(folder);
  scene::write_file_atomically((folder / (name + ".csv")).string(), data);
  scene::write_file_atomically((folder / (name + ".gp")).string(), out);
  return true;
}

}  // namespace airlight::experiments
