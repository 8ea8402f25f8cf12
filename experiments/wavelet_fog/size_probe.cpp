#include "experiments/wavelet_fog/size_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/wavelet_fog/authoring/canvas.h"
#include "methods/wavelet_fog/wavelet_fog.h"
#include "scene/base/stopwatch.h"
#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"

namespace airlight::experiments {
namespace {

constexpr double side = 64;  // [m] of every map
enum class Kind { smooth, patchy, hard };
const scene::Choices<Kind> kinds{{"smooth", Kind::smooth}, {"patchy", Kind::patchy}, {"hard", Kind::hard}};

// Draws a fog that looks alike at any size: finer maps have finer details of the noise, hard edges stay where they are.
std::vector<double> drawn(Kind kind, int size) {
  using airlight::wavelet_fog::authoring::Canvas;
  Canvas canvas(size, size, side / size);
  Canvas::Noise noise;
  noise.seed = 5;
  noise.size = kind == Kind::smooth ? 32 : 16;
  noise.octaves = kind == Kind::smooth ? 2 : std::max(1, int(std::log2(size)) - 2);
  noise.low = kind == Kind::smooth ? 0.1 : -1.2;
  noise.high = 0.9;
  if (kind != Kind::hard) {
    canvas.noise(noise);
    return canvas.values();
  }
  Canvas::Brush brush{3.5};
  brush.hardness = 1;
  brush.value = 0.8;
  brush.mode = Canvas::Brush::Mode::paint;
  canvas.stroke({{7, 17}, {27, 14}, {42, 24}, {56, 20}}, brush);
  brush.radius = 4;
  canvas.stroke({{10, 50}, {32, 40}, {52, 54}}, brush);
  brush.radius = 5;
  canvas.stroke({{40, 34}, {40, 34}}, brush);
  return canvas.values();
}

std::shared_ptr<const scene::Scene> make_scene(Kind kind, int size, int width) {
  auto scene = std::make_shared<scene::Scene>();
  scene->name = "map";
  scene->width = width;
  scene->height = width * 3 / 4;
  scene->camera = scene::look_at({0, 2, -34}, {0, 2, 0}, Vec3::UnitY());
  scene->camera.vertical_fov = 0.9;
  scene->ambient_in_scatter = Rgb::Constant(0.8);
  auto fog = std::make_shared<scene::Fogmap>();
  fog->cell = side / size;
  fog->x0 = fog->z0 = -0.5 * side - 0.5 * fog->cell;  // degree 1
  fog->map = scene::SplineMap(1, {{0, 0}, {size, size}}, drawn(kind, size));
  scene::Medium medium;
  medium.field = scene::FogmapPointer(std::move(fog));
  medium.region = scene::Slab{Vec3::UnitY(), -100, 100};
  medium.sigma_t = Rgb::Constant(kind == Kind::smooth ? 0.04 : 0.12);
  scene->media.push_back(medium);
  return scene;
}

}  // namespace

std::string WaveletMapSize::about() const {
  return "cells, coefficients and time of a picture against the size of the fogmap";
}

std::vector<scene::SettingSpec> WaveletMapSize::settings() const {
  return {scene::choice_setting("depth", "direct", {"direct", "skip", "bound", "tele", "polar", "paper"},
                                "how it comes about, as the variants of wavelet_fog"),
          scene::choice_setting("fog", Kind::smooth, kinds, "of 64 m a side, drawn at any size"),
          scene::integer_setting("size", "64", 2, 8192, "of the map, coefficients a side"),
          scene::integer_setting("levels", "3", 0, 12, "of paper, tele and bound"),
          scene::real_setting("tolerance", "0.03", 0, 1e9, "of bound, in optical depth"),
          scene::real_setting("mu", "0.4", 0, 1, "of paper and tele"),
          scene::integer_setting("width", "160", 4, 4096, "of the picture, pixels; the height is three quarters of it"),
          scene::integer_setting("runs", "7", 1, 1000, "timed pictures")};
}

std::vector<std::string> WaveletMapSize::figures() const { return {"rms", "greatest", "prepare_ms"}; }

Findings WaveletMapSize::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& execution) const {
  const auto scene = make_scene(s.choice("fog", kinds), int(s.integer("size")), int(s.integer("width")));
  const airlight::wavelet_fog::WaveletFog method;
  const std::string variant = s.text("depth");
  std::map<std::string, std::string> given{{"variant", variant}, {"levels", fmt::format("{}", s.integer("levels"))}};
  if (variant == "bound") given["tolerance"] = fmt::format("{}", s.real("tolerance"));
  if (variant == "paper" || variant == "tele") given["mu"] = fmt::format("{}", s.real("mu"));
  const scene::Settings settings(method.settings(), scene::without_unread(method.settings(), given));
  const scene::Settings exact(method.settings(), {{"variant", "direct"}});
  scene::Stopwatch watch;
  const auto prepared = method.prepare(scene, settings, execution);
  const double prepare = watch.lap();
  const scene::View view = scene::view_of(*scene);
  const scene::Rendering picture = prepared->render(view, execution);
  std::vector<double> seconds;
  for (int i = 0; i < s.integer("runs"); ++i) {
    watch.lap();
    prepared->render(view, execution);
    seconds.push_back(watch.lap());
  }
  const auto direct = method.prepare(scene, exact, execution)->render(view, execution);
  const auto &a = picture.film.layer("transmittance"), &b = direct.film.layer("transmittance");
  double sum = 0, greatest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double off = double(a[i]) - b[i];
    sum += off * off;
    greatest = std::max(greatest, std::abs(off));
  }
  Findings found;
  found.figures = {exactly("rms", std::sqrt(sum / double(a.size()))), exactly("greatest", greatest),
                   exactly("prepare_ms", 1e3 * prepare)};
  found.counters = picture.counters;
  found.counters["direct_cells"] = direct.counters.at("cells");
  set_time(found, seconds);
  return found;
}

}  // namespace airlight::experiments
