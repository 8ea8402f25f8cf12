// Reflection in spherical harmonics: identities of products, and Eq. 20 against quadrature over the sphere.
#include "methods/fogshop/harmonic_reflection.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "methods/fogshop/scattered_reflection.h"
#include "methods/fogshop/surface_psf.h"
#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/sh_product.h"
#include "scene/math/spherical_harmonics.h"

namespace harmonic_reflection_test {

using namespace airlight;
using namespace airlight::fogshop;
using scene::triple_product;
using scene::TripleProduct;

namespace {

// Calls body(direction, weight) over the sphere; exact for polynomials of degree 2 n - 1.
template <class Body>
void over_sphere(int n, Body&& body) {
  const scene::GaussLegendre rule = scene::gauss_legendre(n);
  for (int i = 0; i < n; ++i) {
    const double z = rule.node[i], r = std::sqrt((1 - z) * (1 + z));
    for (int k = 0; k < 2 * n; ++k) {
      const double phi = pi * (k + 0.5) / n;
      body(Vec3(r * std::cos(phi), r * std::sin(phi), z), rule.weight[i] * pi / n);
    }
  }
}

// Numbers in [-1, 1] without a pattern.
double number(int i) { return std::sin(12.9898 * (i + 1)) * std::cos(3.7 * i * i + 1); }

std::vector<Rgb> light(int order) {
  std::vector<Rgb> result;
  for (int i = 0; i < order * order; ++i) result.emplace_back(number(3 * i), number(3 * i + 1), number(3 * i + 2));
  return result;
}

std::vector<double> window(int order) {
  std::vector<double> result;
  for (int i = 0; i < order * order; ++i) result.push_back(number(7 * i + 400));
  return result;
}

double value(const std::vector<double>& f, const Vec3& direction) {
  std::vector<Rgb> grey;
  for (const double c : f) grey.push_back(Rgb::Constant(c));
  return scene::evaluate_sh(grey, direction)[0];
}

const Vec3 normal = Vec3(0.3, 0.8, -0.4).normalized();
const Vec3 to_view = Vec3(-0.5, 0.7, 0.2).normalized();

}  // namespace

TEST_CASE("integrals of three harmonics", "[fogshop]") {
  for (const int order : {1, 2, 4, 6}) {
    const int size = order * order;
    // All of them by quadrature: nothing is missing from the list, nothing is there twice.
    std::vector<double> expected(size * size * size, 0.0);
    over_sphere(2 * order, [&](const Vec3& direction, double weight) {
      const std::vector<double> y = scene::evaluate_sh(order, direction);
      for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j)
          for (int k = 0; k < size; ++k) expected[(i * size + j) * size + k] += weight * y[i] * y[j] * y[k];
    });
    const auto unit = [&](int i) {
      std::vector<double> f(size, 0.0);
      f[i] = 1;
      return f;
    };
    const auto unit_rgb = [&](int i) {
      std::vector<Rgb> f(size, Rgb::Zero());
      f[i] = Rgb::Ones();
      return f;
    };
    double worst = 0;
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) {
        const std::vector<Rgb> product = triple_product(order)(unit_rgb(i), unit(j));
        const std::vector<Rgb> exchanged = triple_product(order)(unit_rgb(j), unit(i));
        for (int k = 0; k < size; ++k) {
          const double got = product[k][0];
          worst = std::max(worst, std::abs(got - expected[(i * size + j) * size + k]));
          CHECK(got == exchanged[k][0]);  // to the bit
          if (i == 0 && std::abs(got - (j == k ? 1 / std::sqrt(4 * pi) : 0)) > 1e-14) FAIL(j << " " << k << " " << got);
        }
      }
    CHECK(worst < 1e-13);
  }
  // The greatest order: every entry of the list against quadrature, entries unique.
  const TripleProduct& large = triple_product(12);
  std::vector<double> sums(large.terms().size(), 0.0);
  over_sphere(18, [&](const Vec3& direction, double weight) {
    const std::vector<double> y = scene::evaluate_sh(12, direction);
    for (std::size_t n = 0; n < sums.size(); ++n) {
      const auto& t = large.terms()[n];
      sums[n] += weight * y[t.i] * y[t.j] * y[t.k];
    }
  });
  double worst = 0;
  std::set<std::array<int, 3>> seen;
  for (std::size_t n = 0; n < sums.size(); ++n) {
    const auto& t = large.terms()[n];
    worst = std::max(worst, std::abs(sums[n] - t.value));
    seen.insert({t.i, t.j, t.k});
  }
  CHECK(worst < 1e-12);
  CHECK(seen.size() == sums.size());
  CHECK_THROWS_AS(triple_product(0), Error);
  CHECK_THROWS_AS(triple_product(13), Error);
}

// <f | g | 1> is the inner product; <f | g | h> integrates the product of three functions of limited bands exactly.
TEST_CASE("the triple product is the integral of the product", "[fogshop]") {
  for (const int order : {4, 6}) {
    const std::vector<Rgb> f = light(order), g(f.rbegin(), f.rend());
    const std::vector<double> h = window(order);
    Rgb expected = Rgb::Zero();
    over_sphere(2 * order, [&](const Vec3& d, double weight) {
      expected += weight * scene::evaluate_sh(f, d) * scene::evaluate_sh(g, d) * value(h, d);
    });
    const std::vector<Rgb> product = triple_product(order)(f, h);
    CHECK(((reflect_harmonics(product, g) - expected).abs() < 1e-12).all());
    std::vector<double> open(order * order, 0.0);
    open[0] = std::sqrt(4 * pi);
    const std::vector<Rgb> same = triple_product(order)(f, open);
    for (std::size_t i = 0; i < f.size(); ++i) CHECK(((same[i] - f[i]).abs() < 1e-12).all());
  }
}

