// Pictures against the path tracer capped at one scattering: statistical tests of equality, seeds fixed.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "experiments/equality.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "reference/path_tracer/renderer.h"
#include "tests/pictures.h"

namespace path_tracer_test {

using namespace airlight;
using airlight::test::picture;

// False alarms: 1e-3 for all scenes together.
TEST_CASE("shadow planes agree with the path tracer", "[shadow_planes][slow]") {
  const std::pair<const char*, const char*> samples_of[] = {
      {"shadow_planes/lamp", "128"},
      {"shadow_planes/boxes_1", "128"},
      {"shadow_planes/boxes_8", "128"},
      {"shadow_planes/spot", "12288"},  // most light is in a few pixels by the lamp
      {"shadow_planes/media", "768"},
      {"elephant_fog", "256"},
      {"shadow_planes/fig1", "512"},
      {"shadow_planes/fig7", "8192"},
      {"shadow_planes/fig7_shade", "10240"},
      {"shadow_planes/fig8a", "256"},
      {"shadow_planes/fig8b", "2048"},
      {"shadow_planes/fig8c", "256"},
      {"shadow_planes/edges", "128"},
      {"shadow_planes/layers_elephant", "128"},
      {"shadow_planes/layers_knot1", "256"}};
  const double alpha = 1e-3 / double(std::size(samples_of));
  for (const auto& [file, samples] : samples_of) {
    const auto scene = std::make_shared<scene::Scene>(
        scene::load_scene(std::string(AIRLIGHT_SOURCE_DIR "/experiments/scenes/") + file + ".toml",
                          {{"film.width", "32"}, {"film.height", "24"}}));
    for (scene::Surface& surface : scene->surfaces) surface.material = scene::Lambert{Rgb::Zero()};  // airlight alone
    finish(*scene);
    const scene::Film a = picture(shadow_planes::ShadowPlanes(), scene, {{"nodes", "32"}}, 0);
    const scene::Film b = picture(path_tracer::PathTracer(), scene, {{"max_order", "1"}, {"samples", samples}}, 0);
    const experiments::Equality e = experiments::compare_equal(a, b, "mean", ball_mask(*scene, view_of(*scene)), alpha);
    CAPTURE(file, experiments::text(e));
    if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("{}: {}\n", file, experiments::text(e));
    CHECK(e.equal);
    CHECK(e.detectable_bias < 0.03);
    // Twice the bias that it must be able to detect: it does.
    scene::Film darker = a;
    for (float& v : darker.layers["mean"]) v *= 0.94f;
    CHECK_FALSE(experiments::compare_equal(darker, b, "mean", ball_mask(*scene, view_of(*scene)), alpha).equal);
  }
}

}  // namespace path_tracer_test
