// The renderer: closed forms, extremes (section 10 of the specification), what it refuses, frames after frames.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "methods/compensated_ray_marching/sphere_sets.h"
#include "methods/compensated_ray_marching/warm_start.h"
#include "scene/convert/residual.h"
#include "scene/geometry/round_shapes.h"
#include "scene/geometry/shapes.h"
#include "scene/media/fitted.h"
#include "tests/methods/compensated_ray_marching/puffs.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"
#include "tests/oracle_vectors.h"
#include "tests/pictures.h"

namespace renderer_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;
using compensated_ray_marching::CompensatedRayMarching;

namespace {

const CompensatedRayMarching method;
const Given paper{{"variant", "paper"}};

// 1 + 0.8 cos towards +y in the red, from the side in the others.
scene::EnvironmentLight uneven(double turn = 0) {
  const double one = std::sqrt(4 * pi), slope = std::sqrt(4 * pi / 3);
  const Mat3 rotation = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
  return scene::make_sh_environment(
      {Rgb::Constant(one), Rgb(-0.8 * slope, 0, 0.2), Rgb(0, 0.5, 0), Rgb(0, -0.5 * slope, 0.4)}, rotation,
      Rgb::Ones());
}

bool finite(const scene::Film& film) {
  for (const auto& [name, values] : film.layers)
    for (const float v : values)
      if (!std::isfinite(v)) return false;
  return true;
}

}  // namespace

TEST_CASE("compensated march: what scatters everything is not seen in an even light", "[compensated_ray_marching]") {
  const auto error = [](double sigma_t, int cells) {
    const scene::Film film = picture(method, in_white(puffs(), sigma_t, 1), {{"cells", std::to_string(cells)}}, 0);
    double most = 0;
    for (const float v : film.layer("mean")) most = std::max(most, std::abs(v - 1.0));
    return most;
  };
  // Thin and half deep smoke: cells' means alone, of second order in the cell.
  for (const double sigma_t : {0.1, 2.0}) {
    const double coarse = error(sigma_t, 12), fine = error(sigma_t, 32);
    CAPTURE(sigma_t, coarse, fine);
    CHECK(fine < 0.012);
    CHECK(fine < 0.7 * coarse);
  }
  // Deep smoke, whose 12 cells become 20 lest they be too deep: the middle is dark by what the sweeps smear across
  // boundary layers of 1 / (8 m^-1), thinner than a cell; of first order at best, as in the ball of the ordinates' own tests.
  const double coarse = error(8, 12), fine = error(8, 64);
  CAPTURE(coarse, fine);
  CHECK(coarse < 0.02);
  CHECK(fine < 0.7 * coarse);
}

TEST_CASE("compensated march: rays out of a ball of smoke under an even sky",
          "[compensated_ray_marching][slow][thorough]") {
  for (const json& v : vectors_of("compensated_ray_marching", "multiple_scattering_sphere")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    const json& rbf = in.at("rbf_x_y_z_r_w").at(0);
    const double r = number(rbf[3]);
    const Point3 centre = vec(rbf);
    auto s = std::make_shared<scene::Scene>();
    scene::Medium smoke;
    smoke.field = scene::GaussianSum{{{centre, r, number(rbf[4])}}, 0, number(in.at("cut"))};
    smoke.sigma_t = Rgb::Constant(number(in.at("sigma_t")));
    smoke.albedo = Rgb::Constant(number(in.at("albedo")));
    smoke.phase = scene::HenyeyGreenstein{number(in.at("g"))};
    s->media = {smoke};
    s->lights = {scene::make_constant_environment(Rgb::Ones())};
    s->width = s->height = 1;
    finish(*s);
    std::vector<double> errors;
    for (const int cells : {3, 8}) {  // a radius; directions with them. At 4 and g = 0 errors cancel: 0.0007
      const Given given{{"cells", std::to_string(6 * cells + 1)},
                        {"levels", std::to_string(2 * cells)},
                        {"ordinate_levels", std::to_string((cells + 1) / 2)},
                        {"azimuths", std::to_string(2 * cells)},
                        {"slices", "1024"},
                        {"deepest_cell", "9"}};
      const auto prepared = method.prepare(s, {method.settings(), given}, {0, {}});
      double error = 0, size = 0;
      for (std::size_t k = 0; k < in.at("impact_over_r").size(); ++k) {
        const Point3 eye = centre + Vec3(number(in.at("impact_over_r")[k]) * r, 0, 1);
        const scene::Film film =
            prepared->render({scene::look_at(eye, eye - Vec3::UnitZ(), Vec3::UnitY()), 1, 1}, {1, {}}).film;
        const double radiance = number(expected.at("exit_radiance")[k]),
                     left = number(expected.at("exit_transmittance")[k]);
        CHECK(std::abs(film.get("transmittance", 0, 0)[0] - left) <= 1e-4 * left);
        error += std::pow(film.get("mean", 0, 0)[0] - radiance, 2);
        size += radiance * radiance;
      }
      errors.push_back(std::sqrt(error / size));
    }
    CAPTURE(v.at("id").get<std::string>(), errors[0], errors[1]);
    CHECK(errors[1] < (number(in.at("albedo")) < 0.95 ? 0.002 : 0.004));
    CHECK(errors[1] < 0.4 * errors[0]);
  }
}

