#include <fmt/format.h>

#include "experiments/cli/commands.h"
#include "experiments/folders.h"
#include "experiments/shadow_planes/evaluator_tables.h"
#include "scene/error.h"

namespace airlight::experiments::cli {

int evaluators(const EvaluatorsOptions& options) {
  if (options.cases < 100) throw Error(fmt::format("--cases {}: expected 100 or more", options.cases));
  if (options.runs < 1) throw Error(fmt::format("--runs {}: expected 1 or more", options.runs));
  const auto folder = project_root(options.root) / "results" / "shadow_planes" / "evaluators";
  shadow_planes::EvaluatorEffort effort;
  effort.cases = options.cases;
  effort.runs = options.runs;
  shadow_planes::write_evaluator_tables(folder, effort);
  fmt::print("{}\n", (folder / "table.md").string());
  return 0;
}

}  // namespace airlight::experiments::cli
