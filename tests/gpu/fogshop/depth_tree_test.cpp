// Average depths by the tree of cells on the device: as the CPU's, and as sums over all Gaussians.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <random>

#include "gpu/fogshop/fogshop.h"
#include "methods/fogshop/fogshop.h"
#include "scene/geometry/shapes.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"
#include "tests/scene/geometry_scenes.h"

namespace depth_tree_test {

using namespace airlight;
using gpu::test::quantile;
using scene::Scene;

namespace {

// A torus, a box and the ground up to the horizon among `count` Gaussians of widths from 0.02 to 0.5, under a sky; in
// metres `scale` times as large.
Scene fog_banks(int count, double scale) {
  std::mt19937 engine(3);
  const auto number = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine); };
  Scene scene;
  scene.name = fmt::format("{} banks of fog, scale {:g}", count, scale);
  scene.width = 32;
  scene.height = 24;
  scene.camera = scene::look_at(scale * Point3(1.2, 1.1, 3.2), Point3(0, 0, 0), {0, 1, 0});
  scene.lights.push_back(scene::make_sh_environment(
      {Rgb(3, 3, 4), Rgb(-1, -0.8, -1), Rgb(0.2, 0.2, 0.1), Rgb(0.4, 0.1, 0.1)}, Mat3::Identity(), Rgb::Ones()));
  scene::GaussianSum sum;
  for (int i = 0; i < count; ++i) {
    const double width = 0.02 * std::pow(25.0, number(0, 1));
    sum.gaussians.push_back({scale * Point3(number(-1.2, 1.2), number(-0.7, 0.6), number(-1.2, 1.2)), scale * width,
                             number(0.02, 0.2) / (scale * width)});
  }
  scene::Medium fog;
  fog.field = sum;
  fog.sigma_t = Rgb(1, 0.8, 0.5);
  fog.albedo = Rgb(0.95, 0.9, 0.8);
  scene.media.push_back(fog);
  scene::TriangleMesh ring = scene::torus(32, 16), box = scene::make_box({{-0.3, -0.6, -0.2}, {0.2, 0.3, 0.3}});
  for (scene::TriangleMesh* mesh : {&ring, &box})
    for (Point3& vertex : mesh->vertices) vertex *= scale;
  scene.surfaces = {{"torus", ring, scene::Lambert{Rgb(0.7, 0.5, 0.3)}},
                    {"box", box, scene::Phong{Rgb::Constant(0.3), Rgb(0.3, 0.2, 0.1), 5}},
                    {"ground", scene::Plane{{0, -0.6 * scale, 0}, Vec3(0, 1, 0)}, scene::Lambert{Rgb(0.4, 0.5, 0.4)}}};
  finish(scene);
  return scene;
}

}  // namespace

DEVICE_TEST_CASE("fogshop: average depths by a tree on the GPU agree with the CPU", "[gpu][thorough]") {
  const test::Given tree{{"reflectance", "npsf"}, {"erf", "erf10"}},
      exact{{"reflectance", "npsf"}, {"erf", "erf10"}, {"average_depth", "exact"}};
  struct Case {
    int count;
    double scale;
  };
  for (const Case& c : {Case{80, 1}, Case{80, 0.01}, Case{80, 2e5}, Case{1200, 1}}) {
    const Scene scene = fog_banks(c.count, c.scale);
    const scene::Rendering a = test::render(fogshop::Fogshop(), scene, tree),
                           b = test::render(gpu::fogshop::Fogshop(), scene, tree),
                           truth = test::render(gpu::fogshop::Fogshop(), scene, exact);
    CAPTURE(scene.name);
    CHECK(a.counters.at("average_depth_cells") > 50);
    CHECK(b.counters.at("average_depth_cells") == a.counters.at("average_depth_cells"));
    CHECK(truth.counters.count("average_depth_cells") == 0);
    const auto most = [](const scene::Film& one, const scene::Film& other) {
      return quantile(one, other, "surface", 1);
    };
    if (std::getenv("AIRLIGHT_TEST_FIGURES"))
      fmt::print("{}: {} cells, GPU from CPU 99 % {:.1e}, most {:.1e}, tree from sums {:.1e}\n", scene.name,
                 a.counters.at("average_depth_cells"), quantile(a.film, b.film, "surface", 0.99), most(a.film, b.film),
                 most(truth.film, b.film));
    CHECK(quantile(a.film, b.film, "surface", 0.99) < 3.6e-6);
    CHECK(most(a.film, b.film) < 6.9e-6);
    CHECK(most(truth.film, b.film) < 9.9e-6);  // eps_T bounds it by 1e-4
  }
}

}  // namespace depth_tree_test
