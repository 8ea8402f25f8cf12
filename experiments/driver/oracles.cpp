#include "experiments/driver/oracles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <iostream>
#include <sstream>

#include "experiments/driver/tables.h"
#include "experiments/folders.h"
#include "experiments/verify/verify.h"
#include "scene/atomic_file.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

// A stream that swallows what it gets.
class Nothing : public std::streambuf {
  int overflow(int c) override { return c; }
};

GateResult judge(const std::string& id, const std::string& file, const VerifyKind& kind) {
  GateResult gate;
  gate.name = fmt::format("{}: {}, {}", id, file, kind.kind);
  gate.passed = kind.out == 0;
  gate.kind = "deterministic";
  gate.metric = "share of tolerance";
  gate.bound = 1;
  gate.measured = Estimate{kind.worst_share, kind.worst_share, kind.worst_share};
  gate.text =
      fmt::format("{}: {} of {} numbers within tolerance, worst at {:.2g} of it{}", gate.name, kind.numbers - kind.out,
                  kind.numbers, kind.worst_share, kind.worst.empty() ? "" : " (" + kind.worst + ")");
  return gate;
}

std::string table(const std::vector<std::vector<std::string>>& lines, bool markdown) {
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<std::string> cells;
    for (const std::string& cell : lines[i]) cells.push_back(markdown ? cell : csv_field(cell));
    out += markdown ? fmt::format("| {} |\n", fmt::join(cells, " | ")) : fmt::format("{}\n", fmt::join(cells, ","));
    if (markdown && i == 0) out += fmt::format("|{}|\n", fmt::join(std::vector<std::string>(cells.size(), "---"), "|"));
  }
  return out;
}

}  // namespace

Outcome run_oracles(Experiment experiment, const RunOptions& options) {
  Outcome outcome;
  outcome.experiment = std::move(experiment);
  const Experiment& e = outcome.experiment;
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::string> files;
  for (const fs::path& file : e.vector_files) files.push_back(file.string());
  std::vector<VerifyKind> kinds;
  Nothing nothing;
  std::ostream silent(&nothing);
  verify(files, "", e.profile == "quick" ? VerifyProfile::quick : VerifyProfile::paper, silent, &kinds);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.complete = true;

  std::vector<std::vector<std::string>> lines{{"file", "kind", "vectors", "numbers", "out of tolerance",
                                               "worst relative error", "worst share of tolerance", "at",
                                               "left out by the profile", "not yet", "seconds"}};
  for (const VerifyKind& kind : kinds) {
    const std::string file = fs::path(kind.file).filename().string();
    lines.push_back({file, kind.kind, std::to_string(kind.vectors), std::to_string(kind.numbers),
                     std::to_string(kind.out), kind.numbers ? fmt::format("{:.2e}", kind.worst_relative_error) : "",
                     kind.numbers ? fmt::format("{:.2g}", kind.worst_share) : "", kind.worst,
                     std::to_string(kind.left_out), std::to_string(kind.not_yet), fmt::format("{:.2f}", kind.seconds)});
    if (kind.numbers == 0) continue;
    outcome.gates.push_back(judge(e.id, file, kind));
    if (options.talk) fmt::print("  {}\n", outcome.gates.back().text);
  }

  if (outcome.gates.empty()) {
    const std::string name = e.id + ": any vector";
    outcome.gates.push_back({name, name + " fails: no number was compared", false, false});
  }

  const fs::path folder = options.root / "results" / results_name(e.id, e.profile);
  make_folder(folder);
  const auto put = [&](const char* name, const std::string& text) {
    scene::write_file_atomically((folder / name).string(), text);
  };
  put("table.csv", table(lines, false));
  put("summary.csv", table(lines, false));
  put("table.md", table_markdown(outcome, {}, table(lines, true)));
  put("run.json", run_record(outcome, {}));
  return outcome;
}

}  // namespace airlight::experiments
