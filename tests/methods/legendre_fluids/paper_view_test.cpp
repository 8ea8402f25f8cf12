// Variant `paper` before pictures with depth, among particles, on surfaces: what air between eye and end sends, as a difference of E_s.
#include "methods/legendre_fluids/paper_view.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "methods/legendre_fluids/light.h"
#include "scene/flow/particles.h"
#include "scene/math/gauss_legendre.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

namespace paper_view_test {

using namespace airlight;
using namespace airlight::legendre_fluids;
using namespace airlight::legendre_fluids::testing;
using namespace airlight::test;
using Catch::Contains;

namespace {

const LegendreLight method;
constexpr int width = 24, height = 20;
constexpr double eye = 5;  // of lit_scene: from the camera to the middle of the box

Given paper(int n, const char* closure = "upwind") {
  return {{"variant", "paper"}, {"closure", closure}, {"n", std::to_string(n)}};
}

// A picture whose pixels have these depths, of one colour.
template <class Depth>
std::shared_ptr<scene::Scene> before(std::shared_ptr<scene::Scene> scene, const Rgb& radiance, const Depth& depth) {
  auto backdrop = std::make_shared<scene::Backdrop>();
  backdrop->width = scene->width;
  backdrop->height = scene->height;
  for (int y = 0; y < scene->height; ++y)
    for (int x = 0; x < scene->width; ++x) {
      backdrop->depth.push_back(float(depth(x, y)));
      for (int c = 0; c < 3; ++c) backdrop->radiance.push_back(float(radiance[c]));
    }
  scene->backdrops = {backdrop};
  finish(*scene);
  return scene;
}

// In front of the box, in it, behind it, and without end.
double uneven(int x, int y) { return (x + y) % 7 == 6 ? double(infinity) : eye - 2 + 4.0 * x / width + 0.01 * y; }

std::shared_ptr<scene::Scene> uneven_scene(const scene::Medium& medium, const Vec3& light, const Vec3& view) {
  return before(lit_scene(medium, light, view, width, height), {2, 3, 4}, uneven);
}

double value_at(const scene::TensorShape& shape, const Eigen::VectorXd& c, const Vec3& x) {
  return series_value(shape, c.data(), x);
}

}  // namespace

// The source that a series solves its equation for is omega.grad E + sigma r E; its integral along the ray, by quadrature, is what a film
// has. Rounding of a film: 6e-8 of what the terms are.
TEST_CASE("legendre light: air before an end sends the integral of what the system's series scatters",
          "[legendre_fluids][light]") {
  const double sigma = 1.3, albedo = 0.8;
  struct {
    const char* name;
    Vec3 light, view;
    double back;  // of the camera, from where it lies
    bool negative;
  } const cases[] = {{"oblique", oblique_light, oblique_view, 0, false},
                     {"along an axis", {0, 1, 0}, {0, 0, -1}, 0, false},
                     {"from within", oblique_light, oblique_view, -5.2, false},
                     {"below 0 in places", oblique_light, oblique_view, 0, true}};
  for (const auto& c : cases) {
    const scene::TensorShape shape{4, 3, 5};
    scene::LegendrePointer field = random_density(shape, 11);
    if (c.negative) {
      Eigen::VectorXd wilder = field->coefficients();
      wilder.tail(wilder.size() - 1) *= 2.5;
      field = std::make_shared<const scene::LegendreBox>(unit_box, shape, wilder);
    }
    auto scene = lit_scene(smoke(field, sigma, albedo), c.light, c.view, width, height);
    scene->camera.position -= c.back * scene->camera.forward;
    const double ahead = c.back;
    scene = before(scene, {2, 3, 4}, [&](int x, int y) { return std::max(uneven(x, y) + ahead, 0.05); });
    PaperOptions options;
    options.n = 6;
    options.solver.closure = Closure::upwind;
    const PaperLight light(*field, options, {true, true, true});
    const Vec3 to_eye = -scene->camera.forward;
    const double omega = 1 / (4 * pi);
    const Eigen::VectorXd e = light.scattered(light.direct(-c.light.normalized(), sigma), to_eye, sigma, sigma * omega);
    const scene::Film film = picture(method, scene, paper(6));
    // By three points, exact for cubes, of a series of degree at most 15 along a line: the slope is taken by Gauss points instead.
    const scene::GaussLegendre rule = scene::gauss_legendre(40);
    double worst = 0, least = 1;
    int inside = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Ray ray = camera_ray(scene->camera, x + 0.5, y + 0.5, width, height);
        const double end = camera_end(*scene, ray).t;
        const Interval t = scene::clip(unit_box, ray, {0, end});
        if (t.empty()) continue;
        inside += t.hi == end;
        const auto density = [&](double s) { return field->value(ray.at(s)); };
        const auto along = [&](double s) { return value_at(light.shape(), e, ray.at(s)); };
        const auto integral = [&](double lo, double hi, const auto& f) {
          double sum = 0;
          for (std::size_t i = 0; i < rule.node.size(); ++i)
            sum += 0.5 * (hi - lo) * rule.weight[i] * f(0.5 * (lo + hi) + 0.5 * (hi - lo) * rule.node[i]);
          return sum;
        };
        // omega points to the eye, against the ray; by a central difference of fourth order, h^4 of it 1e-13 of the sixth slope.
        const double h = 1e-3;
        const auto slope = [&](double s) {
          return (along(s - 2 * h) - 8 * along(s - h) + 8 * along(s + h) - along(s + 2 * h)) / (12 * h);
        };
        const auto source = [&](double s) { return -slope(s) + sigma * density(s) * along(s); };
        double sent =
            integral(t.lo, t.hi, [&](double s) { return source(s) * std::exp(-sigma * integral(t.lo, s, density)); });
        const double clear = std::exp(-sigma * integral(t.lo, t.hi, density));
        if (t.hi < end) sent += clear * along(t.hi);  // no light comes in from behind: E_s there is taken as 0
        const std::size_t at = 3 * (std::size_t(y) * width + std::size_t(x));
        worst = std::max(worst, std::abs(film.layer("airlight")[at] - albedo * std::max(sent, 0.0)));
        CHECK(film.layer("transmittance")[at] == Approx(clear).epsilon(2e-7));
        least = std::min(least, double(film.layer("transmittance")[at]));
        if (end < infinity) CHECK(film.layer("surface")[at + 1] == Approx(3 * clear).epsilon(2e-7));
        CHECK(film.layer("mean")[at] == Approx(film.layer("surface")[at] + film.layer("airlight")[at]).margin(1e-7));
      }
    CAPTURE(c.name, worst);
    CHECK(worst <= 2e-8);  // radiances are up to 0.1: single precision
    CHECK(inside >= 80);
    CHECK(least < 0.3);
    if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("{}: {:.1e}, {} within\n", c.name, worst, inside);
  }
}

