// The stress list of section 10 of the specification on the device: what each row asks for, and (row 30) the processor's picture.
#include <set>
#include <string>

#include "gpu/compensated_ray_marching/compensated_ray_marching.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "tests/gpu/device.h"
#include "tests/methods/compensated_ray_marching/stress_scenes.h"

namespace stress_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

const compensated_ray_marching::CompensatedRayMarching cpu;
const gpu::compensated_ray_marching::CompensatedRayMarching device;

}  // namespace

DEVICE_TEST_CASE("compensated march on the device, stress list: the processor's pictures",
                 "[gpu][stress][compensated_ray_marching][slow][thorough]") {
  const bool paper = GENERATE(false, true);
  std::set<int> compared;
  std::set<std::string> deep;  // transmittances of row 22
  for (const StressScene& s : StressScenes::all()) {
    if (!(paper ? s.for_paper : s.for_grid)) continue;
    Given given = given_of(s, paper);
    if (paper) {
      given["iterations"] = "6";  // before rounding steers: paper_test.cpp
    } else {
      // Few, but where the row's bounds on brightness are those of twelve.
      given.try_emplace("cells", s.row == 5 || s.row == 7 ? "12" : "8");
    }
    const std::string passing = s.given.count("transmittance") ? s.given.at("transmittance") : "hyb";
    CAPTURE(paper, s.row, s.what, s.sigma, passing);
    const auto reasons = device.supports(*s.scene, {device.settings(), given});
    CAPTURE(reasons);
    REQUIRE(reasons.empty() == s.for_device);
    if (!reasons.empty()) {
      CHECK_THAT(reasons.front(), Contains("in single precision"));
      continue;
    }
    const scene::Film film = picture(device, s.scene, given);
    check_stress(s, film, paper);
    if (s.row == 22) deep.insert(passing);
    if (s.sigma > 50) continue;
    const scene::Film truth = picture(cpu, s.scene, given);
    for (const char* layer : {"mean", "airlight", "transmittance"}) {
      CAPTURE(layer);
      CHECK(relative_l2(film, truth, layer) <= 1e-4 + 20 * gpu::test::injected_error());
    }
    compared.insert(s.row);
  }
  std::set<int> rows{1, 2, 3, 4, 5, 6, 8, 12, 13, 14, 15, 16, 17, 18, 23, 24, 26, 27, 28};
  if (paper) rows.erase(5);
  CHECK(compared == rows);
  CHECK(deep == (paper ? std::set<std::string>{"directional", "hyb", "ol", "series"} : std::set<std::string>{"ol"}));
}

}  // namespace stress_test
