#include "experiments/choosing/truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "experiments/application/interrupt.h"
#include "experiments/application/renderers.h"
#include "experiments/driver/timing.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

constexpr int groups = 4;          // along each axis: of pixels that are left out in turn
constexpr const char* cap = "64";  // orders of scattering, in endless media that absorb nothing

}  // namespace

Truth trace_truth(const std::shared_ptr<const scene::Scene>& scene, const TrialSetup& setup, double allowed,
                  const Report& report) {
  Truth truth;
  truth.sparse = sparse_view(scene::view_of(*scene), setup.film);
  truth.left_out = scene::ball_mask(*scene, truth.sparse.small);
  const scene::View& view = truth.sparse.small;
  // Quadrature knows no environment as a light.
  const bool traced =
      setup.all_orders || std::any_of(scene->lights.begin(), scene->lights.end(),
                                      [](const scene::Light& light) { return !scene::is_delta(light); });
  const scene::Renderer& renderer = find_renderer(traced ? "path_tracer" : "deterministic", "reference");
  Pairs given{{"relative_tolerance", "1e-3"}};
  truth.about = "quadrature of light scattered once";
  if (traced) {
    given = {{"stream", std::to_string(setup.stream)}};
    if (!setup.all_orders) given["max_events"] = "1";
    truth.about =
        setup.all_orders ? "path tracing with all orders of scattering" : "path tracing of light scattered once";
    if (setup.all_orders &&
        !renderer.supports(*scene, scene::Settings(renderer.settings(), given, "reference")).empty()) {
      given["max_order"] = cap;
      truth.about = fmt::format("path tracing with up to {} orders of scattering", cap);
    }
  }
  for (long long samples = setup.samples;;) {
    if (traced) given["samples"] = std::to_string(samples);
    const double start = steady_seconds();
    std::atomic<double> expected = 0;  // [s] of a reference that takes too long
    scene::Execution how{
        setup.threads, [&](double fraction) {
          report(fraction);
          const double spent = steady_seconds() - start;
          if (traced && samples > 64 && spent > 0.1 * allowed && fraction > 0 && spent / fraction > allowed)
            expected = spent / fraction;
          return !interrupted() && expected == 0;
        }};
    try {
      truth.film = renderer.prepare(scene, scene::Settings(renderer.settings(), given, "reference"), how)
                       ->render(view, how)
                       .film;
    } catch (const scene::Interrupted&) {
      if (expected == 0) throw;
    }
    check_interrupted();
    if (expected == 0) {
      truth.samples = traced ? samples : 0;
      break;
    }
    samples = std::max(64LL, 64 * (long long)(double(samples) / 64 * 0.8 * allowed / expected));
  }
  require_finite(truth.film, fmt::format("{}: reference {}", scene->name, renderer.name()));
  const std::vector<float>& values = truth.film.layer("mean");
  if (std::all_of(values.begin(), values.end(), [](float x) { return x == 0; }))
    throw Error(
        fmt::format("{}: the reference is black, expected a scene with light: errors are relative to it", scene->name));
  if (traced) truth.about += fmt::format(", {} samples", truth.samples);
  return truth;
}

Measure error_of(const scene::Film& film, const Truth& truth, bool count_noise) {
  const ImageNoise noise = count_noise ? ImageNoise::counted : ImageNoise::removed;
  const auto without = [&](const std::vector<unsigned char>& mask) {
    return measure({"rel_l2"}, film, truth.film, "mean", {mask, {}}, noise).front();
  };
  Measure all = without(truth.left_out);
  if (truth.sparse.stride == 1) return all;
  std::vector<double> parts;
  for (int group = 0; group < groups * groups; ++group) {
    std::vector<unsigned char> mask = truth.left_out;
    for (int y = group / groups; y < film.height; y += groups)
      for (int x = group % groups; x < film.width; x += groups) mask[std::size_t(y) * film.width + x] = 1;
    parts.push_back(without(mask).value);
  }
  const Estimate chosen = jackknife(all.value, parts);
  if (!std::isfinite(chosen.low)) return all;
  all.low = std::max(0.0, all.value - std::hypot(all.value - all.low, chosen.value - chosen.low));
  all.high = all.value + std::hypot(all.high - all.value, chosen.high - chosen.value);
  all.below_floor = all.below_floor || all.low <= 0;
  return all;
}

}  // namespace airlight::experiments
