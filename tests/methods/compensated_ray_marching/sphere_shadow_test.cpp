// Visibility past spheres: its harmonics and its irradiance in closed form, logarithms whose exponentials come back to it, smoke and spheres
// together, fixed directions.
#include "methods/compensated_ray_marching/sphere_shadow.h"

#include <catch2/catch.hpp>

#include "methods/compensated_ray_marching/ordinate_directions.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace sphere_shadow_test {

using namespace airlight;
using namespace airlight::compensated_ray_marching;

namespace {

double distance(const Harmonics& a, const Harmonics& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / (4 * pi));
}

Harmonics visible_past(double angle, const Vec3& axis) { return about_axis(visible_zonal(4, std::cos(angle)), axis); }

// A sphere that hides that angle from the origin.
scene::Sphere hiding(double angle, const Vec3& axis, double away = 2) { return {away * axis, away * std::sin(angle)}; }

const ShadowTable& exact_table() {
  static const ShadowTable table(4, exact_exponential);
  return table;
}
HarmonicExponential series() {
  return [](const Harmonics& f) { return series_exponential(f); };
}

}  // namespace

TEST_CASE("shadows of spheres: visibility in closed form", "[compensated_ray_marching]") {
  const scene::GaussLegendre rule = scene::gauss_legendre(16);
  for (const double angle : {0.0, 0.01, 0.4, 1.0, pi / 2, 2.0, pi}) {
    // Expected coefficients of the visibility: integrals over cosines from -1 to the cosine of the angle.
    const std::vector<double> zonal = visible_zonal(6, std::cos(angle));
    for (int l = 0; l < 6; ++l) {
      double sum = 0;
      for (std::size_t k = 0; k < rule.node.size(); ++k) {
        const double half = 0.5 * (1 + std::cos(angle)), mu = -1 + half * (1 + rule.node[k]);
        sum += half * rule.weight[k] * scene::evaluate_sh(6, {std::sqrt(1 - mu * mu), 0, mu})[std::size_t(l * (l + 1))];
      }
      CAPTURE(angle, l);
      CHECK(zonal[std::size_t(l)] == Approx(2 * pi * sum).margin(1e-13));
    }
  }
  CHECK(*hidden_angle({{0, 0, 4}, 2}, Point3::Zero()) == Approx(pi / 6));
  CHECK_FALSE(hidden_angle({{0, 0, 4}, 4}, Point3::Zero()).has_value());
  CHECK_FALSE(hidden_angle({{0, 0, 4}, 5}, Point3(1, 0, 3)).has_value());
}

TEST_CASE("shadows of spheres: exponentials of the table's logarithms are visibility",
          "[compensated_ray_marching][slow][thorough]") {
  const ShadowTable by_series(4, series());
  const LinearExponential linear(depth_family(4, {1, 2, 4}, 20));
  const ShadowTable by_hyb(4, [&](const Harmonics& f) { return squared_exponential(f, linear, 0.5); });
  CHECK(exact_table().errors().front() < 1e-12);
  CHECK(exact_table().zonal(0)[0] == Approx(0).margin(1e-12));
  for (const double angle : {0.02, 0.1, 0.3, 0.6, 0.85, 1.0, 1.2, 1.5, 1.57}) {
    const Vec3 axis = Vec3(1, -2, 0.5).normalized();
    const Harmonics visible = visible_past(angle, axis);
    const std::vector<scene::Sphere> one{hiding(angle, axis)};
    const double exact = distance(exact_exponential(*log_visibility(one, Point3::Zero(), exact_table())), visible),
                 by_product = distance(series_exponential(*log_visibility(one, Point3::Zero(), by_series)), visible),
                 by_squares =
                     distance(squared_exponential(*log_visibility(one, Point3::Zero(), by_hyb), linear, 0.5), visible);
    CAPTURE(angle, exact, by_product, by_squares);
    // Exact but for the steps of the table while its logarithms are short enough, up to 70 degrees. Squares of four bands lose what they cut
    // off beyond 50.
    CHECK(exact < (angle <= 1.2 ? 1e-3 : 0.01));
    CHECK(by_product < (angle <= 0.85 ? 2e-3 : 0.04));
    CHECK(by_squares < (angle <= 0.85 ? 0.01 : 0.04));  // between samples the number of squarings jumps
    // Each operator has its own table: another's is worse.
    if (angle > 0.5)
      CHECK(distance(series_exponential(*log_visibility(one, Point3::Zero(), exact_table())), visible) > by_product);
  }
  // Four numbers for four: nothing is missed where nothing holds them.
  const ShadowTable free(4, exact_exponential, 32, 60);
  for (const double error : free.errors()) CHECK(error < 1e-10);
  for (const ShadowTable* table : {&exact_table(), &by_series, &by_hyb})
    for (int i = 0; i <= 1000; ++i) {
      double size = 0;
      const std::vector<double> f = table->zonal(pi / 2 * i / 1000);
      for (std::size_t l = 1; l < f.size(); ++l) size += f[l] * f[l];
      CHECK(std::sqrt(size) <= 10 + 1e-9);
    }
}