TEST_CASE("compensated march: albedo 0, no light, thin and black smoke", "[compensated_ray_marching]") {
  for (const Given& given : {Given{}, paper}) {
    CAPTURE(given);
    const scene::Film black = picture(method, in_white(puffs(), 2, 0), given);
    CHECK(relative_l2(black.layer("mean"), black.layer("transmittance")) < 1e-6);
    for (const float v : black.layer("airlight")) REQUIRE(v == 0);
    const scene::Film dark =
        picture(method, scene_of(puffs(), 2, 0.9, scene::make_constant_environment(Rgb::Zero())), given);
    for (const float v : dark.layer("mean")) REQUIRE(v == 0);
    const scene::Film thin = picture(method, in_white(puffs(), 1e-6), given);
    for (const float v : thin.layer("mean")) REQUIRE(std::abs(v - 1) < 1e-5);
    Given any_depth = given;
    if (given.empty()) any_depth["deepest_cell"] = "1e9";
    const scene::Film thick = picture(method, in_white(puffs(), 1e4), any_depth);
    CHECK(finite(thick));
    const std::size_t middle = 3 * (4 * 12 + 6);
    CHECK(thick.layer("transmittance")[middle] == 0);
    for (const float v : thick.layer("mean")) REQUIRE((v >= 0 && v < (given.empty() ? 1.5 : 1e3)));
  }
}

TEST_CASE("compensated march: paper leaves out what is less than the tolerance, and a residual of nothing",
          "[compensated_ray_marching]") {
  const auto stage = [](const std::shared_ptr<scene::Scene>& scene, const char* name) {
    for (const scene::Stage& s : method.prepare(scene, {method.settings(), paper}, {1, {}})->stages())
      if (s.name == name) return s;
    FAIL("no stage " << name);
    return scene::Stage{};
  };
  // Columns along the axes of puffs(): sqrt(pi) (0.4 + 0.25 0.7 + 0.3 0.9) = 1.498; 2e-4 is the tolerance.
  const auto kept = [&](double sigma_t, double albedo) {
    const auto scene = in_white(puffs(), sigma_t, albedo);
    const scene::Stage s = stage(scene, "multiple scattering");
    CHECK((render(method, scene, paper).counters.at("iterations") > 0) == s.kept);
    CHECK_THAT(s.reason, Contains(s.kept ? "iterations, residual" : "of the light is scattered again"));
    return s.kept;
  };
  CHECK_FALSE(kept(1e-6, 0.8));
  CHECK_FALSE(kept(1.6e-4, 0.8));
  CHECK(kept(1.8e-4, 0.8));
  CHECK_FALSE(kept(30, 1.9e-4));
  CHECK(kept(30, 2.1e-4));

  scene::VoxelGrid grid;
  grid.size = {8, 8, 8};
  grid.voxel_size = 0.2;
  grid.translation = Vec3::Constant(-0.7);
  auto fitted = std::make_shared<scene::Fitted>();
  fitted->gaussians = puffs();
  grid.values = scene::decoded(grid, puffs(), {}).values;
  scene::QuantisationOptions one;
  one.step = 1;
  fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(grid, puffs(), one));
  fitted->grid = scene::decoded(puffs(), *fitted->residual);
  const auto of_fit = in_white(puffs(), 2);
  of_fit->media[0].field = scene::FittedPointer(fitted);
  finish(*of_fit);
  CHECK_FALSE(stage(of_fit, "residual").kept);
  const Given alone{{"variant", "paper"}, {"residual", "false"}};
  CHECK(picture(method, of_fit, paper).layer("mean") == picture(method, of_fit, alone).layer("mean"));
  for (float& v : grid.values) v += 2;
  fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(grid, puffs(), one));
  fitted->grid = scene::decoded(puffs(), *fitted->residual);
  finish(*of_fit);
  CHECK(stage(of_fit, "residual").kept);
}

