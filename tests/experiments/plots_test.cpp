#include "experiments/driver/plots.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <set>

#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace plots_test {

using namespace airlight;
using namespace airlight::experiments;
using Catch::Contains;

namespace {

Row row(const std::string& method, double parameter, double error) {
  Row r;
  r.scene = "fog";
  r.method = method;
  r.parameter = parameter;
  r.measures = {{"rel_l2", error, error, error, 0, false}};
  return r;
}

// The gnuplot script of a plot of these rows against their parameter.
std::string script_of(std::vector<Row> rows, const TemporaryFolder& folder) {
  Outcome outcome;
  outcome.rows = std::move(rows);
  PlotCase plot;
  plot.name = "p";
  plot.x = "parameter";
  plot.y = "rel_l2";
  plot.per_scene = false;
  outcome.experiment.plots = {plot};
  draw_plots(outcome, folder.path());
  return read_bytes((folder.path() / "plots/p.gp").string());
}

}  // namespace

TEST_CASE("plots show errors of 0 at the lower edge and negative abscissas on a linear axis", "[plots]") {
  const TemporaryFolder folder;
  const std::string script = script_of({row("a", -0.9, 0.5), row("a", 0, 0), row("a", 0.9, 0.001)}, folder);
  CHECK_THAT(script, Contains("set logscale y") && Contains("set ytics add (\"0\"") && !Contains("set logscale x"));
  CHECK_THAT(script, Contains("set xrange [-0.954:0.954]"));
  const std::string data = read_bytes((folder.path() / "plots/p.csv").string());
  CHECK_THAT(data, Contains("a,-0.9,") && Contains("a,0,0,0,0,0,0,") && Contains("a,0.9,"));
}

TEST_CASE("plots of many curves have no two that look alike, and name a software renderer", "[plots]") {
  const TemporaryFolder folder;
  std::vector<Row> rows;
  for (int i = 0; i < 30; ++i) rows.push_back(row(fmt::format("m{}", i), 1, 0.1 + i));
  rows.push_back(row("rule, GPU", 1, 1));
  rows.back().device = "llvmpipe (a processor, no GPU)";
  const std::string script = script_of(rows, folder);
  CHECK_THAT(script, Contains("'rule, llvmpipe (CPU)'") && Contains("relative L2 error"));
  std::set<std::string> styles;
  for (auto at = script.find(" with linespoints "); at != std::string::npos;
       at = script.find(" with linespoints ", at + 1))
    styles.insert(script.substr(at, script.find(" title ", at) - at));
  CHECK(styles.size() == 31);
}

}  // namespace plots_test
