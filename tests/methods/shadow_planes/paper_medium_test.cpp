// Media in the paper's way: a constant R, each for itself.
#include "methods/shadow_planes/paper_medium.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/shadow_planes/polynomial.h"
#include "scene/math/gauss_legendre.h"

namespace paper_medium_test {

using namespace airlight;
using namespace airlight::shadow_planes;

TEST_CASE("shadow planes: mean distance from boundary to inside", "[shadow_planes]") {
  CHECK(mean_distance(scene::Sphere{{1, 2, 3}, 2.5}) == Approx(3).epsilon(1e-15));
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Vec3& size : {Vec3(3, 2, 2), Vec3(1, 1, 1), Vec3(0.2, 1, 4)}) {
    const Vec3 area(size[1] * size[2], size[2] * size[0], size[0] * size[1]);
    constexpr int samples = 400000;
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; ++i) {
      const auto point = [&]() -> Vec3 {
        return Vec3(uniform(engine), uniform(engine), uniform(engine)).cwiseProduct(size);
      };
      Vec3 on_face = point();
      const double choice = uniform(engine) * area.sum();
      const int axis = choice < area[0] ? 0 : choice < area[0] + area[1] ? 1 : 2;
      on_face[axis] = uniform(engine) < 0.5 ? 0 : size[axis];
      const double d = (point() - on_face).norm();
      sum += d;
      squares += d * d;
    }
    const double mean = sum / samples, deviation = std::sqrt((squares / samples - mean * mean) / samples);
    CAPTURE(size.transpose(), mean, deviation);
    CHECK(std::abs(mean_distance(Box{Point3(1, 1, 1), Point3(1, 1, 1) + size}) - mean) < 4 * deviation);
  }
}

TEST_CASE("shadow planes: the polynomial of the paper's media", "[shadow_planes]") {
  const double a = 0.7;
  const std::vector<double> c = bounded_coefficients(PhaseForm{}, a, 4);
  const double expected[] = {1, -a, a * a / 2, -a * a * a / 6 - a / 3, a * a * a * a / 24 + a * a / 3};
  for (int n = 0; n <= 4; ++n) CHECK(c[n] == Approx(expected[n]).epsilon(1e-14));
  Options options;
  options.evaluator = Options::Evaluator::polynomial;
  options.degree = 24;
  scene::Medium medium;
  medium.region = scene::Sphere{{0, 0, 6}, 1.5};
  medium.sigma_t = Rgb(0.1, 0.5, 1);
  medium.albedo = Rgb(0.9, 0.8, 0.7);
  medium.phase = scene::HenyeyGreenstein{0.3};
  const Ray ray{{0, 0, 0}, Vec3(0.05, 0.02, 1).normalized()};
  const scene::Light light = scene::PointLight{{0.2, 2.5, 6.2}, Rgb(3, 2, 1), 0};
  const Rgb rule = PaperMedium(medium, {})(light, ray, {5, 6.5});
  const Rgb got = PaperMedium(medium, options)(light, ray, {5, 6.5});
  CAPTURE(rule, got);
  CHECK(((got - rule).abs() < 1e-6 * rule).all());
}