TEST_CASE("compensated march: no Gaussian, one, two at one place, one without weight, the eye within",
          "[compensated_ray_marching]") {
  scene::GaussianSum none, empty, one, twins, idle = puffs();
  none.cutoff = empty.cutoff = one.cutoff = twins.cutoff = 3;
  empty.gaussians = {{{0, 0, 0}, 0.5, 0}};
  one.gaussians = {{{0, 0, 0}, 0.5, 1}};
  twins.gaussians = {{{0, 0, 0}, 0.5, 0.5}, {{0, 0, 0}, 0.5, 0.5}};
  idle.gaussians.push_back({{0, 0, 0}, 0.5, 0});
  idle.gaussians.push_back({{30, 0, 0}, 0.1, 0});  // where there is nothing at all
  for (const Given& given : {Given{}, paper}) {
    CAPTURE(given);
    for (const scene::GaussianSum& nothing : {none, empty}) {
      const scene::Film clear = picture(method, in_white(nothing, 2), given);
      for (const float v : clear.layer("mean")) REQUIRE(v == 1);
    }
    const scene::Film single = picture(method, in_white(one, 2), given),
                      both = picture(method, in_white(twins, 2), given);
    CHECK(finite(single));
    CHECK(relative_l2(both, single, "mean") < (given.empty() ? 1e-6 : 1e-3));
    CHECK(relative_l2(picture(method, in_white(idle, 2), given), picture(method, in_white(puffs(), 2), given), "mean") <
          1e-6);
    auto inside = in_white(puffs(), 2);
    inside->camera = scene::look_at({0.05, 0.1, 0}, {1, 0.1, 0}, Vec3::UnitY());
    finish(*inside);
    CHECK(finite(picture(method, inside, given)));
  }
}

TEST_CASE("compensated march: phase functions at their ends stay finite and not below 0",
          "[compensated_ray_marching]") {
  for (const double g : {-0.99, 0.99})
    for (const Given& given : {Given{}, paper}) {
      auto scene = scene_of(puffs(), 2, 0.9, uneven());
      scene->media[0].phase = scene::HenyeyGreenstein{g};
      finish(*scene);
      const scene::Film film = picture(method, scene, given);
      CAPTURE(g, given);
      CHECK(finite(film));
      for (const float v : film.layer("airlight")) REQUIRE(v >= 0);
    }
}

TEST_CASE("compensated march: the next frame's light as if prepared anew", "[compensated_ray_marching]") {
  for (const Given& given : {Given{{"cells", "16"}, {"tolerance", "1e-6"}},
                             Given{{"variant", "paper"}, {"iterations", "100"}, {"tolerance", "1e-10"}}}) {
    const auto before = scene_of(puffs(), 4, 0.9, uneven(2)), after = scene_of(puffs(), 4, 0.9, uneven(0.3));
    const scene::Settings settings{method.settings(), given};
    const auto prepared = method.prepare(before, settings, {1, {}});
    const auto times = prepared->next(after, {1, {}});
    REQUIRE(times);
    const scene::Film warm = prepared->render(view_of(*after), {1, {}}).film, cold = picture(method, after, given);
    CAPTURE(given);
    CHECK(greatest_difference(warm, cold, "mean") < 3e-6);
    CHECK(greatest_difference(warm, picture(method, before, given), "airlight") > 0.01);
    auto sun = scene_of(puffs(), 4, 0.9, uneven());
    sun->lights.push_back(scene::DirectionalLight{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)});
    finish(*sun);
    if (given.count("variant")) continue;
    REQUIRE(prepared->next(sun, {1, {}}));
    CHECK(greatest_difference(prepared->render(view_of(*sun), {1, {}}).film, picture(method, sun, given), "mean") <
          1e-5);
  }
}

