// The paper's media, one by one with a stencil, at pixels and at vertices.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/shadow_planes/paper_medium.h"
#include "methods/shadow_planes/shadow_volumes.h"
#include "tests/methods/shadow_planes/vectors.h"
#include "tests/methods/shadow_planes/vertex_scenes.h"

namespace media_stencil_test {

using namespace airlight;
using namespace airlight::shadow_planes;
using namespace shadow_planes_test;

TEST_CASE("shadow planes: the paper's media through the renderer against the vectors", "[shadow_planes]") {
  for (const json& v : vectors_of("bounded")) {
    const json& in = v.at("input");
    const json& p = in.at("params");
    auto scene = std::make_shared<scene::Scene>();
    scene->name = v.at("id");
    scene->width = scene->height = 1;
    scene->camera = scene::look_at(vec(in.at("O")), vec(in.at("O")) + vec(in.at("dir")), {0, 1, 0});
    scene->lights.emplace_back(scene::PointLight{vec(in.at("S")), Rgb(1, 2, 3), 0});
    scene::Medium& medium = scene->media.emplace_back();
    medium.sigma_t = Rgb::Constant(number(in.at("k_t")));
    if (in.at("shape") == "sphere")
      medium.region = scene::Sphere{vec(p[0]), number(p[1])};
    else
      medium.region = Box{vec(p[0]), vec(p[1])};
    finish(*scene);
    const double expected = number(v.at("expect").at("L_paper")) *
                            std::exp(medium.sigma_t[0] * (number(in.at("R")) - mean_distance(medium.region)));
    CAPTURE(scene->name, expected);
    for (const char* shadows : {"none", "counted", "stencil"})
      CHECK(render(scene, {{"bounded", "paper"}, {"shadows", shadows}}).film.layer("airlight")[1] ==
            Approx(2 * expected).epsilon(1e-6));
    const scene::Rendering at_vertices =
        render(scene, with(by_vertices, {{"bounded", "paper"}, {"boundary_cells", "64"}}));
    // Light in the medium, a cell or two from the ray, makes Gamma steep.
    const bool steep = contains(medium.region, vec(in.at("S")));
    CHECK(at_vertices.film.layer("airlight")[2] == Approx(3 * expected).epsilon(steep ? 2e-2 : 1e-3));
    CHECK(at_vertices.counters.at("vertices") == 6 * 65 * 65);
  }
}

TEST_CASE("shadow planes: media one by one with a stencil", "[shadow_planes]") {
  const auto scene = two_media();
  const Given paper = {{"bounded", "paper"}};
  const scene::Rendering counted = render(scene, paper);
  const Given fine = {{"edge_split", "64"}, {"boundary_cells", "64"}};
  const scene::Rendering stencil = render(scene, with(with(paper, {{"shadows", "stencil"}}), fine));
  CHECK(relative_l2(stencil.film, counted.film) < 1e-5);  // one convex occluder: any order will do, finely cut
  // Lit parts are drawn only within a medium: none in front of one, none behind.
  const ShadowVolumes shadows(std::make_shared<Occluders>(scene), scene::ball(scene->lights[0])->center);
  int drawn = 0, in_front = 0;
  std::vector<Crossing> crossings;
  std::vector<ShadowVolumes::Interval> lit;
  for (int y = 0; y < scene->height; ++y)
    for (int x = 0; x < scene->width; ++x) {
      const Ray ray = camera_ray(scene->camera, x + 0.5, y + 0.5, scene->width, scene->height);
      const double end = scene::ray_end(*scene, ray).t;
      shadows.lit_parts(ray, end, 0, nullptr, crossings, lit);
      for (const scene::Medium& medium : scene->media) {
        const Interval inside = clip(medium.region, ray, {0, end});
        if (inside.empty()) continue;
        for (const auto& part : lit) {
          drawn += part.end > inside.lo && part.begin < inside.hi;
          drawn += part.begin > inside.lo && part.begin < inside.hi;
          in_front += part.end < inside.lo;
        }
      }
    }
  CHECK(in_front > 50);
  CHECK(std::abs(stencil.counters.at("lit_parts") - drawn) < 0.005 * drawn);  // the order is wrong for a ray or two
  // At vertices, ever finer.
  double before = infinity;
  for (const char* cells : {"4", "16", "64"}) {
    const scene::Rendering got = render(
        scene,
        with(with(paper, by_vertices), {{"edge_split", "64"}, {"boundary_cells", cells}, {"plane_levels", cells}}));
    CHECK(airlight::test::all_finite(got.film));
    const double e = relative_l2(got.film, counted.film);
    CAPTURE(cells, e, before);
    CHECK(e < 0.4 * before);
    before = e;
  }
  CHECK(before < 5e-3);
  // In 8 bits.
  const scene::Film coarse = render(scene, with(with(paper, by_vertices), with(fine, {{"frame_buffer", "true"}}))).film;
  for (const float v : coarse.layer("airlight")) CHECK(std::abs(255 * v - std::round(255 * v)) < 1e-4f);
  CHECK(relative_l2(coarse, counted.film) < 0.2);
  CHECK(relative_l2(coarse, counted.film) > 0.005);
  // They do not tint one another: each alone gives its share.
  const auto both = two_media(), first = two_media(), second = two_media();
  first->media.pop_back();
  second->media.erase(second->media.begin());
  for (const auto& one : {both, first, second}) {
    one->lights[0] = scene::PointLight{{3, 0, 0}, Rgb::Ones(), 0.01};  // shines through one at the other
    finish(*one);
  }
  const auto apart = [&](const Given& given) {
    return sum(render(first, given).film) + sum(render(second, given).film);
  };
  CHECK(sum(render(both, paper).film) == Approx(apart(paper)).epsilon(1e-6));
  CHECK(sum(render(both, {}).film) < 0.97 * apart({}));
}

// Two boxes out of sight, the planes of one of which cross rays between the camera and the media. The other, below the floor, makes the
// mesh reach as far as the media do.
TEST_CASE("shadow planes: planes in front of a medium change nothing", "[shadow_planes]") {
  const auto scene = two_media(), more = two_media();
  scene::TriangleMesh boxes = scene::make_box({{0.3, 1.95, 0.5}, {0.5, 2.05, 0.7}});
  const scene::TriangleMesh below = scene::make_box({{-0.1, -3.2, -0.1}, {0.1, -3, 0.1}});
  const int first = int(boxes.vertices.size());
  boxes.vertices.insert(boxes.vertices.end(), below.vertices.begin(), below.vertices.end());
  for (const auto& t : below.triangles) boxes.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  more->surfaces.push_back({"boxes", boxes, scene::Lambert{}});
  finish(*more);
  for (const Given& given : {Given{{"shadows", "stencil"}}, by_vertices}) {
    const scene::Rendering a = render(scene, with(given, {{"bounded", "paper"}})),
                           b = render(more, with(given, {{"bounded", "paper"}}));
    CHECK(b.film.layer("surface") == a.film.layer("surface"));
    CHECK(b.counters.at("crossings") > 1.2 * a.counters.at("crossings"));
    CHECK(b.film.layer("airlight") == a.film.layer("airlight"));
    CHECK(b.counters.at("lit_parts") == a.counters.at("lit_parts"));  // none is drawn
  }
}

}  // namespace media_stencil_test
