#include "experiments/compensated_ray_marching/smoke_flicker_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/application/build_info.h"
#include "experiments/application/renderers.h"
#include "scene/base/content_key.h"
#include "scene/base/content_store.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"

namespace airlight::experiments {
namespace {

using scene::Film;
using scene::Scene;
using Values = std::vector<double>;

const char* renderer_name = "compensated_ray_marching";
const std::map<std::string, std::string> closer = {
    {"cells", "48"}, {"levels", "16"}, {"tolerance", "1e-06"}, {"iterations", "1000"}};

std::shared_ptr<const Scene> frame_scene(const ProbeInput& input, const scene::Settings& s, int frame) {
  auto overrides = input.overrides;
  if (s.integer("step") > 0)
    overrides["medium.0.frame"] = std::to_string(s.integer("first") + frame * s.integer("step"));
  auto scene = std::make_shared<Scene>(scene::load_scene(input.file.string(), overrides));
  for (scene::Light& light : scene->lights) light = scene::turned(light, s.real("turn") * frame);
  scene::finish(*scene);
  return scene;
}

// Light that the smoke sends to the camera.
Values airlight_of(const Film& film) {
  const auto& layer = film.layer("airlight");
  return {layer.begin(), layer.end()};
}

Values closer_picture(const std::shared_ptr<const Scene>& scene, const scene::Execution& execution) {
  const scene::Renderer& renderer = find_renderer(renderer_name, "smoke_flicker");
  const scene::Settings settings(renderer.settings(), closer);
  const std::string name =
      fmt::format("flicker/{}.exr", content_key({scene->hash, settings.canonical(), source_id(), compiler()}));
  if (const auto kept = execution.store ? execution.store->find(name) : std::nullopt)
    return airlight_of(scene::read_exr(kept->string()));
  const Film film = renderer.prepare(scene, settings, execution)->render(view_of(*scene), execution).film;
  if (execution.store) execution.store->keep(name, [&](const auto& path) { scene::write_exr(path.string(), film); });
  return airlight_of(film);
}

double squares(const Values& a) {
  double sum = 0;
  for (const double value : a) sum += value * value;
  return sum;
}
Values minus(Values a, const Values& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

}  // namespace

std::string SmokeFlicker::about() const {
  return "error of compensated ray marching in the pictures of a sequence and from one to the next, against its own grid of "
         "48 cells";
}

std::vector<scene::SettingSpec> SmokeFlicker::settings() const {
  std::vector<scene::SettingSpec> specs = {
      scene::integer_setting("frames", "8", 2, 1000, "pictures"),
      scene::integer_setting("first", "0", 0, 100000, "frame of the medium's files"),
      scene::integer_setting("step", "0", 0, 1000,
                             "from frame to frame of the medium's files; 0: smoke that stands still"),
      scene::real_setting("turn", "0", -10, 10, "of the environment between two frames, about the y axis [rad]"),
      scene::flag_setting("warm", true, "a frame begins with the light of the one before")};
  const auto of_renderer = find_renderer(renderer_name, "smoke_flicker").settings();
  specs.insert(specs.end(), of_renderer.begin(), of_renderer.end());
  return specs;
}

std::vector<std::string> SmokeFlicker::figures() const {
  return {"rel_l2", "flicker", "change", "iterations", "frame_seconds"};
}

Findings SmokeFlicker::run(const ProbeInput& input, const scene::Settings& s, const scene::Execution& execution) const {
  if (input.file.empty()) throw Error("smoke_flicker: a [[scene]] is needed");
  const scene::Renderer& renderer = find_renderer(renderer_name, "smoke_flicker");
  const scene::Settings chosen(renderer.settings(), s.given(renderer.settings()));
  std::unique_ptr<scene::Prepared> prepared;
  Values truth, error, seconds;
  double errors = 0, truths = 0, error_changes = 0, changes = 0, iterations = 0;
  const int frames = int(s.integer("frames"));
  for (int frame = 0; frame < frames; ++frame) {
    const auto scene = frame_scene(input, s, frame);
    scene::Stopwatch watch;
    if (!prepared || !s.flag("warm") || !prepared->next(scene, execution))
      prepared = renderer.prepare(scene, chosen, execution);
    const scene::Rendering picture = prepared->render(view_of(*scene), execution);
    if (frame > 0) {
      seconds.push_back(watch.lap());
      iterations += picture.counters.at("iterations") / (frames - 1);
    }
    const Values true_now = closer_picture(scene, execution), error_now = minus(airlight_of(picture.film), true_now);
    errors += squares(error_now);
    truths += squares(true_now);
    if (frame > 0) {
      error_changes += squares(minus(error_now, error));
      changes += squares(minus(true_now, truth));
    }
    truth = true_now;
    error = error_now;
  }
  if (!(truths > 0 && changes > 0)) throw Error("smoke_flicker: nothing changes from frame to frame; turn or step it");
  Findings found;
  found.figures = {exactly("rel_l2", std::sqrt(errors / truths)),
                   exactly("flicker", std::sqrt(error_changes / changes)),
                   exactly("change", std::sqrt(changes / truths)), exactly("iterations", iterations),
                   measured("frame_seconds", seconds)};
  set_time(found, seconds);
  return found;
}

}  // namespace airlight::experiments
