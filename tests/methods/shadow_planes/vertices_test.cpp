// Evaluation at the vertices of planes, surfaces and boundaries of media.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/shadow_planes/media_boundary.h"
#include "methods/shadow_planes/plane_mesh.h"
#include "tests/methods/shadow_planes/vertex_scenes.h"

namespace vertices_test {

using namespace airlight;
using namespace airlight::shadow_planes;
using namespace shadow_planes_test;

TEST_CASE("shadow planes: triangles of planes hold the points where they are crossed", "[shadow_planes]") {
  const auto scene = box_in_fog();
  const Point3 light(0.3, 2.5, -0.4);
  const ShadowVolumes shadows(std::make_shared<Occluders>(scene), light);
  constexpr int pieces = 3, levels = 5;
  const PlaneMesh mesh(shadows, std::vector<char>(shadows.edges().size(), false), 10, pieces, levels);
  REQUIRE(mesh.vertices().size() == shadows.edges().size() * (pieces + 1) * (levels + 2));
  CHECK(mesh.planes() == shadows.edges().size() * pieces);
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  int endless = 0;
  for (int i = 0; i < 2000; ++i) {
    Crossing crossing{1, 2, int(uniform(engine) * double(shadows.edges().size())), uniform(engine),
                      std::exp(4 * uniform(engine))};
    if (i < 4) crossing.share = i % 2, crossing.times = i < 2 ? 1 : 1e6;
    const SilhouetteEdge& edge = shadows.edges()[crossing.edge];
    const Point3 expected = light + crossing.times * (edge.a + (edge.b - edge.a) * crossing.share);
    const PlaneMesh::Place place = mesh.locate(crossing);
    CHECK(place.weight.sum() == Approx(1));
    CHECK(place.weight.minCoeff() > -1e-12);
    // In homogeneous coordinates; a vertex at infinity is as far from the one before it as that from the light.
    Vec3 point = Vec3::Zero();
    double weight = 0;
    for (int k = 0; k < 3; ++k) {
      const Vertex& vertex = mesh.vertices()[place.vertex[k]];
      endless += vertex.at_infinity;
      if (vertex.at_infinity) {
        const Vec3 last = mesh.vertices()[place.vertex[k] - 1].place - light;
        CHECK(last.cross(vertex.place).norm() < 1e-12 * last.norm());
        point += place.weight[k] * last;
      } else {
        point += place.weight[k] * vertex.place;
        weight += place.weight[k];
      }
    }
    CHECK((point / weight - expected).norm() < 1e-9 * (expected - light).norm());
  }
  CHECK((endless > 100 && endless < 2000));
}

TEST_CASE("shadow planes: triangles of a medium's boundary hold its points", "[shadow_planes]") {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  const scene::Sphere sphere{{1, -2, 3}, 1.5};
  const Box box{{0, 1, -4}, {3, 2, 1}};
  for (const int cells : {1, 8}) {
    const MediaBoundary ball(sphere, cells), faces(box, cells);
    CHECK(ball.triangles().size() == std::size_t(12) * cells * cells);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 d = Vec3(normal(engine), normal(engine), normal(engine)).normalized();
      for (const bool round : {true, false}) {
        const MediaBoundary& boundary = round ? ball : faces;
        const Ray out{round ? sphere.center : box.center(), d};
        const Point3 x = out.at(clip(round ? scene::Region(sphere) : scene::Region(box), out, {0, infinity}).hi);
        const MediaBoundary::Place place = boundary.locate(x);
        Vec3 point = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
          point += place.weight[k] * boundary.vertices()[boundary.triangles()[place.triangle][k]];
        CHECK(place.weight.minCoeff() > -1e-9);
        CHECK((point - out.origin).normalized().dot(d) == Approx(1).epsilon(1e-12));
        if (round)
          worst = std::max(worst, (point - x).norm() / sphere.radius);
        else
          CHECK((point - x).norm() < 1e-12);
      }
    }
    CHECK(worst < 1.0 / (cells * cells));
    CHECK(worst > 0.05 / (cells * cells));
  }
}

