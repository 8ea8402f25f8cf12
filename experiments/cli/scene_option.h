// The scene that a command is given, with what its options change.
#pragma once
#include <memory>
#include <string>

#include "experiments/cli/command_line.h"
#include "scene/flow/flow_problem.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {

// What a command is given, and how its options change it.
struct SceneOptions {
  std::string file;
  Pairs overrides;      // --override
  std::string convert;  // --convert: "to=gaussians,count=600"; empty: media stay as they are
  std::string camera;   // --camera: "fit", or empty for the file's own
};

// SCENE, --override, --convert and --camera.
void add_scene_options(CLI::App* command, SceneOptions&, const std::string& about_scene);

// Lights, media and surfaces, a line each.
std::string describe(const scene::Scene&);
// What a flow file holds: box, duration, sources.
std::string describe(const scene::FlowProblem&);
bool is_flow_file(const std::string& path);

// Loads the scene. With `camera` = fit its camera sees all media and surfaces that have an end; with `convert` its media are converted,
// and a line for each says what that lost.
std::shared_ptr<const scene::Scene> load(const SceneOptions&, int threads);

}  // namespace airlight::experiments::cli