TEST_CASE("legendre light: a particle in front hides the medium, one behind is seen through all of it",
          "[legendre_fluids][light]") {
  const scene::Medium medium = smoke(random_density({4, 4, 4}, 3), 0.9);
  const auto at = [&](double depth) {
    return before(lit_scene(medium, oblique_light, oblique_view, width, height), {2, 3, 4},
                  [&](int, int) { return depth; });
  };
  for (const char* closure : {"upwind", "least_squares"}) {
    const scene::Film alone =
        picture(method, lit_scene(medium, oblique_light, oblique_view, width, height), paper(6, closure));
    const auto hidden = at(eye - 1.8), behind = at(eye + 1.8);
    const scene::Film front = picture(method, hidden, paper(6, closure));
    const scene::Film back = picture(method, behind, paper(6, closure)), exact = picture(method, behind);
    CHECK(front.layer("mean") == picture(method, hidden).layer("mean"));
    CHECK(*std::max_element(front.layer("airlight").begin(), front.layer("airlight").end()) == 0);
    CHECK(back.layer("airlight") == alone.layer("airlight"));
    CHECK(relative_l2(back, exact, "transmittance") <= 1e-7);
    CHECK(relative_l2(back, exact, "surface") <= 1e-7);
  }
  // Real ones, drawn by the camera: as `ray` sees them where air before them sends nothing, since it is black.
  auto snow = lit_scene(medium, oblique_light, oblique_view, width, height);
  snow->media[0].albedo = Rgb::Zero();
  scene::Particles flakes;
  flakes.radius = 0.05;
  flakes.radiances = {Rgb(1, 2, 3)};
  for (int i = 0; i < 200; ++i)
    flakes.positions.push_back(Point3(std::sin(i), std::sin(1.7 * i), std::sin(2.3 * i)) * 1.2);
  snow->backdrops = {std::make_shared<scene::Backdrop>(scene::draw(flakes, snow->camera, width, height))};
  finish(*snow);
  const scene::Film seen = picture(method, snow, paper(4));
  CHECK(relative_l2(seen, picture(method, snow), "mean") <= 1e-7);
  CHECK(relative_l2(seen, picture(method, snow), "transmittance") <= 1e-7);
}