TEST_CASE("compensated march: other smoke as if prepared anew, from the last frame's solution in fewer iterations",
          "[compensated_ray_marching]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  scene::GaussianSum cloud;
  cloud.cutoff = 3;
  for (int i = 0; i < 20; ++i)
    cloud.gaussians.push_back({{share(random) - 0.5, share(random) - 0.5, share(random) - 0.5},
                               0.15 + 0.15 * share(random),
                               0.2 + 0.5 * share(random)});
  const auto at = [&](double step, double sigma_t) { return scene_of(risen(cloud, step), sigma_t, 0.9, uneven()); };
  const struct {
    Given given;
    bool same, fewer;  // what is asked
  } kinds[] = {{{{"cells", "8"}, {"levels", "4"}, {"order", "2"}, {"tolerance", "1e-4"}, {"slices", "48"}}, true, true},
               {{{"variant", "paper"}, {"order", "2"}, {"iterations", "5000"}, {"tolerance", "1e-9"}, {"slices", "48"}},
                true,
                false},
               {{{"variant", "paper"}, {"order", "2"}, {"iterations", "5000"}, {"tolerance", "0.03"}, {"slices", "48"}},
                false,
                true}};
  for (const auto& [given, same, fewer] : kinds) {
    CAPTURE(given);
    const auto prepared = method.prepare(at(0, 4), {method.settings(), given}, {1, {}});
    // Smoke that moves, smoke whose attributes change, and smoke that was away for a frame.
    for (const auto& scene : {at(0.02, 4.1), at(0.02, 0), at(0.03, 4.1)}) {
      REQUIRE(prepared->next(scene, {1, {}}));
      const scene::Rendering warm = prepared->render(view_of(*scene), {1, {}});
      const scene::Rendering cold =
          method.prepare(scene, {method.settings(), given}, {1, {}})->render(view_of(*scene), {1, {}});
      if (same) CHECK(relative_l2(warm.film, cold.film, "mean") < 3e-4);
      if (!fewer || scene->media[0].sigma_t[0] == 0) continue;
      CHECK(warm.counters.at("iterations") > 0);
      CHECK(warm.counters.at("iterations") < cold.counters.at("iterations"));
    }
  }
  // Without a solution there is nothing to begin with.
  const auto once = method.prepare(at(0, 4), {method.settings(), {{"multiple", "none"}}}, {1, {}});
  CHECK_FALSE(once->next(at(0.02, 4), {1, {}}));
}

TEST_CASE("compensated march: a solution at other centres is a weighted mean, at other nodes trilinear",
          "[compensated_ray_marching]") {
  namespace crm = compensated_ray_marching;
  crm::Solution last;
  last.centres = puffs().gaussians;
  last.of_channel[1] = Eigen::Array3d(2, 5, -1);
  CHECK(crm::at_centres(last, 1, puffs().gaussians) == Eigen::Vector3d(2, 5, -1));
  const scene::Gaussian there{{0.1, 0.3, -0.1}, 0.2, 1}, far{{1e4, 0, 0}, 0.2, 1};
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const scene::Gaussian& g = last.centres[k];
    const double weight = g.amplitude * std::exp(-(there.center - g.center).squaredNorm() / (g.width * g.width));
    sum += weight * last.of_channel[1](Eigen::Index(k), 0);
    weights += weight;
  }
  const Eigen::VectorXd values = crm::at_centres(last, 1, {there, far});
  CHECK(std::abs(values[0] - sum / weights) < 1e-14);
  CHECK(values[1] == 0);
  CHECK(crm::at_centres(last, 0, {there}).size() == 0);

  crm::Solution at_grid;
  at_grid.nodes = crm::node_grid({{0, 0, 0}, {1, 2, 1}}, 8);
  const auto linear = [](const Point3& x) { return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2]; };
  at_grid.of_channel[0].resize(at_grid.nodes.cells.nodes(), 1);
  for (Eigen::Index i = 0; i < at_grid.nodes.cells.nodes(); ++i)
    at_grid.of_channel[0](i, 0) = linear(at_grid.nodes.node(i));
  const crm::NodeGrid other = crm::node_grid({{0.3, 0.4, 0.3}, {0.8, 3, 0.8}}, 9);
  const Eigen::ArrayXXd moved = crm::at_nodes(at_grid, 0, other, 1);
  REQUIRE(moved.rows() == other.cells.nodes());
  const Box known{at_grid.nodes.node(0), at_grid.nodes.node(at_grid.nodes.cells.nodes() - 1)};
  int within = 0, beyond = 0;
  for (Eigen::Index i = 0; i < moved.rows(); ++i) {
    const Point3 x = other.node(i);
    const bool in = (x.array() >= known.lo.array()).all() && (x.array() <= known.hi.array()).all();
    if (in) CHECK(std::abs(moved(i, 0) - linear(x)) < 1e-12);
    within += in;
    beyond += (x.array() > known.hi.array() + at_grid.nodes.cells.cell.array()).any() && moved(i, 0) == 0;
  }
  CHECK(within > 10);
  CHECK(beyond > 10);
  CHECK(crm::at_nodes(at_grid, 0, at_grid.nodes, 1).isApprox(at_grid.of_channel[0]));
  CHECK(crm::at_nodes(at_grid, 0, other, 4).size() == 0);
}

