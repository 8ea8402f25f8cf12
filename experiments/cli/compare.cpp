#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "experiments/application/say.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/output.h"
#include "experiments/judging/equality.h"
#include "experiments/judging/error_map.h"
#include "experiments/judging/metrics.h"
#include "scene/base/error.h"
#include "scene/renderer.h"

namespace airlight::experiments::cli {
namespace {

struct CompareOptions {
  std::string image, reference, scene, map;
  double map_top = 1;
  int map_shrink = 1;
  std::string layer = "mean";
  std::vector<std::string> metrics;
  Pairs most;        // metric=bound
  Pairs overrides;   // of the scene
  double alpha = 0;  // > 0: tests of equality at this false-alarm rate
};

double bound(const std::string& metric, const std::string& text) {
  check_metric_name(metric, "--max");
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !(value >= 0))
    throw Error(fmt::format("--max {}={}: expected a number >= 0", metric, text));
  return value;
}

// The least size that the error certainly has.
double certain(const Measure& m) {
  if (m.low <= 0 && m.high >= 0) return 0;
  return std::min(std::abs(m.low), std::abs(m.high));
}

// A path-traced picture whose batches were left out, as those of experiments are.
void warn_of_unknown_noise(const std::string& file, const scene::Film& film) {
  const auto samples = film.metadata.find("samples");
  if (samples == film.metadata.end() || film.has("batch.00") || film.has("se")) return;
  say(fmt::format("{}: warning: has {} samples a pixel and no batches: its noise is unknown, and counts as error", file,
                  samples->second));
}

int compare(const CompareOptions& options) {
  std::map<std::string, double> bounds;
  for (const auto& [metric, text] : options.most) bounds[metric] = bound(metric, text);
  for (const std::string& metric : options.metrics) check_metric_name(metric, "--metric");
  if (options.scene.empty() && !options.overrides.empty()) throw Error("--override: of what scene? expected --scene");
  const scene::Film image = scene::read_exr(options.image);
  const scene::Film reference = scene::read_exr(options.reference);
  warn_of_unknown_noise(options.image, image);
  warn_of_unknown_noise(options.reference, reference);
  Masks masks;
  masks.foreground = foreground_mask(reference);
  if (!options.scene.empty()) {
    const scene::Scene scene = scene::load_scene(options.scene, options.overrides);
    const scene::View view = scene::view_of(scene);
    if (view.width != reference.width || view.height != reference.height)
      throw Error(fmt::format("{}: film is {}x{}, and the reference {}x{}", options.scene, view.width, view.height,
                              reference.width, reference.height));
    masks.left_out = scene::ball_mask(scene, view);
  }
  std::vector<std::string> names = options.metrics.empty() ? metric_names() : options.metrics;
  for (const auto& [metric, value] : bounds)
    if (std::find(names.begin(), names.end(), metric) == names.end()) names.push_back(metric);

  if (!options.map.empty()) {
    scene::write_png(options.map, error_map(image, reference, options.layer, options.map_top, options.map_shrink));
    fmt::print("{}: error over the reference's mean, 0 (violet) to {:g} (yellow)\n", options.map, options.map_top);
  }
  int code = 0;
  for (const Measure& m : measure(names, image, reference, options.layer, masks)) {
    std::string line = fmt::format("{:24} {}", m.name, text(m));
    if (m.floor > 0) line += fmt::format("  (floor {:.3g})", m.floor);
    if (const auto found = bounds.find(m.name); found != bounds.end()) {
      // An undefined metric meets no bound.
      const bool good = !std::isnan(m.value) && certain(m) <= found->second;
      line += fmt::format("  {} {:g}", good ? "ok, bound" : "ABOVE", found->second);
      if (!good) code = 1;
    }
    fmt::print("{}\n", line);
  }
  if (options.alpha > 0) {
    const Equality e = compare_equal(image, reference, options.layer, masks.left_out, options.alpha);
    fmt::print("{}\n", text(e));
    if (!e.equal) code = 1;
  }
  return code;
}

}  // namespace

void add_compare(Commands& commands) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* c = add_command(commands.app, "compare", "errors of a picture against a reference, optionally with bounds");
  c->add_option("IMAGE", options->image, "OpenEXR file to judge (required)");
  c->add_option("REFERENCE", options->reference,
                "OpenEXR file to compare with (required); its batches of samples, if any, tell its noise");
  c->add_option("--layer", options->layer, "layer of the film (default mean: the whole picture)");
  c->add_option("--metric", options->metrics,
                fmt::format("metrics to print (default all): {}", fmt::join(metric_names(), ", ")));
  c->add_option("--scene", options->scene, "scene file: ignore pixels that touch the sphere of a light source");
  c->add_option("--map", options->map,
                "write this PNG: |difference| over the reference's mean luminance, in false colours");
  c->add_option("--map-top", options->map_top, "error that --map shows in yellow (default 1)");
  c->add_option("--map-shrink", options->map_shrink,
                "average the error over N x N pixels for each pixel of --map (default 1)")
      ->check(CLI::Range(1, 64));
  add_pairs(c, "--override", options->overrides, "the same changes of the scene file as in the render");
  add_pairs(c, "--max", options->most,
            "bound on a metric, e.g. rel_l2=0.05: exit 1 if the whole 95 % interval lies above it");
  c->add_option("--equal", options->alpha,
                "test whether the pictures differ by more than noise, at this false-alarm rate, e.g. 1e-4")
      ->type_name("RATE");
  commands.on(c, [c, options] {
    if (c->count("--equal") && !(options->alpha > 0 && options->alpha < 1))
      throw Error(fmt::format("--equal {}: expected a rate above 0 and below 1", options->alpha));
    if (!options->map.empty()) require_output(options->map, ".png");
    if (c->count("--map-top") && options->map.empty()) throw Error("--map-top: expected --map, whose range it is");
    if (c->count("--map-shrink") && options->map.empty()) throw Error("--map-shrink: expected --map, whose size it is");
    if (!(options->map_top > 0 && std::isfinite(options->map_top)))
      throw Error(fmt::format("--map-top {}: expected a number above 0", options->map_top));
    require(options->image, "IMAGE");
    require(options->reference, "REFERENCE");
    return compare(*options);
  });
}

}  // namespace airlight::experiments::cli
