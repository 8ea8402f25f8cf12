// Light on the device against the oracle's vectors, in single precision: 2e-5 of the largest entry.
#include <catch2/catch.hpp>

#include "gpu/legendre_fluids/light.h"
#include "gpu/legendre_fluids/paper_light.h"
#include "tests/gpu/device.h"
#include "tests/methods/legendre_fluids/light_scenes.h"
#include "tests/oracle_vectors.h"

namespace light_vectors_test {

using namespace airlight;
using namespace legendre_fluids::testing;
using test::Given;
using test::json;
using test::Tensor;

namespace {

constexpr double gate = 2e-5;

Vec3 padded(const json& v) {
  const Tensor t(v);
  return {t.values[0], t.values[1], t.values.size() > 2 ? t.values[2] : 0};
}

bool flat(const json& v) { return !v.at("R")[0][0].is_array(); }

// Of a medium that is the same for all z where the vector has two dimensions: L_0 there is 1/sqrt(2).
std::shared_ptr<scene::Scene> scene_of(const json& v) {
  const Tensor r(v.at("R"));
  scene::Medium medium =
      smoke(std::make_shared<const scene::LegendreBox>(unit_box, r.shape, r.array() * (flat(v) ? std::sqrt(2.0) : 1.0)),
            test::number(v.at("sigma")), test::number(v.at("beta")) / test::number(v.at("sigma")));
  if (const double g = test::number(v.at("g")); g != 0) medium.phase = scene::HenyeyGreenstein{g};
  auto scene = lit_scene(medium, -padded(v.at("omega_d")), -padded(v.at("omega_s")), 1, 1, 1e-6);
  std::get<scene::DirectionalLight>(scene->lights[0]).irradiance = Rgb::Constant(test::number(v.at("E_in")));
  return scene;
}

// Pictures of one pixel, each seen from a place along a direction: a layer's value.
class Eye {
 public:
  Eye(const json& v, const Given& given = {}) : scene_(scene_of(v)) {
    const gpu::legendre_fluids::LegendreLight method;
    prepared_ = method.prepare(scene_, {method.settings(), given}, {1, {}});
  }
  double at(const Point3& x, const Vec3& forward, const char* layer = "airlight") const {
    scene::View view = view_of(*scene_);
    view.camera =
        scene::look_at(x, x + forward, std::abs(forward.normalized()[1]) > 0.9 ? Vec3::UnitZ() : Vec3::UnitY());
    view.camera.kind = scene::Camera::Kind::orthographic;
    view.camera.height = 1e-9;
    return prepared_->render(view, {1, {}}).film.layer(layer)[0];
  }

 private:
  std::shared_ptr<scene::Scene> scene_;
  std::unique_ptr<scene::Prepared> prepared_;
};

Point3 on_face(const json& face, double u, double v) {
  const int axis = face.at("axis");
  Point3 x;
  x[axis] = face.at("side");
  x[axis == 0 ? 1 : 0] = u;
  x[axis == 2 ? 1 : 2] = v;
  return x;
}

double most_of(const Tensor& t) { return t.array().cwiseAbs().maxCoeff(); }

}  // namespace

DEVICE_TEST_CASE("legendre light on the device: rays of the vectors", "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "scatter")) {
    const Eye eye(v);
    double most = 0;
    for (const json& point : v.at("points")) most = std::max(most, test::number(point.at("E_s")));
    for (const json& point : v.at("points")) {
      CAPTURE(v.at("id"), point.dump());
      const Point3 x = padded(point.at("x"));
      CHECK(eye.at(x, -padded(v.at("omega_s"))) ==
            Approx(test::number(point.at("E_s"))).margin(gate * most).epsilon(0));
      const double arrives = test::number(v.at("E_in")) * eye.at(x, -padded(v.at("omega_d")), "transmittance");
      CHECK(arrives == Approx(test::number(point.at("E_d"))).margin(gate * test::number(v.at("E_in"))).epsilon(0));
    }
  }
  for (const json& v : test::vectors_of("legendre_fluids", "image")) {
    const Eye eye(v);
    const Tensor expected(v.at("E_s"));
    std::size_t at = 0;
    for (const double y : Tensor(v.at("u")).values)
      for (const double z : Tensor(v.at("v")).values)
        CHECK(eye.at(on_face(v.at("face"), y, z), -padded(v.at("omega_s"))) ==
              Approx(expected.values[at++]).margin(gate * most_of(expected)).epsilon(0));
  }
}