TEST_CASE("compensated march: under a map that turns, the next frame's light as if prepared anew",
          "[compensated_ray_marching]") {
  const auto map = rough_map(64, 32);
  const auto at = [&](double turn) { return scene_of(puffs(), 4, 0.9, rough_sky(turn, map)); };
  for (const Given& given :
       {Given{{"cells", "8"}, {"tolerance", "1e-6"}}, Given{{"variant", "paper"}, {"multiple", "none"}}}) {
    const auto before = at(0);
    const auto prepared = method.prepare(before, {method.settings(), given}, {1, {}});
    for (const auto& scene : {at(0.4), at(2), scene_of(puffs(), 4, 0.9, rough_sky(2, rough_map(32, 16, 3))), before}) {
      REQUIRE(prepared->next(scene, {1, {}}));
      const scene::Film warm = prepared->render(view_of(*scene), {1, {}}).film, cold = picture(method, scene, given);
      CAPTURE(given);
      CHECK(relative_l2(warm, cold) < 3e-6);
      if (scene != before) CHECK(relative_l2(warm, picture(method, before, given)) > 0.01);
    }
  }
}

TEST_CASE("compensated march: the same bits for any number of threads", "[compensated_ray_marching]") {
  const auto scene = scene_of(puffs(), 4, 0.9, uneven());
  for (const Given& given : {Given{{"cells", "16"}}, paper}) {
    const scene::Film one = picture(method, scene, given, 1), two = picture(method, scene, given, 2);
    CHECK(one.layer("mean") == two.layer("mean"));
  }
}

TEST_CASE("compensated march: a ball's shadow on the ground in an even light, in closed form",
          "[compensated_ray_marching]") {
  // What a ball takes of the irradiance on a plane that sees all of it at a distance d, at an angle from the normal: (R/d)^2 cos.
  const double radius = 0.6, height = 1.5;
  auto scene = in_white(puffs(), 0);
  const bool smoke = GENERATE(false, true);
  if (smoke) scene->media[0].sigma_t = Rgb::Constant(1e-6);
  scene->camera = scene::look_at({0, 3, 3}, {0, -1, 0}, Vec3::UnitY());
  scene->camera.vertical_fov = 0.9;
  scene->surfaces = {{"ground", scene::Plane{{0, -1, 0}, Vec3::UnitY()}, scene::Lambert{Rgb::Constant(0.7)}},
                     {"ball", scene::Sphere{{0, height - 1, 0}, radius}, scene::Lambert{Rgb::Constant(0.2)}}};
  finish(*scene);
  // Directions: an edge falls between them; harmonics of 4 bands.
  const std::vector<std::tuple<Given, double, double>> kinds{
      {{{"levels", "24"}}, 0.03, 0.006},
      {{{"variant", "paper"}}, 0.03, 0.012},
      {{{"variant", "paper"}, {"transmittance", "ol"}}, 0.06, 0.03},
      {{{"variant", "paper"}, {"transmittance", "directional"}}, 0.05, 0.015}};
  for (const auto& [given, worst, root_mean] : kinds) {
    CAPTURE(given, smoke);
    const scene::Film film = picture(method, scene, given);
    double most = 0, sum = 0;
    int count = 0, in_shadow = 0;
    for (int y = 0; y < film.height; ++y)
      for (int x = 0; x < film.width; ++x) {
        const Ray ray = camera_ray(scene->camera, x + 0.5, y + 0.5, film.width, film.height);
        const auto hit = scene->geometry->first_hit(ray);
        if (!hit || hit->surface != 0) continue;
        const Vec3 way = Point3(0, height - 1, 0) - hit->position;
        const double hidden = std::pow(radius / way.norm(), 2) * way.normalized().y();
        const double off = film.get("surface", x, y)[0] / 0.7 - (1 - hidden);
        most = std::max(most, std::abs(off));
        sum += off * off;
        ++count;
        in_shadow += hidden > 0.1;
      }
    REQUIRE(count > 60);
    REQUIRE(in_shadow > 5);
    CHECK(most < worst);
    CHECK(std::sqrt(sum / count) < root_mean);
  }
}

