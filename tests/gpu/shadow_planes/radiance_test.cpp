// L of the stress list on the device, as shaders of pixels compute it for a lit part of a ray: Ihat alone is in
// rule_test.cpp.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "gpu/program.h"
#include "gpu/shadow_planes/airlight_term.h"
#include "tests/gpu/device.h"
#include "tests/gpu/shader_folder.h"
#include "tests/methods/shadow_planes/vectors.h"

namespace radiance_test {

using namespace airlight;
using namespace shadow_planes_test;

namespace {

// Origin 0, direction z.
const char* const one_ray = R"(layout(local_size_x = LOCAL_SIZE_X) in;
#include "shadow_planes/ray.glsl"
#include "shadow_planes/airlight.glsl"
layout(std430, binding = 0) writeonly buffer Radiance { float radiance[]; };
uniform double from_place, to_place;
uniform float intensity;
void main() {
  radiance[0] = (intensity * lit_airlight(Line(dvec3(0), dvec3(0, 0, 1)), from_place, to_place)).x;
}
)";

}  // namespace

DEVICE_TEST_CASE("shadow planes: radiances of the stress list on the device", "[gpu][shadow_planes]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(one_ray);
  std::map<std::map<std::string, std::string>, std::unique_ptr<gpu::Program>> programs;
  int count = 0, vanished = 0;
  double worst = 0;
  for (const json& v : vectors_of("airlight")) {
    const std::string id = v.at("id");
    if (id[0] != 's') continue;
    const json& in = v.at("input");
    const double k = number(in.at("k_t")), T = number(in.at("T")), h = number(in.at("h")), x0 = number(in.at("x0")),
                 x1 = number(in.at("x1")), expected = number(v.at("expect").at("L"));
    scene::Scene scene;
    scene.lights = {scene::PointLight{{h, 0, T}, Rgb::Ones(), 0}};
    scene.media.emplace_back();
    scene.media[0].sigma_t = Rgb::Constant(k);
    scene.media[0].albedo = Rgb::Constant(number(in.at("albedo")));
    scene.media[0].phase = phase_function_of(in);
    shadow_planes::Options options;
    options.nodes = 16;
    options.stretch = 3;
    options.printed_phases = true;
    const auto shared = std::make_shared<const scene::Scene>(scene);
    const gpu::shadow_planes::AirlightTermsOnDevice airlight_terms(context, shared, options);
    REQUIRE(airlight_terms.count() == 1);
    auto definitions = airlight_terms.definitions(0, 0);
    definitions.merge(gpu::shadow_planes::shared_definitions());
    auto& program = programs[definitions];
    if (!program) program = std::make_unique<gpu::Program>(context, "test.comp", definitions);
    const gpu::Buffer radiance(context, "radiance", 4);
    airlight_terms.bind(*program, 0, 0);
    radiance.bind(0);
    program->set_double("from_place", x0);
    program->set_double("to_place", std::min(x1, 1e37));
    program->set("intensity", number(in.at("intensity")));
    program->dispatch(1);
    const double got = radiance.download<float>().front();
    CAPTURE(id, got, expected);
    ++count;
    if (expected < 1.2e-38) {  // no float, and never anything but 0
      CHECK((got >= 0 && got < 1.2e-38));
      ++vanished;
      continue;
    }
    // The rule's own greatest errors (rule_cases.h: murky, Henyey-Greenstein, isotropic), and the rounding of the depth
    // before the exponential.
    const double depth = k * (x0 + std::hypot(x0 - T, h)), error = std::abs(got - expected) / expected;
    CHECK(error < (in.at("phase") == "iso" ? 5e-6 : 1e-4) + 2e-7 * depth);
    worst = std::max(worst, error);
    if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("{}: L {:.6e}, error {:.1e}\n", id, got, error);
  }
  CHECK(count == 28);
  CHECK(vanished == 4);  // s05, s06, s13, s14
  INFO(worst);
  CHECK(worst < 1e-4);
}

}  // namespace radiance_test
