// A flow that is moved and drawn on the device: nothing comes down between step and picture.
#include <catch2/catch.hpp>

#include "experiments/application/flow_pictures.h"
#include "gpu/legendre_fluids/legendre_fluids.h"
#include "gpu/legendre_fluids/light.h"
#include "methods/legendre_fluids/light.h"
#include "scene/film/color_image.h"
#include "scene/media/legendre_box.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/methods/legendre_fluids/light_scenes.h"
#include "tests/temporary_folder.h"

namespace draw_flow_test {

using namespace airlight;
using namespace legendre_fluids::testing;

namespace {

constexpr int n = 6;

// With `second`, another density sinks through the first.
std::unique_ptr<scene::Flow> rising_blob(double background, double density = 1, bool second = false) {
  scene::FlowProblem problem;
  problem.box = unit_box;
  problem.velocity = scene::Swirl{0.5};
  problem.gravity = Vec3(0, -9.81, 0);
  problem.expansion = 1.0 / 300;
  problem.density = background;
  problem.blobs.push_back({Point3(0.2, -0.3, 0.1), 0.6, density, 30});
  if (second) {
    scene::NamedDensity other;
    other.name = "other";
    other.density = background;
    other.blobs.push_back({Point3(-0.1, 0.4, 0), 0.7, density, 0});
    problem.densities.push_back(other);
  }
  const gpu::legendre_fluids::LegendreFluids solver;
  return solver.start(std::make_shared<const scene::FlowProblem>(problem),
                      scene::Settings(solver.settings(), {{"n", std::to_string(n)}}), {});
}

// By the flow's density at Gauss points, drawn towards its mean by `share`.
scene::LegendrePointer box_of(const scene::Flow& flow, double share) {
  const scene::LegendrePoints points(n, n);
  Eigen::VectorXd values(n * n * n);
  Eigen::Index at = 0;
  for (const double x : points.node)
    for (const double y : points.node)
      for (const double z : points.node) values[at++] = flow.density(Point3(x, y, z));
  const auto& to = points.analysis;
  Eigen::VectorXd c = scene::along_axes(to, to, to, values, {n, n, n});
  c.tail(c.size() - 1) *= share;
  return std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{n, n, n}, c);
}

std::shared_ptr<scene::Scene> scene_with(scene::LegendrePointer field) {
  return lit_scene(smoke(std::move(field), 1.5), oblique_light, oblique_view, 24, 20);
}

// Steps and pictures by turns: warm ones send nothing, and bring down the status of a step alone, and of `systems`. The last picture, with
// all layers.
scene::Film drawn_while_nothing_comes_down(scene::Flow& flow, const test::Given& given, int systems = 0) {
  Eigen::VectorXd constant = Eigen::VectorXd::Zero(n * n * n);
  constant[0] = 1;
  const auto scene =
      scene_with(std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{n, n, n}, constant));
  const gpu::legendre_fluids::LegendreLight method;
  const auto picture = method.prepare(scene, {method.settings(), given}, {1, {}});
  const scene::View view = view_of(*scene);
  scene::Execution none{1, {}};
  none.layers.emplace();
  gpu::Traffic& traffic = gpu::Context::get().traffic();
  const auto frame = [&](const scene::Execution& execution) {
    flow.step(0.05);
    REQUIRE(gpu::legendre_fluids::draw_flow(*picture, flow));
    return picture->render(view, execution).film;
  };
  frame({1, {}});  // how many steps the paper's systems take
  frame(none);
  const gpu::Traffic before = traffic;
  for (int i = 0; i < 4; ++i) frame(none);
  const gpu::Traffic warm = traffic - before;
  CHECK(warm.bytes_down == 4 * 8 * (1 + systems));
  CHECK(warm.bytes_up == 0);
  CHECK(warm.allocations == 0);
  CHECK(warm.program_look_ups == 0);
  return frame({1, {}});
}

}  // namespace

DEVICE_TEST_CASE("legendre fluids on the device: drawn where they flow", "[gpu][legendre_fluids][thorough]") {
  const auto flow = rising_blob(0.5);
  const scene::Film drawn = drawn_while_nothing_comes_down(*flow, {});
  const scene::LegendrePointer field = box_of(*flow, 1);
  REQUIRE(!field->negative());
  const scene::Film expected = test::render(legendre_fluids::LegendreLight(), scene_with(field)).film;
  for (const auto& [layer, values] : expected.layers) {
    CAPTURE(layer);
    CHECK(gpu::test::quantile(expected, drawn, layer, 1) < 5e-6);
  }
}

DEVICE_TEST_CASE("legendre fluids on the device: drawn where they flow by the paper's systems",
                 "[gpu][legendre_fluids][thorough]") {
  const auto flow = rising_blob(0.5);
  for (const char* closure : {"upwind", "least_squares"}) {
    CAPTURE(closure);
    const test::Given given{{"variant", "paper"}, {"closure", closure}};
    const scene::Film drawn = drawn_while_nothing_comes_down(*flow, given, 2);
    const scene::Film expected =
        test::render(legendre_fluids::LegendreLight(), scene_with(box_of(*flow, 1)), given).film;
    CHECK(gpu::test::quantile(expected, drawn, "airlight", 1) < 2e-5);
  }
}