// Any light, phase and place: the integral by the midpoint rule.
TEST_CASE("shadow planes: the paper's media against brute force", "[shadow_planes]") {
  scene::Medium medium;
  medium.sigma_t = Rgb(0.2, 2, 6);
  medium.albedo = Rgb(1, 0.5, 0.8);
  medium.phase = scene::HenyeyGreenstein{0.6};
  const Ray ray{{0, 0, 0}, Vec3(0.05, 0.02, 1).normalized()};
  for (const scene::Region& region :
       {scene::Region(scene::Sphere{{0, 0, 6}, 1.5}), scene::Region(Box{{-1, -1, 5}, {1, 2, 7}}),
        scene::Region(Box{{-1, -1, -1}, {1, 2, 3}})})
    for (const Point3& at : {Point3(0, 4, 6), Point3(0.3, 0.15, 6), Point3(0, 0, -3), Point3(0.5, 0.3, 2)})
      for (const bool spot : {false, true}) {
        medium.region = region;
        const PaperMedium paper(medium, {});
        scene::Light light = scene::PointLight{at, Rgb(1, 2, 3), 0};
        if (spot) light = scene::SpotLight{at, (ray.at(6) - at).normalized(), 0.2, 0.5, Rgb(1, 2, 3), 0};
        const Interval inside = clip(region, ray, {0, infinity}), lit = intersect(inside, {1, 6.7});
        Rgb expected = Rgb::Zero();
        constexpr int steps = 400000;
        for (int i = 0; i < steps; ++i) {
          const double x = lit.lo + lit.length() * (i + 0.5) / steps;
          const Vec3 d = ray.at(x) - at;
          expected += medium.albedo * medium.sigma_t *
                      scene::phase_value(medium.phase, -d.dot(ray.direction) / d.norm()) *
                      intensity_towards(light, d.normalized()) / d.squaredNorm() *
                      (-medium.sigma_t * (paper.R() + x - inside.lo)).exp();
        }
        expected *= lit.length() / steps;
        const Rgb got = paper(light, ray, {1, 6.7});
        CAPTURE(at.transpose(), spot, got, expected);
        // Dense media that pass close to the light are hardest: 18 times 1/e, 3 cm from it.
        CHECK(((got - expected).abs() <= Rgb(1e-7, 1e-7, 2e-5) * expected).all());
      }
  // Nothing where there is nothing.
  medium.region = scene::Sphere{{0, 5, 6}, 1};
  CHECK((PaperMedium(medium, {})(scene::PointLight{{0, 1, 0}, Rgb::Ones(), 0}, ray, {0, infinity}) == 0).all());
  medium.region = scene::Sphere{{0, 0, 6}, 1};
  CHECK((PaperMedium(medium, {})(scene::PointLight{{0, 1, 0}, Rgb::Ones(), 0}, ray, {0, 4}) == 0).all());
  medium.sigma_t.setZero();
  CHECK((PaperMedium(medium, {})(scene::PointLight{{0, 1, 0}, Rgb::Ones(), 0}, ray, {0, infinity}) == 0).all());
}

// Rays close to the light, in thin and thick media: the light of the entry, which the medium dims least, and that of
// the neighbourhood of the lamp both count.
TEST_CASE("shadow planes: the paper's media close to the light", "[shadow_planes]") {
  const scene::GaussLegendre rule = scene::gauss_legendre(48);
  for (const double k : {0.05, 0.5, 2.0, 6.0, 40.0})
    for (const double h : {1.0, 0.1, 0.01, 1e-3, 1e-5})
      for (const double light : {-2.9, -1.0, 0.0, 2.0, 4.0})
        for (const scene::PhaseFunction& phase :
             {scene::PhaseFunction(scene::Isotropic{}), scene::PhaseFunction(scene::HenyeyGreenstein{0.7})}) {
          scene::Medium medium;
          medium.sigma_t = Rgb::Constant(k);
          medium.phase = phase;
          medium.region = Box{{-3, -2, -2}, {3, 2, 2}};
          const PaperMedium paper(medium, {});
          const Ray ray{{-5, 0, 0}, {1, 0, 0}};
          const double got = paper(scene::PointLight{{light, h, 0}, Rgb::Ones(), 0}, ray, {0, infinity})[0];
          // In x, in pieces that double away from the lamp to both sides, none longer than 2/k.
          double sum = 0;
          for (const double side : {-1.0, 1.0}) {
            const double most = side < 0 ? light + 3 : 3 - light;
            for (double from = std::max(0.0, side < 0 ? light - 3 : -3 - light), to; from < most; from = to) {
              to = std::min({most, from + std::max(0.25 * h, 0.5 * from), from + 2 / k});
              for (std::size_t i = 0; i < rule.node.size(); ++i) {
                const double d = 0.5 * (from + to + (to - from) * rule.node[i]), r2 = d * d + h * h;
                const double cosine = -side * d / std::sqrt(r2);  // towards the eye is -x
                sum += 0.5 * (to - from) * rule.weight[i] * std::exp(-k * (light + side * d + 3 + paper.R())) *
                       phase_value(medium.phase, cosine) / r2;
              }
            }
          }
          const double expected = k * sum;
          CAPTURE(k, h, light, got, expected);
          CHECK(std::abs(got - expected) <= 1e-12 * expected);
        }
}

}  // namespace paper_medium_test
