// Whole pictures: edges of depth, frames, films of any size, extremes.
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/geometry/shapes.h"
#include "tests/reference/half_resolution_march/fog_scenes.h"

namespace half_picture_test {

using namespace airlight;
using namespace airlight::half_resolution_march;
using test::relative_l2;

namespace {

// The slab of fog before a black wall at its back, of which a part stands `before` metres behind its front, to the left of x = edge. No
// shadow falls on what is seen.
std::shared_ptr<scene::Scene> with_wall(const SlabOfFog& fog, double before, double edge, int width, int height) {
  auto scene = fog.scene(width, height);
  scene->surfaces = {
      {"wall", scene::make_box({Point3(-50, -50, -50), Point3(edge, 50, -before)}), scene::Lambert{Rgb::Zero()}},
      {"back", scene::Plane{Point3(0, 0, -fog.depth), Vec3::UnitZ()}, scene::Lambert{Rgb::Zero()}}};
  finish(*scene);
  return scene;
}

// Greatest error of the airlight, relative to the exact one, of pixels with blocks around them: along the film's border a checkerboard has
// one row or column alone, which may show one side of an edge only.
double worst_error(const scene::Scene& scene, const SlabOfFog& fog, double before, double edge, const Given& given) {
  const scene::Film film = picture(std::make_shared<scene::Scene>(scene), given);
  const int border = std::stoi(given.at("divide")) / 2;
  double worst = 0;
  for (int y = border; y < film.height - border; ++y)
    for (int x = 0; x < film.width; ++x) {
      const double at = (2 * (x + 0.5) / film.width - 1) * film.width / film.height;  // [m]: the film is 2 m high
      const Rgb exact = fog.airlight(at < edge ? before : fog.depth);
      worst = std::max(worst, ((film.get("airlight", x, y) - exact) / exact).abs().maxCoeff());
    }
  return worst;
}

double greatest(const scene::Film& film, const std::string& layer) {
  return *std::max_element(film.layer(layer).begin(), film.layer(layer).end());
}

std::shared_ptr<scene::Scene> sized(const scene::Scene& scene, int width, int height) {
  auto other = std::make_shared<scene::Scene>(scene);
  other->camera = ray_marcher::small_view().camera;
  other->width = width;
  other->height = height;
  finish(*other);
  return other;
}

}  // namespace

// The wall's edge runs along a column of pixels, wherever it falls within blocks. Airlight before and beside the wall differs by up to a
// factor of 3. The nearest depth takes none from the other side: all pixels are exact. Bilinear mixes them.
TEST_CASE("half-resolution march: nearest depth does not leak across an edge of depth", "[half_resolution_march]") {
  const SlabOfFog fog;
  const double before = 0.5;
  for (const int divide : {2, 3, 4})
    for (int column = 20; column < 20 + divide; ++column) {
      const int width = 48, height = 32;
      const double edge = (2.0 * column / width - 1) * width / height;
      CAPTURE(divide, column);
      const auto scene = with_wall(fog, before, edge, width, height);
      Given given{{"self_shadow", "none"}, {"divide", std::to_string(divide)}, {"blur", "bilateral"}};
      CHECK(worst_error(*scene, fog, before, edge, given) < 2e-6);
      given["upsample"] = "bilinear";
      CHECK(worst_error(*scene, fog, before, edge, given) > (column % divide == 0 ? 0.02 : 0.1));
      given["upsample"] = "nearest_depth";
      // Edges that the blur does not see are blurred.
      given["edge"] = "1e6";
      CHECK(worst_error(*scene, fog, before, edge, given) > 0.1);
    }
}

// A ball of smoke in the middle of the film, before a wall that all pixels see at one depth: the picture is its own mirror image, since
// blocks are marched through their middles.
TEST_CASE("half-resolution march: pictures before a flat wall are not shifted", "[half_resolution_march]") {
  scene::GaussianSum sum;
  sum.gaussians = {{Point3(0, 0, -0.7), 0.3, 2.0}};
  auto scene = with_wall(SlabOfFog(), 0.5, -40, 24, 16);
  scene->media = {ray_marcher::make_medium(sum, scene::Unbounded{}, Rgb(2, 3, 4), Rgb::Constant(0.8))};
  finish(*scene);
  for (const char* depth : {"min_max", "centre"}) {
    const scene::Film film = picture(scene, {{"jitter", "none"}, {"depth", depth}});
    double error = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 24; ++x)
        for (const auto& [i, j] : {std::pair{23 - x, y}, {x, 15 - y}})
          error = std::max(error, (film.get("airlight", x, y) - film.get("airlight", i, j)).abs().maxCoeff());
    CAPTURE(depth);
    CHECK(error < 1e-5 * greatest(film, "airlight"));
  }
}