// Along axes series converge as polynomials do, so do differences of them; obliquely as the table of the specification.
TEST_CASE("legendre light: before pictures with depth the systems converge to exact paths",
          "[legendre_fluids][light]") {
  const auto error = [&](int n, const scene::TensorShape& shape, const Vec3& light, const Vec3& view,
                         const char* layer) {
    const auto scene = uneven_scene(smoke(random_density(shape, 3), 0.5), light, view);
    return relative_l2(picture(method, scene, paper(n)), picture(method, scene), layer);
  };
  const double axes[] = {2.0e-2, 1.9e-3, 9e-5}, oblique[] = {.055, .023, .013};
  for (int i = 0; i < 3; ++i) {
    const int n = 4 + 2 * i;
    const double along = error(n, {4, 4, 1}, {-1, 0, 0}, {0, -1, 0}, "airlight");
    const double across = error(n, {4, 4, 4}, oblique_light, oblique_view, "airlight");
    CAPTURE(n);
    CHECK(along <= 2 * axes[i]);
    CHECK(across <= 2 * oblique[i]);
    CHECK(across >= oblique[i] / 4);
    CHECK(error(n, {4, 4, 4}, oblique_light, oblique_view, "surface") <= 1e-7);
    if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("n {}: axes {:.1e}, oblique {:.3f}\n", n, along, across);
  }
}

TEST_CASE("legendre light: E_d casts the medium's shadowgram on what lies behind", "[legendre_fluids][light]") {
  auto scene = lit_scene(smoke(random_density({4, 4, 4}, 3), 1), {0, 0, 1}, {0, 0, -1}, width, height);
  scene->media[0].sigma_t = {0.5, 1, 2};
  scene->surfaces = {
      {"wall", scene::Plane{Point3(0, 0, -1.5), Vec3::UnitZ()}, scene::Lambert{Rgb(0.8, 0.7, 0.6)}},
      {"ball", scene::Sphere{Point3(2.1, 0, -2), 0.9}, scene::Phong{Rgb(.3, .4, .5), Rgb(.3, .3, .3), 10}}};
  finish(*scene);
  const scene::Film exact = picture(method, scene);
  double surface[3], mean[3];
  for (int i = 0; i < 3; ++i) {
    const scene::Film film = picture(method, scene, paper(4 + 2 * i));
    surface[i] = relative_l2(film, exact, "surface");
    mean[i] = relative_l2(film, exact, "mean");
    if (std::getenv("AIRLIGHT_TEST_FIGURES"))
      fmt::print("n {}: surface {:.1e}, mean {:.1e}\n", 4 + 2 * i, surface[i], mean[i]);
  }
  // Light along an axis: as polynomials do, ten times or more with each two coefficients.
  CHECK(surface[0] <= 1e-3);
  CHECK(surface[2] <= surface[0] / 100);
  CHECK(mean[0] <= 1e-3);
  CHECK(mean[2] <= mean[0] / 100);
  // A background is seen through a medium that does not scatter; one that does is refused.
  scene->lights.push_back(scene::make_constant_environment(Rgb(0.5, 0.6, 0.7)));
  scene->surfaces.clear();
  scene->geometry = nullptr;
  finish(*scene);
  CHECK_THROWS_WITH(picture(method, scene, paper(6)), Catch::Contains("an environment has all of them"));
  scene->media[0].albedo = Rgb::Zero();
  finish(*scene);
  CHECK(relative_l2(picture(method, scene, paper(6)), picture(method, scene), "surface") <= 1e-7);
}

