// Cost of frames on the available device, by the processor's user time: with a software renderer, for
// any load of the machine.
//   airlight_tests "wavelet fog: times*"
#include <sys/resource.h>

#include "methods/wavelet_fog/authoring/canvas.h"
#include "scene/media/fogmap.h"
#include "tests/gpu/wavelet_fog/pictures.h"

namespace times_test {

using namespace airlight;
using namespace airlight::gpu::test;

namespace {

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
}

// A fogmap like those of wavelet_fog/map_size: 64 m a side, of any size in pixels, drawn smooth, in
// patches, or with hard edges.
std::shared_ptr<scene::Fogmap> drawn(const std::string& kind, int size) {
  wavelet_fog::authoring::Canvas canvas(size, size, 64. / size);
  wavelet_fog::authoring::Canvas::Noise noise;
  noise.seed = 5;
  noise.size = kind == "smooth" ? 32 : 16;
  noise.octaves = kind == "smooth" ? 2 : int(std::log2(size)) - 2;
  noise.low = kind == "smooth" ? 0.1 : -1.2;
  noise.high = 0.9;
  if (kind != "hard") canvas.noise(noise);
  wavelet_fog::authoring::Canvas::Brush brush{4};
  brush.hardness = 1;
  brush.value = 0.8;
  brush.mode = wavelet_fog::authoring::Canvas::Brush::Mode::paint;
  if (kind == "hard") canvas.stroke({{7, 17}, {27, 14}, {42, 24}, {56, 20}}, brush);
  if (kind == "hard") canvas.stroke({{10, 50}, {32, 40}, {52, 54}}, brush);
  auto fog = std::make_shared<scene::Fogmap>();
  fog->cell = 64. / size;
  fog->x0 = fog->z0 = -32 - 0.5 * fog->cell;
  fog->map = scene::SplineMap(1, {{0, 0}, {size, size}}, canvas.values());
  return fog;
}

}  // namespace

DEVICE_TEST_CASE("wavelet fog: times of variants on the GPU", "[.times]") {
  const gpu::wavelet_fog::WaveletFog method;
  for (const char* kind : {"smooth", "patchy", "hard"})
    for (const int size : {64, 1024}) {
      const auto scene = scene_of(drawn(kind, size), kind[0] == 's' ? 0.04 : 0.12, {0, 2, -34}, {0, 2, 0});
      scene->width = 160, scene->height = 120;
      double direct = 0;
      for (const char* variant : {"direct", "skip", "bound"}) {
        const Given given = std::string(variant) == "bound" ? Given{{"variant", variant}, {"levels", "4"}}
                                                            : Given{{"variant", variant}};
        const auto prepared = method.prepare(scene, {method.settings(), given}, {0, {}});
        scene::Execution none{0, {}};
        none.layers.emplace();
        const double cells = prepared->render(view_of(*scene), {0, {}}).counters.at("cells");
        double best = infinity;
        const int frames = size > 64 ? 1 : 4;
        for (int turn = 0; turn < 2; ++turn) {
          const double before = user_seconds();
          for (int frame = 0; frame < frames; ++frame) prepared->render(view_of(*scene), none);
          best = std::min(best, (user_seconds() - before) / frames);
        }
        if (direct == 0) direct = best;
        fmt::print("{} {}: {} {:.4f} s of user time, {:.2f} of direct, {:.0f} cells\n", kind, size, variant, best,
                   best / direct, cells);
      }
    }
}

}  // namespace times_test