TEST_CASE("shadows of spheres: several, and smoke", "[compensated_ray_marching][thorough]") {
  const Point3 x(0.3, -0.2, 0.1);
  const auto at = [&](double angle, const Vec3& axis) {
    scene::Sphere sphere = hiding(angle, axis);
    sphere.center += x;
    return sphere;
  };
  // Apart: what both hide is what each does.
  const double a = 0.5, b = 0.35;
  const Vec3 up = Vec3::UnitZ(), aside = Vec3(1, 0, -0.3).normalized();
  Harmonics both = visible_past(a, up);
  const Harmonics other = visible_past(b, aside);
  for (std::size_t i = 0; i < both.size(); ++i) both[i] += other[i] - (i == 0 ? std::sqrt(4 * pi) : 0);
  const Harmonics got = exact_exponential(*log_visibility({at(a, up), at(b, aside)}, x, exact_table()));
  CHECK(distance(got, both) < 0.05);
  CHECK(distance(visible_past(a, up), both) > 0.08);
  // Even smoke all around adds its depth: the same shape, exp(-depth) times.
  Harmonics log = *log_visibility({at(a, up)}, x, exact_table());
  log[0] -= 1.3 * std::sqrt(4 * pi);
  Harmonics dimmed = exact_exponential(log);
  for (double& value : dimmed) value *= std::exp(1.3);
  CHECK(distance(dimmed, visible_past(a, up)) < 2e-3);
  // Inside one nothing is seen, past none all is, and the smallest do not count.
  CHECK_FALSE(log_visibility({at(a, up), {x, 0.1}}, x, exact_table()).has_value());
  CHECK(distance(*log_visibility({}, x, exact_table()), Harmonics(16, 0.0)) == 0);
  CHECK(distance(*log_visibility({at(0.008, up)}, x, exact_table()), Harmonics(16, 0.0)) == 0);
  CHECK(distance(*log_visibility({at(0.02, up)}, x, exact_table()), Harmonics(16, 0.0)) > 0);
}

TEST_CASE("shadows of spheres: irradiance", "[compensated_ray_marching]") {
  const Vec3 normal = Vec3(0.2, 0.9, -0.4).normalized();
  std::vector<Rgb> even(16, Rgb::Zero());
  even[0] = Rgb(1, 2, 3) * std::sqrt(4 * pi);
  Harmonics all(16, 0.0);
  all[0] = std::sqrt(4 * pi);
  CHECK((irradiance(normal, all, even) - pi * Rgb(1, 2, 3)).abs().maxCoeff() < 1e-12);
  // A light with a direction, L = 1 + w.d: pi + 2 pi/3 n.d.
  const Vec3 d = Vec3(1, 1, 0.3).normalized();
  std::vector<Rgb> sided = even;
  const std::vector<double> lobe = about_axis({0, std::sqrt(4 * pi / 3), 0, 0}, d);
  for (std::size_t i = 0; i < 16; ++i) sided[i] = Rgb::Constant(lobe[i] + (i == 0 ? std::sqrt(4 * pi) : 0));
  CHECK(irradiance(normal, all, sided)[0] == Approx(pi + 2 * pi / 3 * normal.dot(d)).epsilon(1e-12));
  // A sphere over the surface hides pi sin^2 of its angle of an even light; four bands of the cosine and of the shadow leave 3 % of pi out.
  for (const double angle : {0.1, 0.4, 0.8, 1.2, 1.57}) {
    const double expected = pi * std::pow(std::cos(angle), 2);
    CAPTURE(angle);
    CHECK(irradiance(normal, visible_past(angle, normal), even)[0] == Approx(expected).margin(0.03 * pi));
    const Harmonics visible =
        exact_exponential(*log_visibility({hiding(angle, normal)}, Point3::Zero(), exact_table()));
    CHECK(irradiance(normal, visible, even)[0] == Approx(expected).margin(0.035 * pi));
  }
  // Behind the surface it hides nothing.
  CHECK(irradiance(normal, visible_past(0.6, -normal), even)[0] == Approx(pi).margin(0.03 * pi));
  CHECK_THROWS_AS(irradiance(normal, all, std::vector<Rgb>(9, Rgb::Zero())), Error);
}

TEST_CASE("shadows of spheres: in fixed directions, with soft edges", "[compensated_ray_marching]") {
  const Vec3 axis = Vec3(0.5, 0.3, 0.8).normalized();
  double soft_worst = 0, hard_worst = 0, fine_worst = 0;
  for (int i = 1; i <= 40; ++i) {
    const double angle = 0.035 * i;
    const std::vector<scene::Sphere> one{hiding(angle, axis)};
    const auto error = [&](int levels, bool soft) {
      double sum = 0;
      for (const Ordinate& d : ordinate_directions(levels, 2 * levels, false))
        sum += d.weight * visible_share(one, Point3::Zero(), d.direction, soft ? pi / levels : 0);
      return std::abs(sum / (4 * pi) - 0.5 * (1 + std::cos(angle)));
    };
    soft_worst = std::max(soft_worst, error(8, true));
    hard_worst = std::max(hard_worst, error(8, false));
    fine_worst = std::max(fine_worst, error(64, true));
  }
  CAPTURE(soft_worst, hard_worst, fine_worst);
  CHECK(soft_worst < 0.5 * hard_worst);
  CHECK(soft_worst < 0.01);
  CHECK(fine_worst < 3e-4);
  const scene::Sphere sphere{{0, 0, 2}, 1};
  CHECK(visible_share({sphere}, Point3::Zero(), Vec3::UnitZ(), 0.1) == 0);
  CHECK(visible_share({sphere}, Point3::Zero(), -Vec3::UnitZ(), 0.1) == 1);
  CHECK(visible_share({sphere}, {0, 0, 1.5}, -Vec3::UnitZ(), 0.1) == 0);
  CHECK(visible_share({sphere}, Point3::Zero(), Vec3(0.5, 0, std::sqrt(0.75)), 0.1) == Approx(0.5));
}

TEST_CASE("shadows of spheres: what is refused", "[compensated_ray_marching]") {
  CHECK_THROWS_AS(ShadowTable(0, series()), Error);
  CHECK_THROWS_AS(ShadowTable(7, series()), Error);
  CHECK_THROWS_AS(ShadowTable(4, series(), 1), Error);
  CHECK_THROWS_AS(ShadowTable(4, series(), 256, 0), Error);
}

}  // namespace sphere_shadow_test
