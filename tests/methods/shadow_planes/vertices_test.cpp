// The paper's evaluation: airlight at vertices, and media one by one with a stencil.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/shadow_planes/media_boundary.h"
#include "methods/shadow_planes/paper_medium.h"
#include "methods/shadow_planes/plane_mesh.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "scene/geometry/shapes.h"
#include "tests/methods/shadow_planes/vectors.h"

using namespace airlight;
using namespace airlight::shadow_planes;
using namespace shadow_planes_test;
using Given = std::map<std::string, std::string>;

namespace {

scene::Rendering render(const std::shared_ptr<const scene::Scene>& scene, const Given& given) {
  const ShadowPlanes method;
  return method.prepare(scene, {method.settings(), given}, {1, {}})->render(view_of(*scene), {1, {}});
}

// Relative L2 of a layer's difference.
double difference(const scene::Film& got, const scene::Film& expected, const std::string& layer = "airlight") {
  double sum = 0, all = 0;
  for (std::size_t i = 0; i < expected.layer(layer).size(); ++i) {
    const double e = expected.layer(layer)[i], d = got.layer(layer)[i] - e;
    sum += d * d;
    all += e * e;
  }
  return std::sqrt(sum / all);
}

bool finite(const scene::Film& film) {
  for (const char* layer : {"airlight", "mean"})
    for (const float v : film.layer(layer))
      if (!std::isfinite(v)) return false;
  return true;
}

double sum(const scene::Film& film) {
  double all = 0;
  for (const float v : film.layer("airlight")) all += v;
  return all;
}

// A box over a floor, between light and floor.
std::shared_ptr<scene::Scene> box_in_fog() {
  auto scene = std::make_shared<scene::Scene>();
  scene->name = "box in fog";
  scene->width = 64;
  scene->height = 48;
  scene->camera = scene::look_at({0.5, 1, 5}, {0, 0, 0}, {0, 1, 0});
  scene->lights.emplace_back(scene::PointLight{{0.3, 2.5, -0.4}, Rgb(5, 4, 3), 0.02});
  scene->media.resize(1);
  scene->media[0].sigma_t = Rgb(0.1, 0.2, 0.4);
  scene->surfaces = {{"box", scene::make_box({{-0.2, 0.6, -0.5}, {0.4, 1.0, 0.2}}), scene::Lambert{}},
                     {"floor", scene::Plane{{0, -1, 0}, {0, 1, 0}}, scene::Lambert{}}};
  finish(*scene);
  return scene;
}

// A box and a sphere of fog, shadows of a box in them; all within view.
std::shared_ptr<scene::Scene> two_media() {
  auto scene = box_in_fog();
  scene->name = "two media";
  scene->media.resize(2);
  scene->media[0].region = scene::Sphere{{0.9, -0.1, -0.2}, 0.8};
  scene->media[0].sigma_t = Rgb(1, 0.2, 0.2);
  scene->media[1].region = Box{{-1.4, -0.7, -0.8}, {-0.1, 0.4, 0.7}};
  scene->media[1].sigma_t = Rgb(0.2, 0.4, 1.2);
  finish(*scene);
  return scene;
}

const Given by_vertices = {{"shadows", "stencil"}, {"evaluation", "vertices"}};
Given with(Given given, const Given& more) {
  for (const auto& [key, value] : more) given[key] = value;
  return given;
}

}  // namespace

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
  // What is seen of the box has its own, constant error.
  scene->camera = scene::look_at({0.5, -0.6, 5}, {0.2, -0.5, 0}, {0, 1, 0});
  scene->camera.vertical_fov = 0.25;
  const scene::Film expected = render(scene, {{"shadows", "stencil"}, {"edge_split", "16"}}).film;
  const auto error = [&](int levels) {
    return difference(
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
    return difference(got.film, render(scene, {{"shadows", "none"}}).film);
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
  const Given fine = {{"edge_split", "64"}, {"boundary_cells", "64"}, {"plane_levels", "64"}};
  const scene::Rendering stencil = render(scene, with(with(paper, {{"shadows", "stencil"}}), fine));
  CHECK(difference(stencil.film, counted.film) < 1e-5);  // one convex occluder: any order will do, finely cut
  // What is drawn is what is lit within a medium: no plane in front of one, none behind.
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
    CHECK(finite(got.film));
    const double e = difference(got.film, counted.film);
    CAPTURE(cells, e, before);
    CHECK(e < 0.4 * before);
    before = e;
  }
  CHECK(before < 5e-3);
  // In 8 bits.
  const scene::Film coarse = render(scene, with(with(paper, by_vertices), with(fine, {{"frame_buffer", "true"}}))).film;
  for (const float v : coarse.layer("airlight")) CHECK(std::abs(255 * v - std::round(255 * v)) < 1e-4f);
  CHECK(difference(coarse, counted.film) < 0.2);
  CHECK(difference(coarse, counted.film) > 0.005);
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

// A second box, out of sight, whose planes cross rays between the camera and the media.
TEST_CASE("shadow planes: planes in front of a medium change nothing", "[shadow_planes]") {
  const auto scene = two_media(), more = two_media();
  more->surfaces.push_back({"small", scene::make_box({{0.3, 1.95, 0.5}, {0.5, 2.05, 0.7}}), scene::Lambert{}});
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
  CHECK(difference(render(scene, {{"shadows", "stencil"}, {"edge_split", "256"}}).film, render(scene, {}).film) < 1e-6);
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
        CHECK(finite(film));
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
  // What one medium may hold is too much for many, and six lights.
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