// Eqs. 21 to 24: the convolution with a delta is the function itself; the delta turned and spread is the turned NPSF.
TEST_CASE("convolution with a delta is the identity", "[fogshop]") {
  const int order = 6;
  std::vector<double> delta, g;
  for (int l = 0; l < order; ++l) {
    delta.push_back(std::sqrt((2 * l + 1) / (4 * pi)));
    g.push_back(npsf_coefficient(l, 1));
  }
  const Vec3 axis = Vec3(0.2, -0.6, 0.4).normalized();
  const std::vector<double> turned = turned_zonal(delta, axis), y = scene::evaluate_sh(order, axis);
  const std::vector<double> spread = turned_zonal(g, axis);
  for (int l = 0; l < order; ++l)
    for (int m = -l; m <= l; ++m) {
      const int i = scene::sh_index(l, m);
      // Eq. 21 with g_l = delta_l leaves f alone, with f = delta turned it gives Eq. 23.
      CHECK(std::sqrt(4 * pi / (2 * l + 1)) * delta[l] == Approx(1).epsilon(1e-14));
      CHECK(turned[i] == Approx(y[i]).margin(1e-14));
      CHECK(spread[i] == Approx(std::sqrt(4 * pi / (2 * l + 1)) * turned[i] * g[l]).margin(1e-14));
    }
}

// Eq. 20 in full against quadrature over the sphere: incident light of limited bands, with and without visibility. The
// harmonic form is compared, so the reflectance enters as its projection.
TEST_CASE("reflection of harmonics is the integral over directions", "[fogshop]") {
  const scene::Material lambert = scene::Lambert{Rgb(0.9, 0.5, 0.1)};
  const scene::Material phong = scene::Phong{Rgb::Constant(0.3), Rgb(0.2, 0.4, 0.6), 5};
  for (const int order : {4, 6}) {
    const std::vector<Rgb> incident = light(order);
    const std::vector<double> visibility = window(order);
    for (const scene::Material& material : {lambert, phong}) {
      // Over the hemisphere about the normal, where the integrand is smooth.
      Rgb plain = Rgb::Zero();
      std::vector<Rgb> projected(order * order, Rgb::Zero());
      const scene::GaussLegendre rule = scene::gauss_legendre(60);
      const Vec3 a = normal.unitOrthogonal(), b = normal.cross(a);
      for (int i = 0; i < 60; ++i)
        for (int k = 0; k < 180; ++k) {
          const double c = 0.5 * (1 + rule.node[i]), s = std::sqrt((1 - c) * (1 + c)), phi = 2 * pi * k / 180;
          const Vec3 in = c * normal + s * (std::cos(phi) * a + std::sin(phi) * b);
          const Rgb f = scene::brdf(material, normal, in, to_view) * (c * 0.5 * rule.weight[i] * 2 * pi / 180);
          plain += f * scene::evaluate_sh(incident, in);
          const std::vector<double> y = scene::evaluate_sh(order, in);
          for (std::size_t n = 0; n < y.size(); ++n) projected[n] += f * y[n];
        }
      Rgb shadowed = Rgb::Zero();
      over_sphere(2 * order, [&](const Vec3& d, double weight) {
        shadowed += weight * scene::evaluate_sh(projected, d) * scene::evaluate_sh(incident, d) * value(visibility, d);
      });
      const std::vector<Rgb> reflectance = reflectance_harmonics(material, normal, to_view, order);
      const Rgb got = reflect_harmonics(reflectance, incident);
      const Rgb hidden = reflect_harmonics(triple_product(order)(reflectance, visibility), incident);
      CAPTURE(order, material.index(), got, plain, hidden, shadowed);
      CHECK(((got - plain).abs() < 1e-4).all());
      CHECK(((hidden - shadowed).abs() < 1e-4).all());
    }
  }
}

// Light 1 from everywhere: Lambert returns its albedo.
TEST_CASE("a furnace of harmonics", "[fogshop]") {
  for (int order = 1; order <= 12; ++order) {
    std::vector<Rgb> incident(order * order, Rgb::Zero());
    incident[0] = Rgb::Constant(std::sqrt(4 * pi));
    const scene::Material lambert = scene::Lambert{Rgb(1, 0.5, 0.25)};
    const auto seen_from = [&](const Vec3& to_view) {
      return reflect_harmonics(reflectance_harmonics(lambert, normal, to_view, order), incident);
    };
    CHECK(((seen_from(to_view) - Rgb(1, 0.5, 0.25)).abs() < 1e-13).all());
    CHECK((seen_from(-to_view) == 0).all());
  }
  CHECK_THROWS_AS(reflect_harmonics(light(3), light(2)), Error);
  CHECK_THROWS_AS(triple_product(3)(light(3), std::vector<double>(4, 0.0)), Error);
  CHECK_THROWS_AS(reflectance_harmonics(scene::Lambert{}, normal, to_view, 13), Error);
}

}  // namespace harmonic_reflection_test
