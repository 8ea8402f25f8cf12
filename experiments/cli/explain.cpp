#include <fmt/format.h>

#include "experiments/application/progress.h"
#include "experiments/application/renderers.h"
#include "experiments/application/solvers.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/scene_option.h"
#include "gpu/context.h"
#include "scene/base/device_check.h"
#include "scene/base/error.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {
namespace {

struct ExplainOptions {
  SceneOptions scene;
  std::string method;
  Pairs settings;
  bool verbose = false;
};

using Reasons = std::vector<std::string>;

std::string range(const scene::SettingSpec& spec) {
  using Type = scene::SettingSpec::Type;
  switch (spec.type) {
    case Type::flag:
      return "true or false";
    case Type::choice: {
      std::string all;
      for (const std::string& choice : spec.choices) all += (all.empty() ? "" : ", ") + choice;
      return all;
    }
    default:
      return spec.greatest >= 1e300 ? fmt::format(">= {:g}", spec.least)
                                    : fmt::format("{:g} to {:g}", spec.least, spec.greatest);
  }
}

std::string condition(const scene::SettingSpec& spec) {
  const std::string text = scene::read_condition(spec);
  return text.empty() ? "" : "; read only with " + text;
}

// Prints a renderer's or solver's settings, and why it cannot do what it is given; false if it cannot.
bool explain_component(const scene::Component& c, const scene::Settings& settings, const Reasons& reasons,
                       const std::string& cannot) {
  fmt::print("\n{}: {}\n", c.name(), c.about());
  if (const std::string device = c.device(); !device.empty()) fmt::print("  on {}\n", device);
  fmt::print("  settings (name = value here; range; meaning)\n");
  for (const scene::SettingSpec& spec : c.settings())
    fmt::print("    {} = {}; {}; {}{}\n", spec.name, settings.text(spec.name), range(spec), spec.doc, condition(spec));
  if (reasons.empty()) return true;
  fmt::print("  {}:\n", cannot);
  for (const std::string& reason : reasons) fmt::print("    {}\n", reason);
  return false;
}

void explain_renderer(const scene::Renderer& renderer, const std::shared_ptr<const scene::Scene>& scene,
                      const Pairs& given) {
  const scene::Settings settings(renderer.settings(), given, renderer.name());
  if (!explain_component(renderer, settings, renderer.supports(*scene, settings), "cannot render this scene")) return;
  Progress progress("preparing " + renderer.name());
  const auto prepared = renderer.prepare(scene, settings, progress.execution(0));
  fmt::print("  stages\n");
  for (const scene::Stage& stage : prepared->stages())
    fmt::print("    {:9} {}: {}\n", stage.kept ? "computes" : "leaves out", stage.name, stage.reason);
  for (const scene::StageTime& time : prepared->prepare_times())
    fmt::print("    prepared  {} in {:.3g} s\n", time.name, time.seconds);
}

void explain_solver(const scene::Solver& solver, const scene::FlowProblem& flow, const Pairs& given) {
  const scene::Settings settings(solver.settings(), given, solver.name());
  if (explain_component(solver, settings, solver.supports(flow, settings), "cannot solve this flow"))
    scene::check_device(solver);
}

// One line for each: what it is, or the first reason why it cannot do what it is given.
template <class Components, class Input>
void list(const Components& components, const Input& input, const std::string& what) {
  std::string can, cannot;
  for (const auto& c : components) {
    Reasons reasons;
    try {
      if (!c->device().empty()) gpu::Context::get();  // throws where there is none
      reasons = c->supports(input, scene::Settings(c->settings(), {}, c->name()));
      if (reasons.empty()) scene::check_device(*c);
    } catch (const Unavailable& reason) {
      reasons.push_back(fmt::format("not available on this machine: {}", reason.what()));
    }
    const std::string more = reasons.size() > 1 ? fmt::format(" (and {} more)", reasons.size() - 1) : "";
    (reasons.empty() ? can : cannot) +=
        fmt::format("  {:28} {}{}\n", c->name(), reasons.empty() ? c->about() : reasons.front(), more);
  }
  if (!can.empty()) fmt::print("\ncan {}:\n{}", what, can);
  if (!cannot.empty()) fmt::print("\ncannot {}:\n{}", what, cannot);
  fmt::print("\nSettings and stages: --method NAME for one of them, --verbose for all.\n");
}

// Each component, or the one that was asked for; what this machine lacks is told.
template <class Components, class Explain>
void explain_each(const Components& components, const std::string& method, const Explain& explain_one) {
  for (const auto& c : components) {
    if (!method.empty() && c->name() != method) continue;
    try {
      explain_one(*c);
    } catch (const Unavailable& reason) {
      if (!method.empty()) throw;
      fmt::print("  not available on this machine: {}\n", reason.what());  // the others go on
    }
  }
}

int explain_flow(const ExplainOptions& options) {
  if (!options.method.empty()) find_solver(options.method, "--method");
  if (!options.scene.convert.empty()) throw Error("--convert: a flow has no media");
  if (!options.scene.camera.empty()) throw Error("--camera: a flow has no camera");
  const scene::FlowProblem flow = scene::load_flow(options.scene.file, options.scene.overrides);
  fmt::print("{}\n{}", flow.name, describe(flow));
  if (options.method.empty() && !options.verbose)
    list(all_solvers(), flow, "solve this flow");
  else
    explain_each(all_solvers(), options.method,
                 [&](const scene::Solver& solver) { explain_solver(solver, flow, options.settings); });
  return 0;
}

int explain(const ExplainOptions& options) {
  if (options.method.empty() && !options.settings.empty()) throw Error("--set: expected --method, whose setting it is");
  if (is_flow_file(options.scene.file)) return explain_flow(options);
  if (!options.method.empty()) find_renderer(options.method, "--method");
  const auto scene = load(options.scene, 0);
  fmt::print("{}\n{}", scene->name, describe(*scene));
  if (options.method.empty() && !options.verbose)
    list(all_renderers(), *scene, "render this scene");
  else
    explain_each(all_renderers(), options.method,
                 [&](const scene::Renderer& renderer) { explain_renderer(renderer, scene, options.settings); });
  return 0;
}

}  // namespace

void add_explain(Commands& commands) {
  const auto options = std::make_shared<ExplainOptions>();
  CLI::App* c =
      add_command(commands.app, "explain",
                  "which methods can render a scene or solve a flow, their settings, and what they leave out");
  add_scene_options(c, options->scene, "scene file or flow file (required)");
  c->add_option("--method,-m", options->method, "settings and stages of this renderer");
  c->add_flag("--verbose,-v", options->verbose, "settings and stages of all renderers");
  add_pairs(c, "--set", options->settings, "change a setting of the method");
  commands.add_limit(c);
  commands.add_data(c);
  commands.add_gpu(c);
  commands.add_unchecked(c);
  commands.on(c, [options] {
    require(options->scene.file, "SCENE");
    return explain(*options);
  });
}

}  // namespace airlight::experiments::cli