// Second order in the step of the geometric progression: levels span the logarithm of a range that grows slowly.
TEST_CASE("shadow planes: finer planes at vertices converge to pixels", "[shadow_planes]") {
  const auto scene = box_in_fog();
  // The visible part of the box has its own, constant error.
  scene->camera = scene::look_at({0.5, -0.6, 5}, {0.2, -0.5, 0}, {0, 1, 0});
  scene->camera.vertical_fov = 0.25;
  const scene::Film expected = render(scene, {{"shadows", "stencil"}, {"edge_split", "16"}}).film;
  const auto error = [&](int levels) {
    return relative_l2(
        render(scene, with(by_vertices, {{"edge_split", "16"}, {"plane_levels", std::to_string(levels)}})).film,
        expected);
  };
  // The light is 6 m from the camera, the edges 1.6 to 2 m from it.
  const auto step = [](int levels) { return std::log(6 * std::max(1.0, levels / 4.0) / 1.8) / levels; };
  const double coarse = error(4) / (step(4) * step(4));
  double before = infinity;
  for (const int levels : {4, 8, 16, 32}) {
    const double e = error(levels), scaled = e / (step(levels) * step(levels));
    CAPTURE(levels, e, scaled, coarse);
    CHECK(e < 0.6 * before);
    CHECK((scaled > 0.3 * coarse && scaled < 3 * coarse));
    before = e;
  }
  CHECK(before < 1.5e-3);
}

// One wall and no shadow: linear interpolation over its triangles is of second order.
TEST_CASE("shadow planes: a finely meshed wall at vertices", "[shadow_planes]") {
  const auto scene = box_in_fog();
  const auto error = [&](int cells) {
    scene::HeightField wall;
    wall.nx = wall.nz = cells + 1;
    wall.spacing_x = wall.spacing_z = 8.0 / cells;
    wall.heights.assign(std::size_t(wall.nx) * wall.nz, 0);
    wall.origin = {-4, -1, -5};
    scene->surfaces = {{"floor", scene::make_height_field(wall), scene::Lambert{}}};
    scene->camera = scene::look_at({0, 2, 5}, {0, -1, 0}, {0, 1, 0});
    scene->camera.vertical_fov = 0.4;
    finish(*scene);
    const scene::Rendering got = render(scene, with(by_vertices, {{"shadows", "none"}}));
    CHECK(got.counters.at("vertices") == double((cells + 1) * (cells + 1)));
    CHECK(got.counters.at("gamma_evaluations") == got.counters.at("vertices"));  // none by pixel
    return relative_l2(got.film, render(scene, {{"shadows", "none"}}).film);
  };
  double before = error(8);
  for (const int cells : {16, 32, 64, 128}) {
    const double e = error(cells);
    CAPTURE(cells, e, before);
    CHECK(e < before / 3);
    CHECK(e > before / 6);
    before = e;
  }
  CHECK(before < 2e-4);
}

TEST_CASE("shadow planes: stages of the paper and their times", "[shadow_planes]") {
  const ShadowPlanes method;
  const auto scene = box_in_fog();
  for (const Given& given : {Given{{"shadows", "stencil"}}, by_vertices}) {
    const auto prepared = method.prepare(scene, {method.settings(), given}, {1, {}});
    std::vector<std::string> kept, timed;
    for (const scene::Stage& stage : prepared->stages())
      if (stage.kept) kept.push_back(stage.name);
    for (const scene::StageTime& time : prepared->prepare_times())
      if (time.name == "silhouettes") timed.push_back(time.name);
    for (const scene::StageTime& time : prepared->render(view_of(*scene), {1, {}}).times) {
      timed.push_back(time.name);
      CHECK(time.seconds > 0);
    }
    CHECK(kept == timed);
    CHECK(kept.size() == 5);
  }
  // Rays that begin at different places have orders of their own.
  scene->surfaces.push_back({"second", scene::make_box({{0.1, -0.6, -0.6}, {0.8, -0.1, 0.1}}), scene::Lambert{}});
  scene->camera.kind = scene::Camera::Kind::orthographic;
  scene->camera.height = 4;
  finish(*scene);
  CHECK(relative_l2(render(scene, {{"shadows", "stencil"}, {"edge_split", "256"}}).film, render(scene, {}).film) <
        1e-6);
}

