#include <fmt/format.h>

#include "experiments/application/progress.h"
#include "experiments/application/renderers.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/scene_option.h"
#include "scene/base/error.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {
namespace {

struct ExplainOptions {
  std::string scene, method, convert;
  Pairs settings, overrides;
};

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

void explain_one(const scene::Renderer& renderer, std::shared_ptr<const scene::Scene> scene, const Pairs& given) {
  fmt::print("\n{}: {}\n", renderer.name(), renderer.about());
  if (const std::string device = renderer.device(); !device.empty()) fmt::print("  on {}\n", device);
  const scene::Settings settings(renderer.settings(), given, renderer.name());
  fmt::print("  settings (name = value here; range; meaning)\n");
  for (const scene::SettingSpec& spec : renderer.settings())
    fmt::print("    {} = {}; {}; {}{}\n", spec.name, settings.text(spec.name), range(spec), spec.doc, condition(spec));
  const auto reasons = renderer.supports(*scene, settings);
  if (!reasons.empty()) {
    fmt::print("  cannot render this scene:\n");
    for (const std::string& reason : reasons) fmt::print("    {}\n", reason);
    return;
  }
  Progress progress("preparing " + renderer.name());
  const auto prepared = renderer.prepare(scene, settings, progress.execution(0));
  fmt::print("  stages\n");
  for (const scene::Stage& stage : prepared->stages())
    fmt::print("    {:9} {}: {}\n", stage.kept ? "computes" : "leaves out", stage.name, stage.reason);
  for (const scene::StageTime& time : prepared->prepare_times())
    fmt::print("    prepared  {} in {:.3g} s\n", time.name, time.seconds);
}

int explain(const ExplainOptions& options) {
  if (!options.method.empty()) find_renderer(options.method, "--method");
  const auto scene = load(options.scene, options.overrides, options.convert, 0);
  fmt::print("{}: {}x{} pixels\n", scene->name, scene->width, scene->height);
  for (const scene::Light& light : scene->lights) fmt::print("  light    {}\n", scene::light_name(light));
  for (std::size_t i = 0; i < scene->media.size(); ++i)
    fmt::print("  {}, {}, phase {}\n", scene::label(scene->media, i), scene::field_name(scene->media[i].field),
               scene::phase_name(scene->media[i].phase));
  for (const scene::Surface& surface : scene->surfaces) fmt::print("  surface  {}\n", surface.name);
  for (const auto& renderer : all_renderers()) {
    if (!options.method.empty() && renderer->name() != options.method) continue;
    try {
      explain_one(*renderer, scene, options.settings);
    } catch (const Unavailable& reason) {
      if (!options.method.empty()) throw;
      fmt::print("  not available on this machine: {}\n", reason.what());  // the others go on
    }
  }
  return 0;
}

}  // namespace

void add_explain(Commands& commands) {
  const auto options = std::make_shared<ExplainOptions>();
  CLI::App* c =
      add_command(commands.app, "explain", "what each renderer would compute or leave out in a scene, and why");
  c->add_option("SCENE", options->scene, "scene file");
  c->add_option("--method,-m", options->method, "only this one");
  add_pairs(c, "--set", options->settings, "a setting of the method");
  add_pairs(c, "--override", options->overrides, "a value of the scene file");
  add_convert_option(c, options->convert);
  commands.add_limit(c);
  commands.add_data(c);
  commands.add_gpu(c);
  commands.on(c, [options] {
    require(options->scene, "SCENE");
    return explain(*options);
  });
}

}  // namespace airlight::experiments::cli