TEST_CASE("legendre light: coloured lights of a factor share a system, others do not", "[legendre_fluids][light]") {
  auto scene = uneven_scene(smoke(random_density({4, 4, 4}, 3), 1), oblique_light, oblique_view);
  const auto iterations = [&] { return render(method, scene, paper(6)).counters.at("iterations"); };
  const double grey = iterations();
  auto& sun = std::get<scene::DirectionalLight>(scene->lights[0]);
  sun.irradiance = {1, 2, 4};
  finish(*scene);
  CHECK(iterations() == grey);
  const scene::Film film = picture(method, scene, paper(6));
  for (std::size_t i = 0; i < film.layer("airlight").size(); i += 3) {
    CHECK(film.layer("airlight")[i + 1] == Approx(2 * film.layer("airlight")[i]).margin(1e-9));
    CHECK(film.layer("airlight")[i + 2] == Approx(4 * film.layer("airlight")[i]).margin(1e-9));
  }
  // Two of them: the sum of two pictures, in each channel its own.
  const auto one = std::make_shared<scene::Scene>(*scene), other = std::make_shared<scene::Scene>(*scene);
  other->lights = {scene::DirectionalLight{Vec3(0.3, 1, 0.2).normalized(), {3, 1, 0.5}}};
  scene->lights.push_back(other->lights[0]);
  const scene::Film both = picture(method, scene, paper(6)), first = picture(method, one, paper(6)),
                    second = picture(method, other, paper(6));
  std::vector<float> sum = first.layer("airlight");
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += second.layer("airlight")[i];
  CHECK(relative_l2(both.layer("airlight"), sum) <= 1e-5);
  // Layers that nobody asks for are not made, and change nothing; beside a wall, too.
  scene->surfaces = {{"wall", scene::Plane{6 * oblique_view, -oblique_view}, scene::Lambert{Rgb(0.8, 0.7, 0.6)}}};
  for (const bool wall : {true, false}) {
    if (!wall) scene->surfaces.clear(), scene->geometry = nullptr;
    finish(*scene);
    const auto prepared = method.prepare(scene, {method.settings(), paper(6)}, {});
    const auto film = [&](std::optional<std::set<std::string>> layers) {
      return prepared->render(view_of(*scene), {1, {}, nullptr, std::move(layers)}).film;
    };
    const scene::Film screen = film(std::set<std::string>{}), all = film({});
    CHECK(relative_l2(screen, all, "mean") == 0);
    CHECK(screen.layers.size() == 1);
    CHECK(all.layers.size() == 4);
  }
}

TEST_CASE("legendre light: what the systems cannot see is refused by name", "[legendre_fluids][light]") {
  auto scene = lit_scene(smoke(random_density({2, 2, 2}, 1), 1), oblique_light, oblique_view, 4, 4);
  const auto reasons = [&] { return method.supports(*scene, {method.settings(), paper(4)}); };
  scene->surfaces = {{"ball", scene::Sphere{Point3(0.2, 0, 0), 0.3}, scene::Lambert{Rgb(0.8, 0.7, 0.6)}}};
  finish(*scene);
  REQUIRE(reasons().size() == 1);
  CHECK_THAT(reasons()[0], Contains("no shadows within the medium"));
  scene->surfaces[0].shape = scene::Sphere{-4 * oblique_light, 0.3};
  finish(*scene);
  CHECK(reasons().empty());
  scene = uneven_scene(smoke(random_density({2, 2, 2}, 1), 1), oblique_light, oblique_view);
  scene::View view = view_of(*scene);
  view.camera.height *= 2;
  const auto prepared = method.prepare(scene, {method.settings(), paper(4)}, {});
  CHECK_THROWS_WITH(prepared->render(view, {}), Contains("belongs to the scene's own camera"));
}

}  // namespace paper_view_test