TEST_CASE("shadow planes: at vertices, what there is not and extremes", "[shadow_planes]") {
  const ShadowPlanes method;
  for (const char* bounded : {"exact", "paper"}) {
    const Given given = with(by_vertices, {{"bounded", bounded}});
    const auto nothing = std::make_shared<scene::Scene>();
    nothing->width = nothing->height = 4;
    finish(*nothing);
    CHECK(sum(render(nothing, given).film) == 0);
    const auto clear = two_media();
    for (scene::Medium& medium : clear->media) medium.sigma_t.setZero();
    finish(*clear);
    CHECK(sum(render(clear, given).film) == 0);
    clear->media.clear();
    finish(*clear);
    CHECK(sum(render(clear, given).film) == 0);
    const auto dark = two_media();
    dark->lights.clear();
    finish(*dark);
    CHECK(sum(render(dark, given).film) == 0);
    // The light, then the camera in a medium; a light without a ball, straight ahead of the camera and of vertices.
    const auto extreme = two_media();
    for (const Point3& place : {Point3(0.9, 0, -0.2), Point3(-0.5, 0, 0), Point3(0.1, 0.5, 0), Point3(0, 0, 0)}) {
      extreme->lights[0] = scene::PointLight{place, Rgb(1, 1, 1), place[2] == 0 ? 0 : 0.01};
      for (const Point3& camera : {Point3(0, 0, 5), Point3(1, 0.1, 0)}) {
        extreme->camera = scene::look_at(camera, place + Vec3(0, 0, -1e-3), {0, 1, 0});
        finish(*extreme);
        const scene::Film film = render(extreme, given).film;
        CAPTURE(bounded, place.transpose(), camera.transpose());
        CHECK(airlight::test::all_finite(film));
        CHECK(sum(film) > 0);
      }
    }
  }
  const auto reason = [&](const scene::Scene& scene, const Given& given) {
    const auto reasons = method.supports(scene, {method.settings(), given});
    return reasons.empty() ? std::string() : reasons.front();
  };
  const auto scene = two_media();
  CHECK_THROWS_WITH(render(scene, with(by_vertices, {{"edge_split", "4096"}, {"plane_levels", "4096"}})),
                    Catch::Contains("fewer plane_levels"));
  // A size that one medium may have is too much for many media and six lights.
  const auto many = two_media();
  many->name = "many";
  many->lights.resize(6, many->lights[0]);
  CHECK_THROWS_WITH(render(many, with(by_vertices, {{"bounded", "paper"}, {"boundary_cells", "1024"}})),
                    Catch::StartsWith("many: shadow_planes would hold 6.7 GB for 6 lights and 2 media") &&
                        Catch::Contains("boundary_cells = 1024, expected at most 1.5 GB: fewer plane_levels"));
  CHECK(reason(*scene, by_vertices).empty());
  CHECK(reason(*scene, with(by_vertices, {{"shadows", "none"}})).empty());
  CHECK(reason(*scene, {{"evaluation", "vertices"}}) == "evaluation = vertices goes with shadows = stencil or none");
  CHECK_FALSE(reason(*scene, {{"evaluator", "polynomial"}}).empty());
  CHECK(reason(*scene, {{"evaluator", "polynomial"}, {"bounded", "paper"}}).empty());
  CHECK_FALSE(reason(*scene, {{"evaluator", "polynomial"}, {"bounded", "paper"}, {"annex", "true"}}).empty());
  scene->camera.kind = scene::Camera::Kind::orthographic;
  CHECK_FALSE(reason(*scene, by_vertices).empty());
  scene->media[0].region = scene::Slab{};
  CHECK_FALSE(reason(*scene, {{"bounded", "paper"}}).empty());
}

}  // namespace vertices_test