// Surfaces that end rays are seen through the fog before them, at full resolution.
TEST_CASE("half-resolution march: surfaces are shaded by film pixel", "[half_resolution_march]") {
  const SlabOfFog fog;
  auto scene = with_wall(fog, 0.5, 0.1, 21, 14);
  scene->surfaces[0].material = scene::Lambert{Rgb(0.9, 0.5, 0.2)};
  finish(*scene);
  const scene::Film film = picture(scene, {});
  for (int y = 0; y < 14; ++y)
    for (int x = 0; x < 21; ++x) {
      const bool wall = (2 * (x + 0.5) / 21 - 1) * 21 / 14 < 0.1;
      // Light comes along the view: through the fog before the wall twice.
      const Rgb seen = wall ? Rgb(Rgb(0.9, 0.5, 0.2) / pi * fog.irradiance * fog.transmittance(1.0)) : Rgb(Rgb::Zero());
      const Rgb clear = fog.transmittance(wall ? 0.5 : fog.depth);
      for (int c = 0; c < 3; ++c) {
        CHECK(film.get("surface", x, y)[c] == Approx(seen[c]).epsilon(2e-6));
        CHECK(film.get("transmittance", x, y)[c] == Approx(clear[c]).epsilon(2e-6));
      }
    }
}

// The mean of frames converges to that of all offsets as their sequence does, about 1 / frames.
TEST_CASE("half-resolution march: frames converge like 1 over their number", "[half_resolution_march]") {
  const auto scene = sized(*ray_marcher::assorted_scenes()[4].second, 20, 16);
  for (const char* jitter : {"bayer", "noise"}) {
    const auto with = [&](int frames) {
      return picture(scene, {{"jitter", jitter}, {"frames", std::to_string(frames)}, {"steps", "6"}});
    };
    const scene::Film limit = with(4096);
    std::vector<double> errors;
    for (const int frames : {1, 4, 16, 64, 256}) errors.push_back(relative_l2(with(frames), limit));
    CAPTURE(jitter, errors);
    CHECK(std::log(errors.front() / errors.back()) / std::log(256) >= 0.9);
    for (std::size_t i = 1; i < errors.size(); ++i) CHECK(errors[i] < 0.7 * errors[i - 1]);  // a quarter in the mean
  }
}

// The blur is of use where fog is wider than it: it averages the offsets of neighbours.
TEST_CASE("half-resolution march: jitter and blur stand for many steps", "[half_resolution_march]") {
  scene::GaussianSum sum;
  sum.gaussians = {{Point3(0.1, 0.2, 0), 0.4, 2.0}, {Point3(-0.4, 0, 0.3), 0.3, 3.0}};
  const auto scene = sized(
      *ray_marcher::make_scene({ray_marcher::make_medium(sum, scene::Unbounded{}, Rgb(2, 3, 4), Rgb::Constant(0.8))},
                               {scene::DirectionalLight{Vec3(1, 2, 1).normalized(), Rgb(2, 2, 2)}}),
      240, 192);
  const scene::Film many = picture(scene, plain(256));
  const auto error = [&](const char* jitter, const char* blur) {
    return relative_l2(picture(scene, {{"jitter", jitter}, {"blur", blur}, {"divide", "1"}, {"steps", "6"}}), many);
  };
  for (const char* jitter : {"bayer", "noise"}) {
    CAPTURE(jitter, error(jitter, "none"), error(jitter, "bilateral"));
    CHECK(error(jitter, "bilateral") < 0.5 * error(jitter, "none"));
  }
}