// Each pixel a picture of one, with the vector's depth and background behind the medium.
DEVICE_TEST_CASE("legendre light on the device: airlight of the vectors before a background",
                 "[gpu][legendre_fluids]") {
  const gpu::legendre_fluids::LegendreLight method;
  for (const json& v : test::vectors_of("legendre_fluids", "airlight")) {
    double most = 0;
    for (const json& pixel : v.at("pixels")) most = std::max(most, test::number(pixel.at("total")));
    for (const json& pixel : v.at("pixels")) {
      CAPTURE(v.at("id"), pixel.dump());
      auto scene = scene_of(v);
      const Vec3 forward = -padded(v.at("omega_s"));
      scene->camera = scene::look_at(padded(pixel.at("x")), padded(pixel.at("x")) + forward, Vec3::UnitY());
      scene->camera.kind = scene::Camera::Kind::orthographic;
      scene->camera.height = 1e-9;
      scene::Backdrop behind{1, 1, {}, {float(test::number(pixel.at("depth")))}, true};
      behind.radiance.assign(3, float(test::number(pixel.at("background"))));
      scene->backdrops = {std::make_shared<const scene::Backdrop>(behind)};
      finish(*scene);
      const scene::Film film = test::picture(method, scene);
      const auto check = [&](const char* layer, const char* name) {
        CHECK(film.layer(layer)[0] == Approx(test::number(pixel.at(name))).margin(gate * most).epsilon(0));
      };
      check("airlight", "airlight");
      check("surface", "attenuated");
      check("mean", "total");
      CHECK(film.layer("transmittance")[0] ==
            Approx(std::exp(-test::number(pixel.at("tau_view")))).margin(gate).epsilon(0));
    }
  }
}

DEVICE_TEST_CASE("legendre light on the device: upwind systems of the vectors, and their image",
                 "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "upwind-galerkin")) {
    CAPTURE(v.at("id"));
    const auto scene = scene_of(v);
    legendre_fluids::PaperOptions options;
    options.n = v.at("n");
    options.solver.closure = legendre_fluids::Closure::upwind;
    const std::vector<scene::DirectionalLight> lights{std::get<scene::DirectionalLight>(scene->lights[0])};
    gpu::Context& context = gpu::Context::get();
    const gpu::Use use(context);
    const legendre_fluids::PaperMedium media = legendre_fluids::paper_medium(*scene);
    gpu::legendre_fluids::PaperSystems systems(context, media, lights, options, {true, true, !flat(v)});
    systems.begin();
    // In two dimensions L_0 along z is left out of the coefficients.
    const double scale = (flat(v) ? std::sqrt(0.5) : 1) * test::number(v.at("E_in"));
    const Tensor direct(v.at("E_d_coeffs")), scattered(v.at("E_s_coeffs"));
    CHECK((scale * systems.direct().at(0) - direct.array()).cwiseAbs().maxCoeff() < gate * most_of(direct));
    gpu::Frame frame(context);
    scene::Rendering rendering{scene::Film(1, 1), {}, {}};
    frame.begin({1, {}});
    systems.solve_scattered(frame, padded(v.at("omega_s")).normalized());
    frame.finish(rendering);
    REQUIRE(systems.keep_up(frame));
    const std::vector<float> series = systems.faces().download<float>();
    const scene::TensorShape shape = systems.shape();
    double worst = 0;
    std::size_t at = 0;
    for (int i = 0; i < shape[0]; ++i)
      for (int j = 0; j < shape[1]; ++j)
        for (int k = 0; k < shape[2]; ++k, ++at) {
          const double norm = std::sqrt((i + 0.5) * (j + 0.5) * (k + 0.5));
          const double got = (flat(v) ? std::sqrt(0.5) : 1) * systems.scale()[0] * series[at] / norm;
          worst = std::max(worst, std::abs(got - scattered.values[at]));
        }
    CHECK(worst < gate * most_of(scattered));
    if (!v.contains("E_s_image")) continue;
    const Eye eye(v, {{"variant", "paper"}, {"closure", "upwind"}, {"n", std::to_string(options.n)}});
    const Tensor expected(v.at("E_s_image"));
    at = 0;
    for (const double y : Tensor(v.at("u")).values)
      for (const double z : Tensor(v.at("v")).values) {
        const Point3 x = on_face(v.at("face"), y, z) + padded(v.at("omega_s"));  // before the face
        CHECK(eye.at(x, -padded(v.at("omega_s"))) ==
              Approx(expected.values[at++]).margin(gate * most_of(expected)).epsilon(0));
      }
  }
}

}  // namespace light_vectors_test
