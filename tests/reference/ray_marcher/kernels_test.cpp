// The vector kernels against the plain path, bit for bit where they must not differ, to float accuracy where they may.
#include <hwy/targets.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/reference/ray_marcher/march_scenes.h"

namespace kernels_test {

using namespace airlight;
using namespace airlight::ray_marcher;

namespace {

// Largest difference over the largest value, of one layer.
double difference(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  double most = 0, scale = 1e-300;
  for (std::size_t i = 0; i < a.layer(layer).size(); ++i) {
    most = std::max(most, std::abs(double(a.layer(layer)[i]) - b.layer(layer)[i]));
    scale = std::max(scale, std::abs(double(b.layer(layer)[i])));
  }
  return most / scale;
}

bool same_bits(const scene::Film& a, const scene::Film& b) { return a.layers == b.layers; }

}  // namespace

// Sums of K <= 40 floats, each good to a few 2^-24 relative (trilinear: 7 roundings, plus positions good to 1e-6 of a
// voxel, 2e-6 of the density), and exponentials whose argument, up to 10, is good to as much: relative errors of some
// 1e-6 where they add up at worst, 1e-5 asked.
TEST_CASE("ray marcher: vector kernels agree with the plain path in double", "[ray_marcher]") {
  for (const auto& [name, scene] : assorted_scenes()) {
    for (const char* spacing : {"graded", "uniform"})
      for (const char* shadow : {"march", "exact"}) {
        Given given = {{"steps", "30"}, {"environment_directions", "8"}, {"spacing", spacing}, {"shadow", shadow}};
        if (shadow == std::string("march")) given["shadow_steps"] = "20";
        Given plain = given;
        plain["kernel"] = "scalar";
        const auto fast = render(scene, small_view(), given), slow = render(scene, small_view(), plain);
        INFO(name << ", " << spacing << ", shadow " << shadow);
        for (const char* layer : {"mean", "airlight", "surface", "transmittance"})
          CHECK(difference(fast.film, slow.film, layer) < 1e-5);
        CHECK(fast.counters.at("steps") == slow.counters.at("steps"));
        CHECK(fast.counters.at("rays") == slow.counters.at("rays"));
      }
  }
}

TEST_CASE("ray marcher: the same bits whatever the threads, the instruction set and the skipping", "[ray_marcher]") {
  for (const auto& [name, scene] : assorted_scenes()) {
    INFO(name);
    Given given = {{"steps", "30"}, {"shadow_steps", "20"}, {"environment_directions", "8"}};
    const auto one = render(scene, small_view(), given, 1);
    CHECK(same_bits(one.film, render(scene, small_view(), given, 2).film));
    CHECK(one.counters == render(scene, small_view(), given, 2).counters);
    // Without AVX-512 the same lanes are computed in smaller groups.
    hwy::SetSupportedTargetsForTest(HWY_AVX2);
    hwy::GetChosenTarget().DeInit();
    const auto narrow = render(scene, small_view(), given);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
    CHECK(same_bits(one.film, narrow.film));
    given["empty_space_skipping"] = "false";
    const auto all = render(scene, small_view(), given);
    CHECK(same_bits(one.film, all.film));
    CHECK(all.counters.at("shadow_steps") >= one.counters.at("shadow_steps"));
    CHECK(all.counters.at("steps") >= one.counters.at("steps"));
  }
}

// Lengths times 2, extinction over 2, intensities times 4 (irradiance is intensity over distance squared): every number
// in the computation is multiplied by a power of two, so that no rounding changes. Holds for whatever is computed from
// positions; directions and cosines stay.
TEST_CASE("ray marcher: scaling by a power of two changes no bit", "[ray_marcher]") {
  for (const double scale : {0.125, 64.0}) {
    for (const auto& [name, scene] : assorted_scenes()) {
      if (scene->geometry) continue;  // ray queries are not promised to scale
      const auto scaled = scaled_scene(*scene, scale);
      scene::View view = small_view();
      const Given given = {{"steps", "30"}, {"shadow_steps", "20"}, {"environment_directions", "8"}};
      const auto before = render(scene, view, given);
      view.camera.position *= scale;
      INFO(name << " times " << scale);
      CHECK(same_bits(before.film, render(scaled, view, given).film));
    }
  }
}

}  // namespace kernels_test