TEST_CASE("half-resolution march: every film size and block gives a picture near that of full resolution",
          "[half_resolution_march]") {
  for (const auto& [name, made] : ray_marcher::assorted_scenes())
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {17, 2}})
      for (const char* divide : {"1", "2", "64"})
        for (const char* depth : {"min_max", "centre"}) {
          CAPTURE(name, width, height, divide, depth);
          Given given{{"divide", divide}, {"environment_directions", "4"}, {"map_size", "16"}, {"steps", "3"}};
          if (divide != std::string("1")) given["depth"] = depth;
          const scene::Film film = picture(sized(*made, width, height), given);
          CHECK(test::all_finite(film));
          CHECK(greatest(film, "transmittance") <= 1);
          // A block of one pixel is that pixel.
          if (width == 1)
            CHECK(film.layers == picture(sized(*made, 1, 1),
                                         [&] {
                                           Given same = given;
                                           same["divide"] = "1";
                                           same.erase("depth");
                                           return same;
                                         }())
                                     .layers);
        }
}

TEST_CASE("half-resolution march: extremes stay finite", "[half_resolution_march]") {
  const auto check = [](const std::shared_ptr<scene::Scene>& scene, const Given& more = {}) {
    Given given{{"steps", "4"}, {"environment_directions", "4"}, {"map_size", "16"}, {"map_steps", "16"}};
    given.insert(more.begin(), more.end());
    const scene::Film film = picture(scene, given);
    CHECK(test::all_finite(film));
    for (const char* layer : {"airlight", "transmittance", "surface"})
      CHECK(*std::min_element(film.layer(layer).begin(), film.layer(layer).end()) >= 0);
    CHECK(greatest(film, "transmittance") <= 1);
    return film;
  };
  for (const auto& [name, made] : ray_marcher::assorted_scenes()) {
    const auto scene = sized(*made, 5, 4);
    for (const double thick : {1e-6, 1e6}) {
      CAPTURE(name, thick);
      auto other = std::make_shared<scene::Scene>(*scene);
      for (scene::Medium& medium : other->media) medium.sigma_t *= thick;
      finish(*other);
      for (const char* integration : {"analytic", "riemann"}) check(other, {{"integration", integration}});
    }
    CAPTURE(name);
    auto dark = std::make_shared<scene::Scene>(*scene);
    for (scene::Medium& medium : dark->media) medium.albedo.setZero();
    finish(*dark);
    CHECK(greatest(check(dark), "airlight") == 0);
    // Camera and lamp at one point inside.
    auto inside = std::make_shared<scene::Scene>(*scene);
    inside->camera = scene::look_at(Point3(0.1, 0.1, 0.1), Point3(1, 0, 0), Vec3::UnitY());
    inside->lights = {scene::PointLight{Point3(0.1, 0.1, 0.1), Rgb::Ones(), 0}};
    finish(*inside);
    check(inside, {{"interval", "camera"}});
  }
}

// Lengths times s, extinction over s: the same picture, whatever the unit.
TEST_CASE("half-resolution march: scaled scenes have the same picture", "[half_resolution_march]") {
  for (const std::size_t i : {1, 2, 3, 4, 6, 7}) {
    const auto scene = sized(*ray_marcher::assorted_scenes()[i].second, 9, 7);
    const Given given{{"map_size", "16"}, {"map_steps", "16"}};
    const scene::Film film = picture(scene, given);
    for (const double scale : {1e-4, 1e4}) {
      CAPTURE(i, scale);
      auto scaled = std::make_shared<scene::Scene>(*ray_marcher::scaled_scene(*scene, scale));
      scaled->camera.position *= scale;
      finish(*scaled);
      CHECK(relative_l2(picture(scaled, given), film) < 1e-4);
    }
  }
}

TEST_CASE("half-resolution march: the same bits whatever the threads", "[half_resolution_march]") {
  for (const auto& [name, made] : ray_marcher::assorted_scenes()) {
    INFO(name);
    const auto scene = sized(*made, 21, 17);
    const Given given{{"environment_directions", "4"}, {"map_size", "16"}, {"jitter", "noise"}};
    CHECK(picture(scene, given, 1).layers == picture(scene, given, 2).layers);
  }
}

}  // namespace half_picture_test
