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
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "experiments/cli/commands.h"
#include "experiments/cli/rate_record.h"
#include "experiments/progress.h"
#include "methods/fogshop/airlight_pass.h"
#include "methods/fogshop/bare_loop.h"
#include "methods/fogshop/fogshop.h"
#include "methods/fogshop/model.h"
#include "methods/fogshop/surface_pass.h"
#include "scene/error.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {
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

// Seconds that all threads together take for one evaluation, the best so far: other programs only ever make it slower.
class BareTime {
 public:
  BareTime(BareLoop what, fogshop::Erf erf) : what_(what), erf_(erf) {}
  void measure(const scene::Execution& execution, bool processor_time) {
    constexpr long count = 400000;  // some milliseconds
    std::vector<double> sums(execution.threads);
    const double time = seconds_of(
        [&] {
          scene::parallel_rows(execution.threads, execution,
                               [&](int i) { sums[i] = fogshop::bare_loop(what_, erf_, count, i); });
        },
        processor_time);
    for (const double sum : sums)
      if (sum == 0 || !std::isfinite(sum)) throw Error("the bare loop was left out");  // by the compiler
    best_ = std::min(best_, time / (double(count) * execution.threads));
  }
  double seconds() const { return best_; }

 private:
  BareLoop what_;
  fogshop::Erf erf_;
  double best_ = infinity;
};

void refuse(const scene::Scene& scene, const fogshop::Options& o) {
  const fogshop::Fog fog = fogshop::make_fog(scene.media);
  if (fog.sum.gaussians.empty() || !fog.grey() || !fog.one_albedo())
    throw Error(scene.name + ": rate counts one channel of Gaussians: expected grey fog of Gaussians");
  if (o.variant == fogshop::Options::Variant::voigt || o.noise_scale > 0 || o.downsample > 1 || o.sky_volume ||
      (o.variant == fogshop::Options::Variant::slices && !o.map))
    throw Error("rate measures variant = paper, and S with light maps, without noise, sky volume or downsample");
}

// As PreparedFogshop does it.
fogshop::Model prepare(const scene::Scene& scene, const fogshop::Options& o, const scene::Execution& execution) {
  fogshop::Model model = fogshop::make_model(scene, o);
  if (model.lights.empty()) throw Error(scene.name + ": rate needs a point light");
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

RateRow measure(const scene::Scene& scene, const Pairs& given, const RateOptions& options,
                const scene::Execution& execution) {
  const fogshop::Fogshop method;
  const scene::Settings settings(method.settings(), given, "rate");
  const fogshop::Options o = fogshop::read_options(settings);
  const auto reasons = method.supports(scene, settings);
  if (!reasons.empty()) throw Error(fmt::format("fogshop cannot render {}: {}", scene.name, reasons.front()));
  refuse(scene, o);
  const fogshop::Model model = prepare(scene, o, execution);
  const scene::View view = view_of(scene);
  double once = 0;
  const fogshop::ViewModel view_model = fogshop::make_view_model(model, view.camera.position, execution, once);
  const std::vector<double> distance = fogshop::first_hits(scene, view, execution).distance;

  BareTime erf(BareLoop::error_function, o.erf), crossing(BareLoop::crossing, o.erf), depth(BareLoop::depth, o.erf),
      term(BareLoop::paper_term, o.erf);
  double best = infinity;
  fogshop::AirlightImage image;
  for (int run = 0; run < options.runs; ++run) {
    for (BareTime* loop : {&erf, &crossing, &depth, &term}) loop->measure(execution, options.processor_time);
    best = std::min(best, seconds_of([&] { image = airlight_pass(model, view_model, view, distance, execution); },
                                     options.processor_time));
  }
  if (!(image.crossed > 0)) throw Error(scene.name + ": no ray meets a Gaussian");
  const double pairs = image.crossed, depths = model.paper() ? pairs : image.evaluations - pairs;
  const double evaluations = model.paper() ? pairs * double(model.lights.size()) : depths;
  const double bare =
      pairs * crossing.seconds() + depths * depth.seconds() + (model.paper() ? evaluations * term.seconds() : 0);
  return {settings.text("variant"),
          settings.text("erf"),
          model.paper() ? 0 : o.slices,
          execution.threads,
          pairs / double(distance.size()),
          evaluations / best / 1e6,
          evaluations / bare / 1e6,
          image.evaluations / best / 1e6,
          1e-6 / erf.seconds()};
}

// As the user would type it again.
std::string command_of(const RateOptions& options) {
  std::string out = fmt::format("airlight rate {} --runs {}", options.scene, options.runs);
  if (options.threads > 0) out += fmt::format(" --threads {}", options.threads);
  if (options.processor_time) out += " --processor-time";
  for (const auto& [name, value] : options.settings) out += fmt::format(" --set {}={}", name, value);
  for (const auto& [path, value] : options.overrides) out += fmt::format(" --override {}={}", path, value);
  return out;
}

}  // namespace

int rate(const RateOptions& options) {
  if (options.runs < 1) throw Error(fmt::format("--runs {}: expected 1 or more", options.runs));
  if (options.threads < 0) throw Error(fmt::format("--threads {}: expected 0 or more", options.threads));
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(options.scene, options.overrides));
  // The time of other threads that are running is only known to a tick of the system.
  if (options.processor_time && options.threads > 1)
    throw Error(fmt::format("--threads {}: --processor-time is that of one thread", options.threads));
  const int threads = options.processor_time ? 1
                      : options.threads > 0  ? options.threads
                                             : int(std::max(1u, std::thread::hardware_concurrency()));
  Progress progress("rate " + scene->name);
  const scene::Execution execution = progress.execution(threads);
  RateRun run;
  run.scene = scene->name;
  run.how = fmt::format("{}x{} pixels, fastest of {} runs, {}", scene->width, scene->height, options.runs,
                        options.processor_time ? "processor time" : "wall clock");
  run.command = command_of(options);
  std::vector<std::string> variants{"paper", "S"};
  const auto chosen = options.settings.find("variant");
  if (chosen != options.settings.end()) variants = {chosen->second};
  for (const std::string& variant : variants) {
    Pairs settings = options.settings;
    settings["variant"] = variant;
    run.rows.push_back(measure(*scene, settings, options, execution));
  }
  fmt::print("{}", rate_text(run));
  if (!options.out.empty()) write_rate_record(options.out, run);
  return 0;
}

}  // namespace airlight::experiments::cli
