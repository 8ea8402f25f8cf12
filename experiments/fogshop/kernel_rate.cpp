// What is counted. One kernel evaluation is
//   paper  the airlight of one Gaussian from one light on one ray, Eqs. 10 to 13
//   S      the optical depth of one Gaussian up to one edge, or the end, of one ray, Eq. 31: at most K + 2 per pair
// and its arithmetic, besides that of the evaluation itself, is a share of what is done once per ray and Gaussian: the
// Gaussian's place on the ray, one exponential, the error function at the eye, and for `paper` the depth up to the end.
// The bare loop does these operations, and nothing else, as often as the picture does them, from registers.
//
// Not in the bare loop, so that it counts against the renderer: lists of Gaussians for tiles, the test which of them a
// ray meets, lanes that stay empty, all memory, the placement of the edges of S, its lookups in light maps and its sums
// over slices (exponentials and angles per edge, not per Gaussian), the airlight of the constant medium.
//
// The second share is the older, narrower measure: calls of the error function alone, whatever else there is to do.
#include "experiments/fogshop/kernel_rate.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>

#include "methods/fogshop/airlight_pass.h"
#include "methods/fogshop/bare_loop.h"
#include "methods/fogshop/fogshop.h"
#include "methods/fogshop/model.h"
#include "methods/fogshop/surface_pass.h"
#include "scene/base/error.h"
#include "scene/base/threads.h"

namespace airlight::experiments {
namespace {

using fogshop::BareLoop;

double seconds_of(const std::function<void()>& job, bool processor_time) {
  const auto now = [&] {
    return processor_time ? double(std::clock()) / CLOCKS_PER_SEC
                          : std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  const double start = now();
  job();
  return now() - start;
}

// Seconds that all threads together take for one of it.
double bare_seconds(BareLoop what, fogshop::Erf erf, const scene::Execution& execution, bool processor_time) {
  constexpr long count = 400000;  // some milliseconds
  std::vector<double> sums(execution.threads);
  const double time = seconds_of(
      [&] {
        scene::parallel_for(execution.threads, execution,
                            [&](int i) { sums[i] = fogshop::bare_loop(what, erf, count, i); });
      },
      processor_time);
  for (const double sum : sums)
    if (sum == 0 || !std::isfinite(sum)) throw Error("the bare loop was left out");  // by the compiler
  return time / (double(count) * execution.threads);
}

void refuse(const scene::Scene& scene, const fogshop::Options& o) {
  const fogshop::Fog fog = fogshop::make_fog(scene.media);
  if (fog.sum.gaussians.empty() || !fog.grey() || !fog.one_albedo())
    throw Error(scene.name + ": kernel_rate counts one channel of Gaussians: expected grey fog of Gaussians");
  if (o.noise_scale > 0 || o.downsample > 1 || o.sky_volume() ||
      (o.variant == fogshop::Options::Variant::slices && !o.map))
    throw Error("kernel_rate measures variant = paper, and S with light maps, without noise, sky volume or downsample");
}

// As PreparedFogshop does it.
fogshop::Model prepare(const scene::Scene& scene, const fogshop::Options& o, const scene::Execution& execution) {
  fogshop::Model model = fogshop::make_model(scene, o);
  if (model.lights.empty()) throw Error(scene.name + ": kernel_rate needs a point light");
  if (o.table) model.f_table = std::make_unique<fogshop::FTable>();
  for (fogshop::LightModel& light : model.lights) {
    if (model.paper())
      light.center_depth = fogshop::depths_to_centers(model, light.position, execution, model.evaluations);
    else
      light.map = std::make_unique<fogshop::LightMap>(model.gaussians, light.position, o.map_directions, o.map_edges,
                                                      o.erf, execution);
  }
  return model;
}

}  // namespace

std::string KernelRate::about() const {
  return "kernel evaluations per second of fogshop against a bare loop of the same arithmetic";
}

std::vector<scene::SettingSpec> KernelRate::settings() const {
  auto settings = fogshop::Fogshop().settings();
  settings.push_back(scene::integer_setting("runs", "15", 1, 10000, "pictures, each beside bare loops"));
  settings.push_back(scene::choice_setting("clock", "wall", {"wall", "processor"},
                                           "processor: of one thread, on a machine that others use"));
  return settings;
}

std::vector<std::string> KernelRate::figures() const {
  return {"pairs_per_ray", "evaluations", "bare_loop", "share", "erf_calls", "bare_loop_of_erf", "share_of_erf"};
}

Findings KernelRate::run(const ProbeInput& input, const scene::Settings& settings,
                         const scene::Execution& given) const {
  if (input.file.empty()) throw Error("kernel_rate needs a [[scene]]");
  const scene::Scene scene = scene::load_scene(input.file.string(), input.overrides);
  fogshop::Fogshop().require_support(scene, settings);
  const fogshop::Options o = fogshop::read_options(settings);
  refuse(scene, o);
  const bool processor_time = settings.text("clock") == "processor";
  scene::Execution execution = given;
  // The time of other threads that are running is only known to a tick of the system.
  execution.threads = processor_time ? 1 : scene::threads_for(given.threads);
  const fogshop::Model model = prepare(scene, o, execution);
  const scene::View view = view_of(scene);
  double once = 0;
  const fogshop::ViewModel view_model = fogshop::make_view_model(model, view.camera.position, execution, once);
  const std::vector<double> distance = fogshop::first_hits(scene, view, execution).distance;

  std::vector<double> evaluations, bare, share, erf_calls, bare_erf, erf_share;
  double pairs = 0;
  for (int run = 0; run < settings.integer("runs"); ++run) {
    const auto bare_time = [&](BareLoop loop) { return bare_seconds(loop, o.erf, execution, processor_time); };
    const double erf = bare_time(BareLoop::error_function), crossing = bare_time(BareLoop::crossing),
                 depth = bare_time(BareLoop::depth), term = bare_time(BareLoop::paper_term);
    fogshop::AirlightImage image;
    const double seconds =
        seconds_of([&] { image = airlight_pass(model, view_model, view, distance, execution); }, processor_time);
    if (!(image.crossed > 0)) throw Error(scene.name + ": no ray meets a Gaussian");
    pairs = image.crossed;
    const double depths = model.paper() ? pairs : image.evaluations - pairs;
    const double kernels = model.paper() ? pairs * double(model.lights.size()) : depths;
    const double bare_all = pairs * crossing + depths * depth + (model.paper() ? kernels * term : 0);
    evaluations.push_back(kernels / seconds / 1e6);
    bare.push_back(kernels / bare_all / 1e6);
    share.push_back(bare_all / seconds);
    erf_calls.push_back(image.evaluations / seconds / 1e6);
    bare_erf.push_back(1e-6 / erf);
    erf_share.push_back(image.evaluations * erf / seconds);
  }
  Findings found;
  found.figures = {exactly("pairs_per_ray", pairs / double(distance.size())),
                   measured("evaluations", evaluations),
                   measured("bare_loop", bare),
                   measured("share", share),
                   measured("erf_calls", erf_calls),
                   measured("bare_loop_of_erf", bare_erf),
                   measured("share_of_erf", erf_share)};
  found.counters = {{"threads", double(execution.threads)}};
  return found;
}

}  // namespace airlight::experiments