DEVICE_TEST_CASE("legendre fluids on the device: two kinds of smoke are drawn where they flow",
                 "[gpu][legendre_fluids]") {
  const auto flow = rising_blob(0.5, 1, true);
  const auto constant = std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{n, n, n},
                                                                   3 * Eigen::VectorXd::Unit(n * n * n, 0));
  const auto scene_of = [](const scene::LegendrePointer& one, const scene::LegendrePointer& other) {
    auto scene = scene_with(one);
    scene->media.push_back(smoke(other, 0.8));
    scene->media[1].albedo = Rgb(0.2, 0.5, 0.9);
    finish(*scene);
    return scene;
  };
  const auto scene = scene_of(constant, constant);
  const gpu::legendre_fluids::LegendreLight method;
  const auto picture = method.prepare(scene, {method.settings(), {}}, {1, {}});
  const scene::Film cold = picture->render(view_of(*scene), {1, {}}).film;
  const auto take_both = [&] {
    for (const int density : {0, 1})
      REQUIRE(gpu::legendre_fluids::draw_flow(*picture, *flow, density, std::size_t(density)));
  };
  scene::Execution none{1, {}};
  none.layers.emplace();
  flow->step(0.05);
  take_both();
  picture->render(view_of(*scene), none);
  gpu::Traffic& traffic = gpu::Context::get().traffic();
  const gpu::Traffic before = traffic;
  for (int frame = 0; frame < 2; ++frame) {
    flow->step(0.05);
    take_both();
    picture->render(view_of(*scene), none);
  }
  const gpu::Traffic warm = traffic - before;
  CHECK(warm.bytes_down == 2 * 8);  // how a step ended
  CHECK(warm.bytes_up == 0);
  CHECK(warm.allocations == 0);
  const scene::Film drawn = picture->render(view_of(*scene), {1, {}}).film;
  const auto density = [&](int which) { return std::get<scene::LegendrePointer>(flow->medium(which)); };
  const auto expected = scene_of(density(0), density(1));
  const scene::Film there = test::render(legendre_fluids::LegendreLight(), expected).film;
  for (const auto& [layer, values] : there.layers) {
    CAPTURE(layer);
    CHECK(gpu::test::quantile(there, drawn, layer, 1) < 5e-6);
  }
  CHECK_FALSE(gpu::legendre_fluids::draw_flow(*picture, *flow, 2));
  CHECK_FALSE(gpu::legendre_fluids::draw_flow(*picture, *flow, 0, 2));
  // The next frame of the scene has the scene's densities again, although they have not changed.
  REQUIRE(picture->next(std::make_shared<const scene::Scene>(*scene), {1, {}}));
  CHECK(picture->render(view_of(*scene), {1, {}}).film.layers == cold.layers);
}

// Whether the systems were solved to the end is looked at where no layer is asked for, too.
DEVICE_TEST_CASE("legendre fluids on the device: systems of frames that nobody sees",
                 "[gpu][legendre_fluids][thorough]") {
  const auto flow = rising_blob(0.01), dark = rising_blob(0, 1e300);
  Eigen::VectorXd constant = Eigen::VectorXd::Zero(n * n * n);
  constant[0] = 10;
  const auto scene =
      scene_with(std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{n, n, n}, constant));
  scene->media[0].sigma_t = Rgb::Constant(20);
  const gpu::legendre_fluids::LegendreLight method;
  for (const char* closure : {"upwind", "least_squares"}) {
    CAPTURE(closure);
    const test::Given given{{"variant", "paper"}, {"closure", closure}, {"n", "8"}};
    const auto picture = method.prepare(scene, {method.settings(), given}, {1, {}});
    const scene::View view = view_of(*scene);
    scene::Execution none{1, {}};
    none.layers.emplace();
    const double before = picture->render(view, none).counters.at("iterations");
    REQUIRE(gpu::legendre_fluids::draw_flow(*picture, *flow));
    const double unseen = picture->render(view, none).counters.at("iterations");
    CHECK(unseen > 1.25 * before);  // more than the first try takes
    REQUIRE(gpu::legendre_fluids::draw_flow(*picture, *flow));
    CHECK(picture->render(view, {1, {}}).counters.at("iterations") == unseen);
    // A value that is no number in single precision has no solution.
    REQUIRE(gpu::legendre_fluids::draw_flow(*picture, *dark));
    CHECK_THROWS_WITH(picture->render(view, none), Catch::Contains("left a residual of"));
  }
}

