#include "experiments/shadow_planes/evaluator_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/build_info.h"
#include "experiments/driver/plots.h"
#include "experiments/folders.h"
#include "experiments/machine.h"
#include "experiments/say.h"
#include "experiments/shadow_planes/evaluator_errors.h"
#include "experiments/shadow_planes/evaluator_plots.h"
#include "scene/atomic_file.h"
#include "scene/error.h"

namespace airlight::experiments::shadow_planes {
namespace {

using Cells = std::vector<std::string>;
using Lines = std::vector<Cells>;

std::string csv(const Lines& lines) {
  std::string out;
  for (const Cells& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) out += (i ? "," : "") + csv_field(line[i]);
    out += "\n";
  }
  return out;
}

std::string markdown(const Lines& lines) {
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out += fmt::format("| {} |\n", fmt::join(lines[i], " | "));
    if (i == 0) {
      out += "|";
      for (std::size_t k = 0; k < lines[0].size(); ++k) out += "---|";
      out += "\n";
    }
  }
  return out + "\n";
}

Lines map_lines(const std::vector<MapCell>& map) {
  Lines lines{{"extinction", "h"}};
  for (const std::string& title : map_evaluators()) lines[0].push_back(title);
  for (const MapCell& cell : map) {
    lines.push_back({fmt::format("{:.4g}", cell.extinction), fmt::format("{:.4g}", cell.h)});
    for (const double e : cell.error) lines.back().push_back(fmt::format("{:.2g}", e));
  }
  return lines;
}

// Of the cells that are not too dark: how many are good, and how many of those that the light's optical distance leaves
// bright.
Lines share_lines(const std::vector<MapCell>& map) {
  Lines lines{{"evaluator", "cells", "error < 1e-2", "< 1e-4", "< 1e-6", "median error", "greatest error",
               "error < 1e-2 where the light is at most 3 optical lengths away", "greatest there"}};
  for (std::size_t i = 0; i < map_evaluators().size(); ++i) {
    std::vector<double> all, near;
    for (const MapCell& cell : map) {
      if (std::isnan(cell.error[i])) continue;
      all.push_back(cell.error[i]);
      if (cell.extinction * std::hypot(map_foot, cell.h) <= 3) near.push_back(cell.error[i]);
    }
    const auto share = [](const std::vector<double>& errors, double bound) {
      const auto good = std::count_if(errors.begin(), errors.end(), [&](double e) { return e < bound; });
      return fmt::format("{:.1f} %", 100.0 * double(good) / double(errors.size()));
    };
    std::sort(all.begin(), all.end());
    lines.push_back({map_evaluators()[i], std::to_string(all.size()), share(all, 1e-2), share(all, 1e-4),
                     share(all, 1e-6), fmt::format("{:.1e}", all[all.size() / 2]), fmt::format("{:.1e}", all.back()),
                     share(near, 1e-2), fmt::format("{:.1e}", *std::max_element(near.begin(), near.end()))});
  }
  return lines;
}

Lines angle_lines(int cases) {
  Lines lines{{"theta within", "a"}};
  for (const int degree : angle_degrees) lines[0].push_back(fmt::format("degree {}", degree));
  for (const AngleRow& row : errors_over_angles(cases)) {
    lines.push_back({fmt::format("+-{:g}", row.reach), fmt::format("{:g} to {:g}", row.a_low, row.a_high)});
    for (const auto& e : row.error) lines.back().push_back(fmt::format("{:.0e} / {:.0e}", e.median, e.p99));
  }
  return lines;
}

Lines image_lines() {
  Lines lines{{"optical distance of the light"}};
  for (const int degree : angle_degrees) lines[0].push_back(fmt::format("degree {}", degree));
  for (const ImageRow& row : errors_over_image(90)) {
    lines.push_back({fmt::format("{:g}", row.optical_distance)});
    for (const double e : row.error) lines.back().push_back(fmt::format("{:.1e}", e));
  }
  return lines;
}

Lines time_lines(const std::vector<TimedRow>& rows) {
  Lines lines{{"evaluator", "precision", "degree or nodes", "ns", "median error", "99th percentile", "greatest"}};
  for (const TimedRow& row : rows)
    lines.push_back({row.evaluator, row.precision, std::to_string(row.setting), fmt::format("{:.0f}", row.nanoseconds),
                     fmt::format("{:.1e}", row.median), fmt::format("{:.1e}", row.p99),
                     fmt::format("{:.1e}", row.greatest)});
  return lines;
}

}  // namespace

