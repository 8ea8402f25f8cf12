#include "experiments/cli/scene_option.h"

#include <fmt/format.h>

#include <sstream>

#include "experiments/application/build_info.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/say.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"
#include "scene/convert/medium_form.h"
#include "scene/load/parse_toml.h"

namespace airlight::experiments::cli {
namespace {

constexpr const char* option = "--convert";

scene::MediumConversion conversion_of(const std::string& text) {
  Pairs pairs;
  std::istringstream parts(text.ends_with(',') ? text + ',' : text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(fmt::format("{} {}: '{}' is no pair, expected to=FORM and its size, as in to=gaussians,count=600",
                              option, text, part));
    pairs[part.substr(0, equals)] = part.substr(equals + 1);
  }
  if (pairs.count("to") == 0) throw Error(fmt::format("{} {}: expected to=FORM", option, text));
  return scene::read_conversion(pairs, option);
}

}  // namespace

void add_convert_option(CLI::App* command, std::string& text) {
  command->add_option(option, text,
                      "convert all media first: to=gaussians,count=600 | to=legendre,order=12 | to=fogmap,cells=64 | "
                      "to=grid,voxels=64 | to=homogeneous; append cut=false for Gaussians that are not cut off, "
                      "lamps=true to replace suns by far point lights");
}

std::string describe(const scene::Scene& scene) {
  std::string out = fmt::format("  {} x {} pixels\n", scene.width, scene.height);
  for (const scene::Light& light : scene.lights) out += fmt::format("  light    {}\n", scene::light_name(light));
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    out += fmt::format("  {}, {}, phase {}\n", scene::label(scene.media, i), scene::field_name(scene.media[i].field),
                       scene::phase_name(scene.media[i].phase));
  for (const scene::Surface& surface : scene.surfaces) out += fmt::format("  surface  {}\n", surface.name);
  return out;
}

std::string describe(const scene::FlowProblem& flow) {
  const auto corner = [](const Vec3& v) { return fmt::format("({:g}, {:g}, {:g})", v[0], v[1], v[2]); };
  return fmt::format("  flow in {} dimensions, box from {} to {} m\n", flow.dimensions, corner(flow.box.lo),
                     corner(flow.box.hi)) +
         fmt::format("  {:g} s at {:g} frames a second, viscosity {:g} m^2/s\n", flow.duration, flow.frame_rate,
                     flow.viscosity) +
         fmt::format("  densities: {}; sources: {}; obstacles: {}; sets of particles: {}\n", 1 + flow.densities.size(),
                     flow.sources.size(), flow.obstacles.size(), flow.particles.size());
}

bool is_flow_file(const std::string& path) {
  return scene::load::parse_toml(scene::read_whole_file(path, scene::load::most_toml_bytes), path).contains("flow");
}

std::shared_ptr<const scene::Scene> load(const std::string& path, const Pairs& overrides, const std::string& convert,
                                         int threads) {
  if (convert.empty()) return std::make_shared<const scene::Scene>(scene::load_scene(path, overrides));
  const scene::MediumConversion conversion = conversion_of(convert);
  const scene::Scene scene = scene::load_scene(path, overrides);
  scene::ConvertedScene converted = [&] {
    try {
      return convert_media(scene, conversion, quiet_execution(threads), reference_id());
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", path, error.what()), error.exit_code());
    }
  }();
  for (const scene::ConvertedMedium& medium : converted.media)
    say(fmt::format("{} as {}: {} numbers in {:.2g} s, relative L2 error of the density {:.2g}, mass {:.4g} of before",
                    medium.medium, canonical(conversion), medium.numbers, medium.seconds, medium.density_error,
                    medium.mass_ratio));
  return std::make_shared<const scene::Scene>(std::move(converted.scene));
}

}  // namespace airlight::experiments::cli
