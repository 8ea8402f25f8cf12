// Frames after the first: fog that moves keeps its levels, a map that changes is decomposed anew; both are the picture of a
// preparation from nothing.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/wavelet_fog/wavelet_fog.h"
#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"
#include "tests/pictures.h"

namespace next_frame_test {

using namespace airlight;
using namespace airlight::test;

namespace {

const wavelet_fog::WaveletFog method;

using ScenePointer = std::shared_ptr<const scene::Scene>;

template <class Change>
ScenePointer with_fog(const ScenePointer& from, const Change& change) {
  auto scene = std::make_shared<scene::Scene>(*from);
  for (scene::Medium& medium : scene->media) {
    auto fog = std::make_shared<scene::Fogmap>(*std::get<scene::FogmapPointer>(medium.field));
    change(*fog);
    medium.field = scene::FogmapPointer(std::move(fog));
  }
  return scene;
}

// Another place, another turn, cells half as large again, thinner above.
ScenePointer moved(const ScenePointer& from) {
  return with_fog(from, [](scene::Fogmap& fog) {
    fog.x0 += 3.25, fog.z0 -= 1.5, fog.cell *= 1.5;
    fog.cos_turn = std::cos(0.4), fog.sin_turn = std::sin(0.4);
    fog.profile = scene::Layers{{0, 4}, {1, 0.1}};
  });
}

ScenePointer changed(const ScenePointer& from) {
  return with_fog(from, [](scene::Fogmap& fog) {
    std::vector<double> coefficients = fog.map.coefficients();
    for (std::size_t i = 0; i < coefficients.size(); ++i) coefficients[i] *= i % 3 ? 1 : 0.25;
    fog.map = scene::SplineMap(fog.map.degree(), fog.map.range(), coefficients);
  });
}

ScenePointer of_another_size(const ScenePointer& from) {
  return with_fog(from, [](scene::Fogmap& fog) {
    fog.map = scene::SplineMap(0, {{2, 1}, {3, 2}}, {1, 0.5, 0, 2, 0.3, 1});
  });
}

ScenePointer without_fog(const ScenePointer& from) {
  auto scene = std::make_shared<scene::Scene>(*from);
  scene->media.clear();
  return scene;
}

ScenePointer twice(const ScenePointer& from) {
  auto scene = std::make_shared<scene::Scene>(*moved(from));
  scene->media.push_back(from->media.front());
  return scene;
}

}  // namespace

TEST_CASE("wavelet fog: the next frame is that of a preparation from nothing", "[wavelet_fog]") {
  const auto first = scene_named("wavelet_fog/patchy", 24, 18);
  auto lit = std::make_shared<scene::Scene>(*first);
  lit->lights = {scene::DirectionalLight{Vec3(1, 2, 0.5).normalized(), Rgb::Constant(3)}};
  const std::vector<Given> settings = {{{"variant", "skip"}},
                                       {{"variant", "bound"}, {"tolerance", "0.05"}},
                                       {{"variant", "tele"}},
                                       {{"variant", "paper"}, {"levels", "2"}},
                                       {{"variant", "pre"}, {"levels", "2"}},
                                       {{"variant", "skip"}, {"sun", "true"}, {"sun_step", "2"}}};
  for (const Given& given : settings) {
    const ScenePointer start = given.count("sun") ? ScenePointer(lit) : ScenePointer(first);
    const auto prepared = method.prepare(start, {method.settings(), given}, {1, {}});
    for (const ScenePointer& frame :
         {moved(start), changed(start), moved(changed(start)), twice(start), without_fog(start), ScenePointer(start)}) {
      CAPTURE(given.at("variant"), frame->media.size());
      const scene::Film after = next_frame(*prepared, frame).film;
      const scene::Film anew = render(method, frame, given).film;
      REQUIRE(after.layers.size() == anew.layers.size());
      for (const auto& [layer, values] : anew.layers) CHECK(after.layer(layer) == values);
    }
  }
}

// Another place alone.
TEST_CASE("wavelet fog: fog that scrolls keeps its maps of the sun, a sun that turns does not", "[wavelet_fog]") {
  auto still = std::make_shared<scene::Scene>(*scene_named("wavelet_fog/patchy", 24, 18));
  still->lights = {scene::DirectionalLight{Vec3(1, 2, 0.5).normalized(), Rgb::Constant(3)}};
  const auto scrolled = with_fog(still, [](scene::Fogmap& fog) { fog.x0 += 0.7, fog.z0 -= 0.2; });
  auto dimmed = std::make_shared<scene::Scene>(*still), turned = std::make_shared<scene::Scene>(*still);
  std::get<scene::DirectionalLight>(dimmed->lights[0]).irradiance *= 0.5;
  std::get<scene::DirectionalLight>(turned->lights[0]).to_light = Vec3(1, 2, 0.6).normalized();
  const Given given{{"sun", "true"}, {"sun_step", "2"}};
  const auto prepared = method.prepare(still, {method.settings(), given}, {1, {}});
  CHECK(prepared->render(view_of(*still), {1, {}}).counters.at("sun_maps_made") == 1);
  const std::pair<ScenePointer, int> frames[] = {{scrolled, 0}, {dimmed, 0}, {turned, 1}, {changed(turned), 1}};
  for (const auto& [frame, made] : frames) {
    CAPTURE(made);
    const scene::Rendering next = next_frame(*prepared, frame);
    CHECK(next.counters.at("sun_maps_made") == made);
    CHECK(next.film.layers == render(method, frame, given).film.layers);
  }
}

TEST_CASE("wavelet fog: a next frame that a variant cannot draw is refused, and the frame before stays",
          "[wavelet_fog]") {
  const auto first = scene_named("wavelet_fog/patchy", 16, 12);
  const Given given{{"variant", "tele"}, {"levels", "3"}};
  const auto prepared = method.prepare(first, {method.settings(), given}, {1, {}});
  const scene::Film before = prepared->render(view_of(*first), {1, {}}).film;
  CHECK_FALSE(prepared->next(of_another_size(first), {1, {}}));  // three levels of 3 x 2
  CHECK(prepared->render(view_of(*first), {1, {}}).film.layer("transmittance") == before.layer("transmittance"));
}

}  // namespace next_frame_test
