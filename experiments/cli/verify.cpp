#include "experiments/verify/verify.h"

#include <fmt/format.h>

#include <iostream>

#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

struct VerifyOptions {
  std::vector<std::string> files;
  std::string kind, profile = "quick";
  bool device = false;
};

}  // namespace

void add_verify(Commands& commands) {
  const auto options = std::make_shared<VerifyOptions>();
  CLI::App* c = add_command(commands.app, "verify",
                            "recompute the oracle vectors and compare: expected, got, relative error, tolerance");
  c->add_option("FILE", options->files, "JSON files of oracle vectors (required), e.g. tests/vectors/*.json");
  c->add_option("--kind", options->kind, "only vectors of this kind");
  c->add_option("--profile", options->profile, "quick (default) or paper");
  c->add_flag("--device", options->device,
              "compute the vectors on the graphics device; list those that no device code computes");
  commands.add_gpu(c);
  commands.on(c, [options, &commands] {
    if (options->files.empty()) throw Error("FILE is missing; see --help");
    if (options->profile != "quick" && options->profile != "paper")
      throw Error(fmt::format("--profile '{}': expected quick or paper", options->profile));
    if (commands.gpu && !options->device) throw Error("--gpu: the processor computes the vectors; add --device");
    return verify(options->files, options->kind,
                  options->profile == "quick" ? VerifyProfile::quick : VerifyProfile::paper, std::cout, nullptr,
                  options->device ? VerifyOn::device : VerifyOn::processor);
  });
}

}  // namespace airlight::experiments::cli
