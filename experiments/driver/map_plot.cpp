#include <fmt/format.h>

#include <cmath>

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
      "plot data index {} using (log10($1)):(log10($2)):(log10($3 < 1e-16 ? 1e-16 : $3)) with image notitle",
      gnuplot_text(row.setting.empty() ? row.method : row.method + " " + row.setting),
      gnuplot_text("log10 " + row.map->x.label), gnuplot_text("log10 " + row.map->y.label), block);
  for (std::size_t i = 0; i < row.map->lines.size(); ++i)
    out += fmt::format(", $line{} using 1:2 with lines lw 1 dt {} lc rgb \"white\" notitle", i, i + 1);
  return out + "\n";
}

}  // namespace

bool write_map_plot(const std::vector<Row>& rows, const PlotCase& plot, const std::filesystem::path& folder) {
  std::string data = "# x,y,value; a block for each row\n", panels;
  std::size_t blocks = 0;
  const FigureMap* first = nullptr;
  for (const Row& row : rows) {
    if (!row.map) continue;
    const FigureMap& map = *row.map;
    if (!first) first = &map;
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
  const std::string name = plot_name(plot, "");
  std::string out = fmt::format(
      "# Draws {0}.svg from {0}.csv: run gnuplot on this file in its folder.\n"
      "data = \"{0}.csv\"\nset datafile separator comma\nset encoding utf8\n"
      "set xrange {1}\nset yrange {2}\nset cbrange [-16:2]\nset xtics 2\nset ytics 2\n"
      "set palette defined (0 \"#440154\", 1 \"#3b528b\", 2 \"#21918c\", 3 \"#5ec962\", 4 \"#fde725\", 4.5 \"#d55e00\")\n"
      "set cblabel {3} noenhanced\nset object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb "
      "\"#bbbbbb\" fillstyle solid noborder\n",
      name, range(first->x), range(first->y), gnuplot_text("log10 of the " + first->label));
  for (std::size_t i = 0; i < first->lines.size(); ++i) {
    out += fmt::format("$line{} << EOD\n", i);
    for (const auto& [x, y] : first->lines[i]) out += fmt::format("{:.4f},{:.4f}\n", std::log10(x), std::log10(y));
    out += "EOD\n";
  }
  const std::size_t columns = std::min<std::size_t>(4, blocks), across = (blocks + columns - 1) / columns;
  out += fmt::format(
      "set terminal svg dynamic size {},{} font \"sans-serif,11\"\nset output \"{}.svg\"\nset multiplot layout "
      "{},{}\n{}unset multiplot\n",
      375 * columns, 355 * across, name, across, columns, panels);
  make_folder(folder);
  scene::write_file_atomically((folder / (name + ".csv")).string(), data);
  scene::write_file_atomically((folder / (name + ".gp")).string(), out);
  return true;
}

}  // namespace airlight::experiments
