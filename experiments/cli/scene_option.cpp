#include "experiments/cli/scene_option.h"

#include <fmt/format.h>

#include <cmath>
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

scene::MediumConversion conversion_of(const std::string& text) {
  Pairs pairs;
  std::istringstream parts(text.ends_with(',') ? text + ',' : text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(fmt::format("{} {}: '{}' is no pair, expected to=FORM and its size, as in to=gaussians,count=600",
                              "--convert", text, part));
    pairs[part.substr(0, equals)] = part.substr(equals + 1);
  }
  if (pairs.count("to") == 0) throw Error(fmt::format("--convert {}: expected to=FORM", text));
  return scene::read_conversion(pairs, "--convert");
}

std::string camera_text(const Point3& position, const Point3& target) {
  return fmt::format("{{ position = [{}, {}, {}], look_at = [{}, {}, {}] }}", position[0], position[1], position[2],
                     target[0], target[1], target[2]);
}

// The overrides, and with --camera fit that of the camera: from the front, above and the right, at the distance from which the ball around
// everything fills the default field of view of 0.7 rad.
Pairs with_camera(const SceneOptions& options) {
  Pairs overrides = options.overrides;
  if (options.camera.empty()) return overrides;
  if (options.camera != "fit") throw Error(fmt::format("--camera '{}': expected fit", options.camera));
  for (const auto& [path, value] : overrides)
    if (path == "camera" || path.starts_with("camera."))
      throw Error(fmt::format("--camera fit: expected no --override {}", path));
  overrides["camera"] = camera_text(Point3(0, 0, 1), Point3::Zero());  // any, until it is known what there is
  const scene::Scene scene = scene::load_scene(options.file, overrides);
  Box all;
  for (const scene::Medium& medium : scene.media)
    if (const Box box = bounding_box(medium); box.size().allFinite()) all = unite(all, box);
  if (scene.geometry) all = unite(all, scene.geometry->bounds());
  if (all.empty() || !(all.size().norm() > 0))
    throw Error(fmt::format("{}: --camera fit: expected a medium or a surface that has an end", options.file));
  const double radius = 0.5 * all.size().norm();
  overrides["camera"] =
      camera_text(all.center() + radius / std::sin(0.35) * Vec3(0.5, 0.35, 1).normalized(), all.center());
  return overrides;
}

}  // namespace

void add_scene_options(CLI::App* command, SceneOptions& options, const std::string& about_scene) {
  command->add_option("SCENE", options.file, about_scene);
  add_pairs(command, "--override", options.overrides, "change a value of the scene file, e.g. film.width=64");
  command->add_option("--convert", options.convert,
                      "convert all media first: to=gaussians,count=600 | to=legendre,order=12 | to=fogmap,cells=64 | "
                      "to=grid,voxels=64 | to=homogeneous; append cut=false for Gaussians that are not cut off, "
                      "lamps=true to replace suns by far point lights");
  command->add_option(
      "--camera", options.camera,
      "fit: replace the scene's camera, if any, by one that sees all media and surfaces that have an end");
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

std::shared_ptr<const scene::Scene> load(const SceneOptions& options, int threads) {
  const Pairs overrides = with_camera(options);
  if (options.convert.empty()) return std::make_shared<const scene::Scene>(scene::load_scene(options.file, overrides));
  const scene::MediumConversion conversion = conversion_of(options.convert);
  const scene::Scene scene = scene::load_scene(options.file, overrides);
  scene::ConvertedScene converted = [&] {
    try {
      return convert_media(scene, conversion, quiet_execution(threads), reference_id());
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", options.file, error.what()), error.exit_code());
    }
  }();
  for (const scene::ConvertedMedium& medium : converted.media)
    say(fmt::format("{} as {}: {} numbers in {:.2g} s, relative L2 error of the density {:.2g}, mass {:.4g} of before",
                    medium.medium, canonical(conversion), medium.numbers, medium.seconds, medium.density_error,
                    medium.mass_ratio));
  return std::make_shared<const scene::Scene>(std::move(converted.scene));
}

}  // namespace airlight::experiments::cli