// A ball as a mesh, 0.6 m wide.
scene::TriangleMesh ball_of_triangles(const Point3& center) {
  scene::DisplacedSphere ball;
  ball.center = center;
  ball.radii = Vec3::Constant(0.6);
  return scene::make_displaced_sphere(ball);
}

TEST_CASE("compensated march: spheres that stand for a mesh lie within it and fill it", "[compensated_ray_marching]") {
  namespace crm = compensated_ray_marching;
  const double cell = 1.2 / 24;
  const auto ball = crm::sphere_set(ball_of_triangles({1, 2, 3}), 1000);
  REQUIRE(!ball.empty());
  CHECK(ball[0].radius > 0.6 - cell);
  for (const scene::Sphere& s : ball) CHECK((s.center - Point3(1, 2, 3)).norm() + s.radius < 0.6 + cell);
  // A bar: balls in a row, as wide as it is.
  const auto bar = crm::sphere_set(scene::make_box({{-1, -0.2, -0.2}, {1, 0.2, 0.2}}), 12);
  REQUIRE(bar.size() > 4);
  CHECK(crm::sphere_set(scene::make_box({{-1, -0.2, -0.2}, {1, 0.2, 0.2}}), 3).size() == 3);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-1, 1), across(-0.2, 0.2);
  int covered = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point3 x(along(random), across(random), across(random));
    covered += std::any_of(bar.begin(), bar.end(), [&](const auto& s) { return (x - s.center).norm() < s.radius; });
  }
  CHECK(covered > 0.6 * 2000);
  for (const scene::Sphere& s : bar) CHECK((Vec3(1, 0.2, 0.2) - s.center.cwiseAbs()).minCoeff() > s.radius - 2.0 / 24);
  // A sheet encloses nothing.
  scene::TriangleMesh sheet = scene::make_box({{-1, -1, -1}, {1, 1, 1}});
  sheet.triangles.resize(2);
  CHECK(crm::sphere_set(sheet, 10).empty());
}

