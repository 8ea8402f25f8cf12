// The scene that a command is given, with what its options change.
#pragma once
#include <memory>
#include <string>

#include "experiments/cli/command_line.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {

// --convert, into `text`: "to=gaussians,count=600".
void add_convert_option(CLI::App* command, std::string& text);

// Loads the scene and, unless `convert` is empty, turns its media into another form: a line for each says what that lost.
std::shared_ptr<const scene::Scene> load(const std::string& path, const Pairs& overrides, const std::string& convert,
                                         int threads);

}  // namespace airlight::experiments::cli
