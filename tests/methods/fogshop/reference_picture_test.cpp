// Fogshop's pictures against the deterministic reference, which shares no code with the method.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/model.h"
#include "reference/deterministic/renderer.h"
#include "tests/methods/fogshop/small_scene.h"

namespace reference_picture_test {

using namespace fogshop_scenes;
using airlight::test::relative_l2;
using scene::Film;

// Accuracy on shipped scenes against the deterministic reference, which shares no code with the method; the bounds are
// those of the experiments fogshop/*.
TEST_CASE("fogshop against the deterministic reference", "[fogshop]") {
  struct Case {
    const char* name;
    double paper_least, paper_most, s12, s26, extrapolated24;
  };
  const Case cases[] = {{"f100_thin", 0.0, 0.08, 0.035, 0.01, 0.004},
                        {"halo_near", 0.21, 1.0, 0.035, 0.01, 0.002},
                        {"a30", 0.1, 1.7, 0.035, 0.01, 0.004},
                        {"tube", 0.96, 1.8, 0.4, 0.04, 0.02}};
  for (const Case& c : cases) {
    const Scene scene =
        scene::load_scene(std::string(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/") + c.name + ".toml",
                          {{"film.width", "16"}, {"film.height", "12"}});
    const auto reference = deterministic::make_renderer();
    const scene::Settings defaults(reference->settings(), {});
    const Film truth =
        reference->prepare(std::make_shared<const Scene>(scene), defaults, {})->render(view_of(scene), {}).film;
    const auto error = [&](Pairs given) {
      if (given.count("variant") == 0) given.insert({{"map_directions", "128"}, {"map_edges", "64"}});
      return relative_l2(render(scene, given).film.layer("airlight"), truth.layer("airlight"));
    };
    INFO(c.name);
    const double paper = error({{"variant", "paper"}});
    CHECK(paper >= c.paper_least);
    CHECK(paper <= c.paper_most);
    CHECK(error({{"K", "12"}, {"edges", "plain"}, {"extrapolate", "false"}}) <= c.s12);
    CHECK(error({{"K", "26"}, {"edges", "plain"}, {"extrapolate", "false"}}) <= c.s26);
    CHECK(error({{"K", "24"}}) <= c.extrapolated24);
  }
}

// Everything at once, layer by layer: two lights of which one has a ball, colour, albedo, a merged second medium, a
// wall, both kinds of camera. The wall stands behind everything, so that nothing shadows the medium.
// Gaussians of very different sizes, which the even edges and texels of a light map miss: sums are chosen by themselves.
TEST_CASE("fogshop: a puff in a bank, at any ratio of their sizes, is right by default", "[fogshop]") {
  struct Pair {
    scene::Gaussian puff, bank;
    double eye;
    bool map;
  };
  const Pair pairs[] = {{{Point3(0, 1, 0), 0.1, 10}, {Point3(0.5, 1, 0), 200, 0.003}, 6, false},
                        {{Point3(0, 1, 0), 0.001, 1000}, {Point3(0.5, 1, 0), 1000, 0.001}, 6, false},
                        {{Point3(2, 1, 0), 0.1, 10}, {Point3(0.5, 1, 0), 200, 0.003}, 6, false},
                        {{Point3(0, 1, 0), 1, 1}, {Point3(0.5, 1, 0), 200, 0.003}, 6, false},
                        {{Point3(0, 1, 0), 0.1, 0.3}, {Point3(0.5, 1, 0), 200, 0.003}, 6, true},
                        {{Point3(0, 1, 0), 20, 0.1}, {Point3(0.5, 1, 0), 200, 0.003}, 60, true},
                        {{Point3(3, 1, 0), 0.5, 3}, {Point3(0.5, 1, 0), 10, 0.05}, 10, true}};
  for (const Pair& pair : pairs) {
    Scene scene;
    scene.width = 24;
    scene.height = 18;
    scene.camera = scene::look_at(Point3(0, 1, pair.eye), Point3(0, 1, 0), Vec3::UnitY());
    scene.lights = {scene::PointLight{Point3(0, 1, 0), Rgb::Constant(4), 0}};
    scene.media = {gaussians({pair.puff, pair.bank})};
    finish(scene);
    CAPTURE(pair.puff.width, pair.bank.width);
    const auto shared = std::make_shared<Scene>(scene);
    const Film truth =
        airlight::test::picture(*deterministic::make_renderer(), shared, {{"relative_tolerance", "1e-6"}});
    CHECK(relative_l2(render(scene).film, truth) < 0.015);
    CHECK(kept(method.prepare(shared, settings({}), {})->stages(), "light maps") == pair.map);
  }
}

TEST_CASE("fogshop layers are those of the deterministic reference", "[fogshop]") {
  Scene scene = small_scene();
  scene.lights.push_back(scene::PointLight{Point3(-0.8, -0.5, -4), Rgb(1, 2, 4), 0.2});
  scene.media = {gaussians({{Point3(0.5, 0.2, -4), 1, 0.5}, {Point3(-1, 0.5, -3), 0.6, 1}}, 0.05), homogeneous(0.02)};
  for (auto& medium : scene.media) {
    medium.sigma_t = Rgb(1, 0.6, 0.3) * (&medium == &scene.media[0] ? 1 : 2);
    medium.albedo = Rgb(0.9, 0.8, 0.7);
  }
  scene.surfaces.push_back({"wall", scene::Plane{Point3(0, 0, -6), Vec3(0, 0, 1)}, scene::Lambert{Rgb(0.5, 0.6, 0.7)}});
  for (const auto kind : {scene::Camera::Kind::perspective, scene::Camera::Kind::orthographic}) {
    scene.camera.kind = kind;
    scene.camera.height = 4;
    finish(scene);
    const auto reference = deterministic::make_renderer();
    const Film truth = reference->prepare(std::make_shared<const Scene>(scene), {reference->settings(), {}}, {})
                           ->render(view_of(scene), {})
                           .film;
    const Film film = render(scene, {{"K", "96"}, {"light_depth", "exact"}, {"eps_T", "1e-10"}}).film;
    // Layers are floats; the airlight has 96 extrapolated slices.
    CHECK(relative_l2(film.layer("airlight"), truth.layer("airlight")) <= 1e-4);
    CHECK(relative_l2(film.layer("surface"), truth.layer("surface")) <= 1e-6);
    CHECK(relative_l2(film.layer("transmittance"), truth.layer("transmittance")) <= 1e-6);
    CHECK(relative_l2(film.layer("mean"), truth.layer("mean")) <= 1e-4);
  }
}

// Media of one extinction_ratio and different albedos against the deterministic reference, which adds media up point by point: the
// albedo scales what scatters and leaves the transmittance alone. Black smoke among white steam, a red constant.
TEST_CASE("fogshop scatters in the colour of each Gaussian", "[fogshop]") {
  Scene scene = small_scene();
  scene.media = {gaussians({{Point3(0.5, 0.2, -4), 1, 0.5}, {Point3(-1, 0.5, -3), 0.6, 1}}),
                 gaussians({{Point3(-0.3, -0.2, -5), 0.9, 0.7}, {Point3(0.2, 0.9, -3.5), 0.5, 0.6}}),
                 homogeneous(0.03)};
  scene.media[0].albedo = Rgb(0.2, 0.9, 0.6);
  scene.media[1].albedo = Rgb(0.8, 0.1, 0.0);
  scene.media[2].albedo = Rgb(0.9, 0.3, 0.3);
  scene.surfaces.push_back({"wall", scene::Plane{Point3(0, 0, -7), Vec3(0, 0, 1)}, scene::Lambert{Rgb(0.5, 0.6, 0.7)}});
  finish(scene);
  for (const Rgb& extinction_ratio : {Rgb(1, 1, 1), Rgb(0.4, 1, 0.7)}) {
    for (auto& medium : scene.media) medium.sigma_t = extinction_ratio;
    const auto reference = deterministic::make_renderer();
    const Film truth = reference->prepare(std::make_shared<const Scene>(scene), {reference->settings(), {}}, {})
                           ->render(view_of(scene), {})
                           .film;
    const auto film = [&](const Pairs& given) { return render(scene, given).film; };
    // S converges to it; paper attenuates at one point of the ray.
    const Film s = film({{"K", "96"}, {"light_depth", "exact"}, {"eps_T", "1e-10"}});
    CHECK(relative_l2(s.layer("airlight"), truth.layer("airlight")) <= 1e-4);
    CHECK(relative_l2(s.layer("mean"), truth.layer("mean")) <= 1e-4);
    CHECK(relative_l2(s.layer("transmittance"), truth.layer("transmittance")) <= 1e-6);
    const Film paper = film({{"variant", "paper"}, {"eps_T", "1e-10"}});
    CHECK(relative_l2(paper.layer("airlight"), truth.layer("airlight")) <= 0.3);
    // Colours are linear: per channel, the picture is the sum of those where one medium scatters and the others are
    // black. That pins each colour to its Gaussian in every variant.
    for (const char* variant : {"paper", "S"}) {
      const Pairs given =
          scene::without_unread(fogshop::setting_specs(), {{"variant", variant}, {"K", "8"}, {"extrapolate", "false"}});
      const Film whole = film(given);
      std::vector<double> sum(whole.layer("airlight").size(), 0.0);
      const auto media = scene.media;
      for (std::size_t lit = 0; lit < media.size(); ++lit) {
        for (std::size_t m = 0; m < media.size(); ++m)
          if (m != lit) scene.media[m].albedo.setZero();
        const Film part = film(given);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part.layer("airlight")[i];
        scene.media = media;
      }
      for (std::size_t i = 0; i < sum.size(); ++i) CHECK(whole.layer("airlight")[i] == Approx(sum[i]).epsilon(1e-6));
    }
  }
}
}  // namespace reference_picture_test
