// A map of 8192 x 8192: read, decomposed and rendered within 2 GiB and a minute each. Hidden: it takes half a gigabyte of file
// writing and reading.
#include <sys/resource.h>

#include <catch2/catch.hpp>

#include "methods/wavelet_fog/wavelet_fog.h"
#include "scene/base/stopwatch.h"
#include "scene/film/grey_image.h"
#include "tests/pictures.h"
#include "tests/temporary_folder.h"

namespace large_map_test {

using namespace airlight;
using namespace airlight::test;

namespace {

double peak_gib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / (1 << 20);
}

std::unique_ptr<scene::Prepared> method_of(const std::string& variant, std::shared_ptr<const scene::Scene> scene) {
  const wavelet_fog::WaveletFog method;
  return method.prepare(std::move(scene), {method.settings(), {{"variant", variant}}}, {0, {}});
}

}  // namespace

TEST_CASE("wavelet fog: a map of 8192 x 8192 within 2 GiB and a minute", "[.][wavelet_fog_large]") {
  // One variant a process, since memory has its peak once: AIRLIGHT_LARGE names it.
  const char* named = std::getenv("AIRLIGHT_LARGE");
  const std::string variant = named ? named : "polar";
  constexpr int side = 8192;
  const TemporaryFolder folder;
  {
    scene::GreyImage image{side, side, std::vector<double>(std::size_t(side) * side), ""};
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i)
        image.values[std::size_t(j) * side + i] = std::max(0.0, std::sin(0.013 * i) * std::sin(0.011 * j));
    scene::write_grey_image(folder.file("map.png"), image);
  }
  const double before = peak_gib();
  scene::Stopwatch watch;
  auto scene = std::make_shared<scene::Scene>(scene::parse_scene(
      "ambient_in_scatter = 0.8\n[film]\nwidth = 160\nheight = 120\n[camera]\nposition = [4000, 2, 4000]\n"
      "look_at = [6000, 0, 6500]\n[[medium]]\ntype = 'fogmap'\nfile = 'map.png'\ncell = 1\nsigma_t = 0.002\n"
      "profile = { type = 'layers', heights = [0, 30], factors = [1, 0] }\nregion = { type = 'slab', lo = -50, hi = 50 }\n",
      "large", folder.path().string()));
  const double load = watch.lap();
  const auto prepared = method_of(variant, scene);
  const double prepare = watch.lap();
  const scene::Rendering rendering = prepared->render(view_of(*scene), {0, {}});
  const double render = watch.lap();
  fmt::print("{}: load {:.1f} s, prepare {:.1f} s, render {:.1f} s; peak {:.2f} GiB (file made with {:.2f})\n", variant,
             load, prepare, render, peak_gib(), before);
  CHECK(load + prepare < 60);
  CHECK(peak_gib() < 2);
  double least = 1, most = 0;
  for (const float v : rendering.film.layer("transmittance")) {
    least = std::min(least, double(v));
    most = std::max(most, double(v));
  }
  CHECK(least >= 0);
  CHECK(most <= 1);
  CHECK(most - least > 0.5);
}

}  // namespace large_map_test