TEST_CASE("compensated march: published, a mesh shows shadows as a plane does, and casts them as a ball does",
          "[compensated_ray_marching]") {
  const auto with = [](scene::Shape ground, scene::Shape object) {
    auto scene = scene_of(puffs(), 3, 0.8, uneven());
    scene->camera = scene::look_at({0, 3, 3}, {0, -1, 0}, Vec3::UnitY());
    scene->camera.vertical_fov = 0.7;
    scene->surfaces = {{"ground", std::move(ground), scene::Lambert{Rgb(0.7, 0.6, 0.5)}},
                       {"ball", std::move(object), scene::Lambert{Rgb::Constant(0.2)}}};
    finish(*scene);
    return scene;
  };
  const scene::Plane plane{{0, -1, 0}, Vec3::UnitY()};
  const scene::TriangleMesh slab = scene::make_box({{-20, -1.5, -20}, {20, -1, 20}});
  const scene::Sphere ball{{1.1, -0.3, 0.4}, 0.6};
  for (const char* transmittance : {"hyb", "directional"}) {
    const Given given{{"variant", "paper"}, {"transmittance", transmittance}},
        flat{{"variant", "paper"}, {"transmittance", transmittance}, {"mesh_spheres", "0"}};
    CAPTURE(transmittance);
    const scene::Film on_plane = picture(method, with(plane, ball), given);
    CHECK(relative_l2(picture(method, with(slab, ball), flat), on_plane, "mean") < 1e-6);
    const scene::Film of_mesh = picture(method, with(plane, ball_of_triangles(ball.center)), given);
    const scene::Film without = picture(method, with(plane, ball_of_triangles(ball.center)), flat);
    CHECK(relative_l2(of_mesh, on_plane, "surface") < 0.03);
    CHECK(relative_l2(of_mesh, on_plane, "airlight") < 0.03);
    CHECK(relative_l2(without, on_plane, "surface") > 0.06);
    CHECK(relative_l2(without, on_plane, "airlight") > 0.06);
  }
}

TEST_CASE("compensated march: no light within a ball, none through a closed room", "[compensated_ray_marching]") {
  auto scene = in_white(puffs(), 3);
  scene->surfaces = {{"room", scene::Sphere{{0, 0, 0}, 3}, scene::Lambert{Rgb::Constant(0.5)}}};
  scene->camera = scene::look_at({0, 0, 2}, {0, 0, 0}, Vec3::UnitY());
  finish(*scene);
  for (const Given& given : {Given{}, paper, Given{{"variant", "paper"}, {"transmittance", "directional"}}}) {
    CAPTURE(given);
    const scene::Film film = picture(method, scene, given);
    const std::vector<float>& airlight = film.layer("airlight");
    CHECK(*std::max_element(airlight.begin(), airlight.end()) < 1e-5);
    CHECK(*std::min_element(film.layer("transmittance").begin(), film.layer("transmittance").end()) < 0.3);
  }
}

TEST_CASE("compensated march: refusals name the reason", "[compensated_ray_marching]") {
  const auto reason = [](const scene::Scene& scene, const Given& given = {}) {
    const auto reasons = method.supports(scene, {method.settings(), given});
    return reasons.empty() ? std::string() : reasons.front();
  };
  auto scene = in_white(puffs(), 2);
  CHECK(reason(*scene).empty());
  CHECK(reason(*scene, paper).empty());
  scene->lights.push_back(scene::PointLight{});
  CHECK_THAT(reason(*scene), Contains("light 1 is point"));
  scene->lights[1] = scene::DirectionalLight{};
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, paper), Contains("light 1 is directional"));
  scene->lights.pop_back();
  std::get<scene::GaussianSum>(scene->media[0].field).gaussians[0].amplitude = -0.1;
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, paper), Contains("negative amplitude"));
  scene->media.push_back(scene->media[0]);
  CHECK_THAT(reason(*scene), Contains("more than one medium"));
  scene->media.resize(1);
  scene->media[0].field = scene::Homogeneous{};
  CHECK_THAT(reason(*scene), Contains("has no end"));
  scene->media[0].region = scene::Sphere{};
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, paper), Contains("homogeneous"));
  CHECK_THROWS_WITH(reason(*scene, {{"multiple", "as_printed"}}), Contains("not for variant = grid"));
  scene->media[0].field = puffs();
  scene->media[0].region = scene::Unbounded{};
  scene->surfaces = {{"ball", scene::Sphere{}, scene::Lambert{}}};
  finish(*scene);
  CHECK(reason(*scene, paper).empty());
  CHECK_THAT(reason(*scene, {{"multiple", "p1"}}), Contains("p1 diffuses light through them"));
  scene->surfaces[0].material = scene::Phong{};
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, paper), Contains("surface 'ball' does not reflect as Lambert's"));
  scene->surfaces[0] = {"box", scene::make_box({Point3(-1, -1, -1), Point3(1, 1, 1)}), scene::Lambert{}};
  CHECK(reason(*scene, paper).empty());
  // Cells that stay too deep however small they are.
  CHECK_THROWS_AS(picture(method, in_white(puffs(), 1e4)), scene::NotSupported);
}

}  // namespace renderer_test
