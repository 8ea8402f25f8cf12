// The stress list of section 10 of the specification on the device: what each row asks for, and (row 30) the processor's picture.
#include <set>

#include "gpu/compensated_ray_marching/compensated_ray_marching_gpu.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "tests/gpu/device.h"
#include "tests/methods/compensated_ray_marching/stress_scenes.h"

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

const compensated_ray_marching::CompensatedRayMarching cpu;
const gpu::CompensatedRayMarchingGpu device;

}  // namespace

TEST_CASE("compensated march on the device, stress list: the processor's pictures",
          "[gpu][stress][compensated_ray_marching]") {
  if (!gpu::test::device()) return;
  std::set<int> compared;
  for (const StressScene& s : StressScenes::all()) {
    if (!s.for_grid) continue;
    Given given = s.given;
    given.try_emplace("cells", "12");
    CAPTURE(s.row, s.what, s.sigma);
    const auto reasons = device.supports(*s.scene, {device.settings(), given});
    CAPTURE(reasons);
    REQUIRE(reasons.empty() == s.for_device);
    if (!s.for_device) {
      CHECK_THAT(reasons.front(), Contains("in single precision"));
      continue;
    }
    const scene::Film film = picture(device, s.scene, given), truth = picture(cpu, s.scene, given);
    check_stress(s, film, false);
    if (s.sigma > 50) continue;
    for (const char* layer : {"mean", "airlight", "transmittance"}) {
      CAPTURE(layer);
      CHECK(relative_l2(film, truth, layer) <= 1e-4 + 20 * gpu::test::injected_error());
    }
    compared.insert(s.row);
  }
  CHECK(compared == std::set<int>{1, 2, 3, 4, 5, 6, 8, 12, 13, 14, 15, 16, 17, 18, 23, 24, 26, 27, 28});
}