DEVICE_TEST_CASE("legendre fluids on the device: a density below 0 is drawn towards its mean",
                 "[gpu][legendre_fluids]") {
  const auto flow = rising_blob(0);
  flow->step(0.05);
  REQUIRE(box_of(*flow, 1)->negative());
  Eigen::VectorXd constant = Eigen::VectorXd::Zero(n * n * n);
  constant[0] = 1;
  const auto scene =
      scene_with(std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{n, n, n}, constant));
  const gpu::legendre_fluids::LegendreLight method;
  const auto picture = method.prepare(scene, {method.settings(), {}}, {1, {}});
  REQUIRE(gpu::legendre_fluids::draw_flow(*picture, *flow));
  const scene::Film drawn = picture->render(view_of(*scene), {1, {}}).film;
  // The share that theta leaves, by a search on a fine lattice.
  const scene::LegendrePointer field = box_of(*flow, 1);
  double least = 0;
  for (int i = 0; i < 41 * 41 * 41; ++i)
    least = std::min(least, field->value(Vec3(i % 41, i / 41 % 41, i / 1681) / 20.0 - Vec3::Ones()));
  const double mean = field->coefficients()[0] / std::sqrt(8.0);
  const scene::Film expected =
      test::render(legendre_fluids::LegendreLight(), scene_with(box_of(*flow, mean / (mean - least)))).film;
  // The margin for what lies between points is 2 % of the way to the mean.
  for (const char* layer : {"transmittance", "airlight"}) CHECK(test::relative_l2(drawn, expected, layer) < 0.01);
  CHECK_FALSE(gpu::legendre_fluids::draw_flow(
      *method.prepare(scene_with(random_density({4, 4, 4}, 1)), {method.settings(), {}}, {1, {}}), *flow));
}

DEVICE_TEST_CASE("pictures of a flow: from where it lies, and from a box that is uploaded", "[gpu][legendre_fluids]") {
  const TemporaryFolder folder;
  const auto flow = rising_blob(0.5);
  const auto scene = scene_with(box_of(*flow, 1));
  const gpu::legendre_fluids::LegendreLight on_device;
  const legendre_fluids::LegendreLight on_processor;
  const scene::Settings settings(on_processor.settings(), {});  // equal settings for both
  experiments::FlowPictures there(*scene, on_device, settings, 3, 1), here(*scene, on_processor, settings, 3, 1);
  for (int frame = 0; frame < 2; ++frame) {
    there.draw(*flow, folder.file("there.png"));
    here.draw(*flow, folder.file("here.png"));
    const scene::ColorImage a = scene::read_color_image(folder.file("there.png")),
                            b = scene::read_color_image(folder.file("here.png"));
    REQUIRE(a.rgb.size() == b.rgb.size());
    double worst = 0, greatest = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
      worst = std::max(worst, double(std::abs(a.rgb[i] - b.rgb[i])));
      greatest = std::max(greatest, double(b.rgb[i]));
    }
    CHECK(worst < 0.01);  // a level of 8 bits
    CHECK(greatest > 0.1);
    // The second picture keeps what the first one prepared. A picture that is prepared anew is equal to it.
    experiments::FlowPictures(*scene, on_processor, settings, 3, 1).draw(*flow, folder.file("anew.png"));
    CHECK(scene::read_color_image(folder.file("anew.png")).rgb == b.rgb);
    flow->step(0.05);
  }
  CHECK(there.on_device() == 2);
  CHECK(here.on_device() == 0);
  scene::Scene empty = *scene;
  empty.media.clear();
  CHECK_THROWS_AS(experiments::FlowPictures(empty, on_device, settings, 0, 1), Error);
}

// Densities that ring below 0 around a blob are taken as 0, as on the CPU, in a few stretches of each ray.
DEVICE_TEST_CASE("legendre light on the device: a blob of a flow that rings below 0",
                 "[gpu][legendre_fluids][thorough]") {
  const auto flow = rising_blob(0);
  for (int frame = 0; frame < 3; ++frame) {
    const scene::LegendrePointer field = box_of(*flow, 1);
    REQUIRE(field->negative());
    const auto scene = scene_with(field);
    const scene::Film a = test::render(legendre_fluids::LegendreLight(), scene).film;
    const gpu::legendre_fluids::LegendreLight method;
    const auto picture = method.prepare(scene, {method.settings(), {}}, {1, {}});
    const scene::Rendering b = picture->render(view_of(*scene), {1, {}});
    CAPTURE(frame, b.counters.at("rounds"));
    for (const auto& [layer, values] : a.layers) CHECK(gpu::test::quantile(a, b.film, layer, 1) < 8e-6);
    CHECK(b.counters.at("rounds") <= 24);
    CHECK(b.counters.at("stretches_at_limit") == 0);
    CHECK(b.counters.at("negative_share") > 1e-3);
    scene::Execution none{1, {}};  // whether all rays are done is looked at even where nobody sees them
    none.layers.emplace();
    const auto unseen = method.prepare(scene, {method.settings(), {}}, {1, {}});
    const scene::Rendering nothing = unseen->render(view_of(*scene), none);
    CHECK(nothing.counters.at("rounds") == b.counters.at("rounds"));
    CHECK(nothing.counters.at("bytes_down") == 12);
    flow->step(0.05);
  }
}

}  // namespace draw_flow_test