void write_evaluator_tables(const std::filesystem::path& folder, const EvaluatorEffort& effort) {
  const std::vector<MapCell> map = stability_map(effort.per_decade);
  gpu::Context* device = nullptr;
  try {
    device = &gpu::Context::get();
  } catch (const NoDevice& reason) {
    if (gpu::Context::device_was_chosen()) throw;
    say(fmt::format("no device, its rows are left out: {}", reason.what()));
  }
  const std::vector<TimedRow> times = errors_and_times(effort.cases, effort.runs, device);
  const Lines shares = share_lines(map), angles = angle_lines(effort.cases), image = image_lines();
  double own = 0;
  for (const MapCell& cell : map) own = std::max(own, cell.own_error);
  const std::string title = "Shadow planes: where the evaluators hold";
  const std::string about = fmt::format(
      "The airlight of a point light on a lit part of a ray, isotropic medium: the paper's polynomial of theta (degree "
      "4 "
      "in the map) as differences of Gamma from the eye, as in its section 4.2, or over the lit part alone; and the "
      "mapped Gauss-Legendre rule. Reference: 128 nodes in double precision, which 256 change by at most {:.0e} in any "
      "cell of the map.",
      own);
  std::filesystem::remove_all(folder / "plots");
  make_folder(folder / "plots");
  const auto put = [&](const char* name, const std::string& text) {
    scene::write_file_atomically((folder / name).string(), text);
  };
  put("map.csv", csv(map_lines(map)));
  put("shares.csv", csv(shares));
  put("angles.csv", csv(angles));
  put("image.csv", csv(image));
  put("times.csv", csv(time_lines(times)));
  write_map_plot(folder / "plots");
  write_time_plot(folder / "plots", times);
  if (has_gnuplot())
    run_gnuplot(folder / "plots", {"stability_map.gp", "evaluator_times.gp"});
  else
    fmt::print(stderr, "airlight: gnuplot is not installed: no plots (Debian: gnuplot-nox)\n");

  const Machine machine = this_machine();
  const std::string map_title = fmt::format(
      "Map: greatest relative error of three lit parts, 1 to 2, 4 to 6 and 8 to 9 m from the eye, the light's foot "
      "point "
      "at {:g} m. Parts whose light is below the least normal number of the precision are left out (grey: all). White "
      "line: a = 1; dashed: the light is 3 optical lengths away",
      map_foot);
  put("table.md",
      fmt::format(
          "# {}\n\nBiri et al. 2006, sections 4.1 and 4.2.\n\n{}\n\n![stability map](plots/stability_map.svg)\n\n"
          "{}. Shares are of cells.\n\n{}## Error of the polynomial over angles\n\nRelative error of its integral, "
          "median / 99th percentile over {} random parts, double precision; a = extinction * h.\n\n{}## Error of "
          "the polynomial over a picture\n\nRoot of the mean squared error over the mean, endless rays at 0 to 90 "
          "degrees from the light.\n\n{}## Error against time\n\nLit parts at random, the light 0.1 to 3 optical "
          "lengths away; polynomial over the part alone; one thread, {}; device: {}.\n\n![error against "
          "time](plots/evaluator_times.svg)\n\n{}airlight {} ({}). Made by `airlight evaluators`.\n",
          title, about, map_title, markdown(shares), effort.cases, markdown(angles), markdown(image), machine.cpu,
          device ? device->description() : "none", markdown(time_lines(times)), version(), commit()));
  nlohmann::json record = {
      {"experiment", "shadow_planes/evaluators"},
      {"title", title},
      {"paper", "Biri et al. 2006, sections 4.1 and 4.2"},
      {"about", about},
      {"command", "airlight evaluators"},
      {"date", utc_now()},
      {"commit", commit()},
      {"version", version()},
      {"compiler", compiler()},
      {"machine", {{"cpu", machine.cpu}, {"threads", 1}, {"load_average_at_end", machine.load_average}}},
      {"tables",
       {{{"file", "shares.csv"}, {"title", "Shares of the map"}},
        {{"file", "angles.csv"}, {"title", "Error of the polynomial over angles: median / 99th percentile"}},
        {{"file", "image.csv"}, {"title", "Error of the polynomial over a picture"}},
        {{"file", "times.csv"}, {"title", "Error against time"}}}},
      {"plots",
       {{{"file", "plots/stability_map.svg"}, {"title", map_title}},
        {{"file", "plots/evaluator_times.svg"}, {"title", "Error against time of one evaluation"}}}},
      {"pictures", nlohmann::json::array()},
      {"gates", nlohmann::json::array()}};
  if (!has_gnuplot()) record["plots"] = nlohmann::json::array();
  put("run.json", record.dump(2) + "\n");
}

}  // namespace airlight::experiments::shadow_planes
