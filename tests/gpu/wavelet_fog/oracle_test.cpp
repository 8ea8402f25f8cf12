// Exact optical depths of the oracle on the device: a film of one pixel from A towards a wall at B.
#include <Eigen/Geometry>

#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"
#include "tests/gpu/wavelet_fog/pictures.h"
#include "tests/oracle_vectors.h"

namespace oracle_test {

using namespace airlight;
using namespace airlight::gpu::test;
using test::json;
using test::number;
using test::numbers;

namespace {

// The vectors' map lies in x and y, their height is z.
Point3 upright(const json& v) { return {number(v[0]), number(v[2]), number(v[1])}; }

scene::HeightProfile profile_of(const json& v) {
  const std::string type = v.at("type");
  if (type == "layers") return scene::Layers{numbers(v.at("z")), numbers(v.at("v"))};
  if (type == "exp") return scene::ExponentialFall{number(v.at("z0")), number(v.at("H"))};
  return scene::SameAtAllHeights{};
}

std::shared_ptr<scene::Scene> scene_of(const json& v) {
  auto fog = std::make_shared<scene::Fogmap>();
  fog->map = scene::SplineMap(v.at("degree"), {{0, 0}, {v.at("width"), v.at("height")}}, numbers(v.at("coef")));
  fog->profile = profile_of(v.at("profile"));
  fog->x0 = number(v.at("origin")[0]), fog->z0 = number(v.at("origin")[1]), fog->cell = number(v.at("cell"));
  const Point3 a = upright(v.at("A")), b = upright(v.at("B"));
  auto made = std::make_shared<scene::Scene>();
  made->name = v.at("id");
  made->width = made->height = 1;
  const Vec3 along = b - a;
  made->camera =
      scene::look_at(a, b, along.cross(Vec3::UnitY()).norm() > 1e-3 * along.norm() ? Vec3::UnitY() : Vec3::UnitX());
  made->camera.kind = scene::Camera::Kind::orthographic;
  made->ambient_in_scatter = Rgb::Ones();
  scene::Medium medium;
  medium.field = scene::FogmapPointer(fog);
  medium.sigma_t = Rgb::Constant(number(v.at("sigma")));
  made->media = {medium};
  scene::Surface wall;
  wall.shape = scene::Plane{b, -along.normalized()};
  made->surfaces = {wall};
  finish(*made);
  return made;
}

// From the opacity where that has more digits.
double depth_of(const scene::Film& film) {
  const double opacity = film.layer("ambient")[0];
  return opacity < 0.5 ? -std::log1p(-opacity) : -std::log(double(film.layer("transmittance")[0]));
}

// Looks at every vector of a kind that single precision is meant for.
template <class Depth>
int look_at_all(const char* kind, Depth&& depth) {
  int looked_at = 0;
  for (const json& v : test::vectors_of("wavelet_fog", kind)) {
    if (v.at("rtol_f32").is_null() || v.at("A") == v.at("B")) continue;
    const std::vector<double> coefficients = numbers(v.at("coef"));
    if (*std::min_element(coefficients.begin(), coefficients.end()) < 0) continue;  // no fog, but a detail alone
    const auto scene = scene_of(v);
    const gpu::wavelet_fog::WaveletFog method;
    if (!method.supports(*scene, {method.settings(), {}}).empty()) continue;  // beyond single precision, it says
    const double expected = number(v.at("expected").at("optical_depth"));
    if (expected > 60) continue;  // nothing is left of the transmittance
    const double rtol = number(v.at("rtol_f32")), got = depth(v, scene);
    CAPTURE(v.at("id").get<std::string>(), expected, got, got / expected - 1);
    // Around a transmittance of 1 or 0 the film's own rounding is added.
    CHECK(std::abs(got - expected) <= (expected == 0 ? rtol : rtol * expected) + 1.2e-7);
    ++looked_at;
  }
  return looked_at;
}

}  // namespace

DEVICE_TEST_CASE("wavelet fog: the oracle's optical depths on the GPU", "[gpu][wavelet_fog]") {
  for (const char* variant : {"direct", "skip"}) {
    const int looked_at = look_at_all("optical_depth", [&](const json&, const auto& scene) {
      return depth_of(render(gpu::wavelet_fog::WaveletFog(), scene, {{"variant", variant}}).film);
    });
    CHECK(looked_at >= 20);
  }
}

DEVICE_TEST_CASE("wavelet fog: the oracle's levels on the GPU", "[gpu][wavelet_fog]") {
  for (const char* variant : {"paper", "tele"}) {
    const int looked_at = look_at_all("multires", [&](const json& v, const auto& scene) {
      const bool restricted = v.at("family") == "restrict";
      const Given given{{"variant", variant},
                        {"coarse", restricted ? "restricted" : "wavelet"},
                        {"levels", fmt::format("{}", v.at("levels").get<int>())},
                        {"mu", fmt::format("{}", number(v.at("mu")))}};
      return depth_of(render(gpu::wavelet_fog::WaveletFog(), scene, given).film);
    });
    CHECK(looked_at >= 8);
  }
}

}  // namespace oracle_test
