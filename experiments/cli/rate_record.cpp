#include "experiments/cli/rate_record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "experiments/build_info.h"
#include "experiments/driver/tables.h"
#include "experiments/folders.h"
#include "experiments/machine.h"
#include "scene/atomic_file.h"

namespace airlight::experiments::cli {
namespace {

const char* const title = "Fogshop: kernel evaluations per second";
const char* const about =
    "Whole pictures against a bare loop of the same arithmetic. An evaluation is the airlight of one Gaussian on one "
    "ray "
    "(paper, Eqs. 10 to 13), or the optical depth of one Gaussian up to one edge of a slice (S, Eq. 31). The bare loop "
    "does these operations as often as the picture does, from registers: lists of Gaussians, memory, empty lanes and "
    "sums over slices are not in it and count against the renderer. Calls of the error function alone are the narrower "
    "measure. Millions per second.";

std::string slices(const RateRow& row) { return row.slices ? std::to_string(row.slices) : ""; }

std::vector<std::vector<std::string>> lines(const RateRun& run) {
  std::vector<std::vector<std::string>> all{{"variant", "K", "erf", "threads", "pairs per ray", "evaluations",
                                             "bare loop", "share", "erf calls", "bare loop of erf", "share of erf"}};
  for (const RateRow& r : run.rows)
    all.push_back({r.variant, slices(r), r.erf, std::to_string(r.threads), fmt::format("{:.1f}", r.pairs_per_ray),
                   fmt::format("{:.1f}", r.evaluations), fmt::format("{:.1f}", r.bare_evaluations),
                   fmt::format("{:.0f} %", 100 * r.evaluations / r.bare_evaluations),
                   fmt::format("{:.1f}", r.erf_calls), fmt::format("{:.1f}", r.bare_erf_calls),
                   fmt::format("{:.0f} %", 100 * r.erf_calls / r.bare_erf_calls)});
  return all;
}

}  // namespace

std::string rate_text(const RateRun& run) {
  std::string out = fmt::format(
      "{}, {}; millions per second\n"
      "variant     K erf      threads  pairs/ray  evaluations   bare loop    share   erf calls   bare loop    share\n",
      run.scene, run.how);
  for (const RateRow& r : run.rows)
    out += fmt::format("{:8} {:>4} {:8} {:7} {:11.1f} {:12.1f} {:11.1f} {:6.0f} % {:11.1f} {:11.1f} {:6.0f} %\n",
                       r.variant, slices(r), r.erf, r.threads, r.pairs_per_ray, r.evaluations, r.bare_evaluations,
                       100 * r.evaluations / r.bare_evaluations, r.erf_calls, r.bare_erf_calls,
                       100 * r.erf_calls / r.bare_erf_calls);
  return out;
}

void write_rate_record(const std::filesystem::path& folder, const RateRun& run) {
  make_folder(folder);
  const auto put = [&](const char* name, const std::string& text) {
    scene::write_file_atomically((folder / name).string(), text);
  };
  const auto all = lines(run);
  std::string csv, table;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<std::string> fields;
    for (const std::string& cell : all[i]) fields.push_back(csv_field(cell));
    csv += fmt::format("{}\n", fmt::join(fields, ","));
    table += fmt::format("| {} |\n", fmt::join(all[i], " | "));
    if (i == 0) table += fmt::format("|{}|\n", fmt::join(std::vector<std::string>(all[i].size(), "---"), "|"));
  }
  const Machine machine = this_machine();
  const std::string conditions = fmt::format("{}, {}", run.scene, run.how);
  put("rate.csv", csv);
  put("table.md",
      fmt::format("# {}\n\nZhou et al. 2007, Eqs. 10 to 13 and 31.\n\n{}\n\n{}\n{}; {}; airlight {} ({}). Made "
                  "by `{}`.\n",
                  title, about, table, conditions, machine.cpu, version(), commit(), run.command));
  const nlohmann::json record = {
      {"experiment", "fogshop/rate"},
      {"title", title},
      {"paper", "Zhou et al. 2007, Eqs. 10 to 13 and 31"},
      {"about", about},
      {"conditions", conditions},
      {"command", run.command},
      {"date", utc_now()},
      {"commit", commit()},
      {"version", version()},
      {"compiler", compiler()},
      {"machine", {{"cpu", machine.cpu}, {"threads", machine.threads}, {"load_average_at_end", machine.load_average}}},
      {"tables", {{{"file", "rate.csv"}, {"title", "Millions per second: " + conditions}}}},
      {"plots", nlohmann::json::array()},
      {"pictures", nlohmann::json::array()},
      {"gates", nlohmann::json::array()}};
  put("run.json", record.dump(2) + "\n");
}

}  // namespace airlight::experiments::cli
