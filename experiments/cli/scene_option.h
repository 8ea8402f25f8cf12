// The scene that a command is given, with what its options change.
#pragma once
#include <memory>
#include <string>

#include "experiments/cli/command_line.h"
#include "scene/flow/flow_problem.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {

// --convert, into `text`: "to=gaussians,count=600".
void add_convert_option(CLI::App* command, std::string& text);

// Lights, media and surfaces, a line each.
std::string describe(const scene::Scene&);
// What a flow file holds: box, duration, sources.
std::string describe(const scene::FlowProblem&);
bool is_flow_file(const std::string& path);

// Loads the scene and, unless `convert` is empty, converts its media: a line for each says what that lost.
std::shared_ptr<const scene::Scene> load(const std::string& path, const Pairs& overrides, const std::string& convert,
                                         int threads);

}  // namespace airlight::experiments::cli
