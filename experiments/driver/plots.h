// Plots: a CSV file and a gnuplot script beside it, drawn as SVG. Drawing reads the CSV only.
#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "experiments/driver/outcome.h"
#include "experiments/driver/tables.h"

namespace airlight::experiments {

// Writes results/<id>/plots/<name>.csv and .gp and runs gnuplot on them. Without gnuplot: the list is empty and one
// line on standard error says so. A plot without points is left out.
std::vector<PlotFile> draw_plots(const Outcome&, const std::filesystem::path& folder);

// Draws the plots of an earlier run again, from its record and, for columns, the data files. A map needs its script.
// Returns their number: 0 where there is no record.
std::size_t redraw_plots(const Experiment&, const std::filesystem::path& folder);

// The name of a plot's files without their ending; `scene` is empty where one plot shows all scenes.
std::string plot_name(const PlotCase&, const std::string& scene);

// Runs gnuplot on these scripts in the folder. Throws Unavailable without gnuplot, Error if it fails.
void run_gnuplot(const std::filesystem::path& folder, const std::vector<std::string>& scripts);
bool has_gnuplot();

// One line of text from a file, in single quotes: gnuplot runs what stands in backquotes within double ones.
std::string gnuplot_text(std::string_view);

// The maps of these rows (row.map), side by side: data and script NAME.csv, NAME.gp in the folder. False without any.
bool write_map_plot(const std::vector<Row>&, const PlotCase&, const std::filesystem::path& folder);

}  // namespace airlight::experiments
