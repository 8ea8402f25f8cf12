// How close the renderer comes to the machine: calls of the error function per second in whole renders, against a bare
// loop of the same arithmetic from registers. Hidden: `airlight_tests "[rate]"` prints the figures of this machine.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>

#include "methods/fogshop/fogshop.h"
#include "scene/scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/methods/fogshop/kernel_rate_test.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "methods/fogshop/erf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

// Depth of `count` Gaussians at one vector of places, four Gaussians at a time: independent chains, nothing in memory.
double BareLoop(long count, double seed) {
  const hn::CappedTag<double, GaussianArrays::padding> d;
  const auto t = hn::Iota(d, seed);
  auto a = hn::Set(d, 0.3), sum = hn::Zero(d);
  const auto step = hn::Set(d, 1e-9), depth = hn::Set(d, 0.1), base = hn::Set(d, 0.5), middle = hn::Set(d, 3.0);
  for (long i = 0; i < count; i += 4) {
    for (int k = 0; k < 4; ++k) {
      const auto far = Erf_<Erf::precise>(d, hn::Mul(a, hn::Sub(t, middle)));
      sum = hn::MulAdd(depth, hn::Max(hn::Add(far, base), hn::Zero(d)), sum);
      a = hn::Add(a, step);
    }
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

int LaneCount() { return int(hn::Lanes(hn::CappedTag<double, GaussianArrays::padding>())); }

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {
HWY_EXPORT(BareLoop);
HWY_EXPORT(LaneCount);
}  // namespace airlight::fogshop

using namespace airlight;
using namespace airlight::fogshop;

namespace {

double seconds(const std::function<void()>& job) {
  const auto start = std::chrono::steady_clock::now();
  job();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Calls per second on `threads` threads, the best of several runs.
double bare_rate(int threads) {
  const long count = 2000000;
  double best = 0;
  std::vector<double> sink(threads);
  for (int run = 0; run < 7; ++run) {
    const double time = seconds([&] {
      scene::parallel_rows(threads, {threads, {}}, [&](int i) { sink[i] += HWY_DYNAMIC_DISPATCH(BareLoop)(count, i); });
    });
    best = std::max(best, double(count) * threads * HWY_DYNAMIC_DISPATCH(LaneCount)() / time);
  }
  for (const double sum : sink) CHECK(sum > 0);  // the loop was not left out
  return best;
}

}  // namespace

TEST_CASE("rate of the error function in renders, against a bare loop", "[.][rate]") {
  const Fogshop method;
  for (const int threads : {1, 2}) {
    const double bare = bare_rate(threads);
    std::printf("%d thread(s): bare loop %.3g million calls/s\n", threads, bare / 1e6);
    for (const char* name : {"f100", "a300", "count_967"})
      for (const std::map<std::string, std::string>& given :
           {std::map<std::string, std::string>{{"variant", "paper"}},
            {{"K", "24"}},
            {{"K", "64"}, {"edges", "plain"}, {"extrapolate", "false"}}}) {
        const auto scene = std::make_shared<const scene::Scene>(
            scene::load_scene(std::string(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/") + name + ".toml",
                              {{"film.width", "320"}, {"film.height", "240"}}));
        const auto prepared = method.prepare(scene, {method.settings(), given}, {threads, {}});
        double best = 0;
        for (int run = 0; run < 5; ++run) {
          const scene::Rendering rendering = prepared->render(view_of(*scene), {threads, {}});
          for (const scene::StageTime& stage : rendering.times)
            if (stage.name == "airlight")
              best = std::max(best, rendering.counters.at("erf_evaluations") / stage.seconds);
        }
        std::string settings;
        for (const auto& [key, value] : given) settings += " " + key + "=" + value;
        std::printf("  %s%s: %.3g million calls/s, %.0f %% of the bare loop\n", name, settings.c_str(), best / 1e6,
                    100 * best / bare);
      }
  }
}
#endif
