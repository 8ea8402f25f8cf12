// Rules for the method, ray by ray: identities between variants, bounds, reconstruction.
#include <catch2/catch.hpp>

#include "methods/wavelet_fog/leveled_fog.h"
#include "methods/wavelet_fog/options.h"
#include "scene/media/fogmap.h"
#include "tests/methods/wavelet_fog/maps.h"

namespace acceptance_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::wavelet_fog;

namespace {

constexpr Kind kinds[] = {Kind::smooth, Kind::patchy, Kind::hard, Kind::random};

// To 1e-13 of a depth, or of a depth of 1 where it is less.
void require_equal(double got, double expected) {
  REQUIRE(std::abs(got - expected) <= 1e-13 * std::max(1.0, std::abs(expected)));
}

scene::Medium medium_of(int degree, const Coefficients& c, const scene::HeightProfile& profile) {
  auto fog = std::make_shared<scene::Fogmap>();
  fog->map = spline_map(degree, c);
  fog->profile = profile;
  fog->x0 = -3, fog->z0 = 5, fog->cell = 1.25;
  fog->cos_turn = 0.8, fog->sin_turn = 0.6;
  scene::Medium medium;
  medium.field = scene::FogmapPointer(fog);
  return medium;
}

Ray random_ray(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-50, 60), height(-1, 4);
  const Point3 from(place(random), height(random), place(random)), to(place(random), height(random), place(random));
  return {from, (to - from).normalized()};
}

}  // namespace

TEST_CASE("wavelet fog: a segment backwards, in parts and in thicker fog", "[wavelet_fog]") {
  std::mt19937_64 random(3);
  for (int degree = 0; degree <= 3; ++degree)
    for (const scene::HeightProfile& profile : profiles()) {
      const scene::Medium medium = medium_of(degree, map_of(Kind::random, 40, 33, 8), profile);
      double sum = 0;
      for (int i = 0; i < 300; ++i) {
        const Ray ray = random_ray(random);
        const double length = 4.0 + 0.2 * i, cut = (0.1 + 0.003 * i) * length;
        const double depth = density_integral(medium, ray, {0, length});
        CAPTURE(degree, i, depth);
        require_equal(density_integral(medium, {ray.at(length), -ray.direction}, {0, length}), depth);
        require_equal(density_integral(medium, ray, {0, cut}) + density_integral(medium, ray, {cut, length}), depth);
        scene::Medium thicker = medium;
        sum += depth;
        thicker.sigma_t = Rgb(1, 7, 1e-9);
        const Rgb scaled = scene::optical_depth({thicker}, ray, {0, length});
        for (int c = 0; c < 3; ++c) REQUIRE(scaled[c] == Approx(thicker.sigma_t[c] * depth).epsilon(1e-15));
      }
      CHECK(sum > 300);  // the rays meet the fog
    }
}

TEST_CASE("wavelet fog: tele equals paper equals pre, skip equals direct", "[wavelet_fog]") {
  std::mt19937_64 random(4);
  for (int degree = 0; degree <= 2; ++degree)
    for (const Kind kind : kinds) {
      const Coefficients c = map_of(kind, 64, 50, 21);
      for (const scene::HeightProfile& profile : profiles()) {
        const scene::Medium medium = medium_of(degree, c, profile);
        double sum = 0;
        for (const double mu : {1.0, 0.6, 0.0}) {
          Options o;
          o.mu = mu;
          const auto fog_of = [&](Options::Variant variant) {
            o.variant = variant;
            return LeveledFog(medium, o);
          };
          using V = Options::Variant;
          const LeveledFog direct = fog_of(V::direct), skip = fog_of(V::skip), tele = fog_of(V::tele),
                           paper = fog_of(V::paper), pre = fog_of(V::pre);
          for (int i = 0; i < 40; ++i) {
            const Ray ray = random_ray(random);
            const double length = i % 8 == 0 ? infinity : 3.0 * i;
            Visits visits;
            const double exact = direct.column(ray, length, visits);
            CAPTURE(degree, int(kind), profile.index(), mu, i, exact);
            require_equal(skip.column(ray, length, visits), exact);
            if (std::isfinite(exact)) sum += exact;
            const double summed = paper.column(ray, length, visits);
            require_equal(tele.column(ray, length, visits), summed);
            require_equal(pre.column(ray, length, visits), summed);
            if (mu == 1) require_equal(summed, exact);
          }
        }
        CHECK(sum > 50);  // the rays meet the fog
      }
    }
}

TEST_CASE("wavelet fog: cubic maps need no wavelets where nothing is coarse", "[wavelet_fog]") {
  std::mt19937_64 random(9);
  const scene::Medium medium = medium_of(3, map_of(Kind::hard, 40, 40, 4), profiles()[1]);
  Options direct, skip;
  direct.variant = Options::Variant::direct;
  const LeveledFog all(medium, direct), skipped(medium, skip);
  double sum = 0;
  for (int i = 0; i < 200; ++i) {
    const Ray ray = random_ray(random);
    Visits visits;
    const double exact = density_integral(medium, ray, {0, 60});
    require_equal(all.column(ray, 60, visits), exact);
    require_equal(skipped.column(ray, 60, visits), exact);
    sum += exact;
  }
  CHECK(sum > 100);
}

TEST_CASE("wavelet fog: grids without negative values take no light twice", "[wavelet_fog]") {
  std::mt19937_64 random(5);
  using V = Options::Variant;
  for (int degree = 0; degree <= 3; ++degree)
    for (const Coarse coarse : {Coarse::clamped, Coarse::restricted}) {
      if (degree == 3 && coarse == Coarse::clamped) continue;
      for (const Kind kind : kinds)
        for (const V variant : {V::direct, V::skip, V::tele, V::bound}) {
          const scene::Medium medium = medium_of(degree, map_of(kind, 64, 64, 2), profiles()[2]);
          Options o;
          o.variant = variant;
          o.coarse = coarse;
          o.tolerance = 0.3;
          const LeveledFog fog(medium, o);
          for (int i = 0; i < 40; ++i) {
            Visits visits;
            const double column = fog.column(random_ray(random), 70, visits);
            REQUIRE(column >= 0);
            REQUIRE(std::exp(-column) <= 1);
          }
        }
    }
  // With wavelets as they are there is light from nothing: what `clamped` is for.
  const scene::Medium medium = medium_of(1, map_of(Kind::hard, 64, 64, 2), profiles()[0]);
  Options o;
  o.variant = V::tele;
  o.mu = 0;
  const LeveledFog fog(medium, o);
  double least = 0;
  for (int i = 0; i < 400; ++i) {
    Visits visits;
    least = std::min(least, fog.column(random_ray(random), 10, visits));
  }
  CHECK(least < -0.01);
}

TEST_CASE("wavelet fog: nothing jumps where the camera enters the fog", "[wavelet_fog]") {
  using V = Options::Variant;
  for (int degree = 1; degree <= 3; ++degree)
    for (const V variant : {V::direct, V::skip, V::bound}) {
      const scene::Medium medium = medium_of(degree, map_of(Kind::random, 20, 20, 6), profiles()[1]);
      Options o;
      o.variant = variant;
      o.coarse = Coarse::restricted;
      const LeveledFog fog(medium, o);
      const auto& map = *std::get<scene::FogmapPointer>(medium.field);
      // From 10 m outside, by a thousandth of a cell a step, to 3 m inside: no step takes more than the greatest density.
      const Ray in{{-3 + 1.25 * 0.8 * 10 - 8, 0.8, 5 - 6}, Vec3(0.6, 0.02, 0.8).normalized()};
      const double step = 1e-3 * map.cell, greatest = 1;
      const double end = 60;
      Visits visits;
      double before = fog.column(in, end, visits), entered = 0;
      for (double t = step; t < 14; t += step) {
        const double now = fog.column({in.at(t), in.direction}, end - t, visits);
        // bound shares its tolerance out anew at each step.
        const double slack = variant == V::bound ? 2 * o.tolerance : 1e-12;
        REQUIRE(std::abs(now - before) <= step * greatest + slack);
        entered += before - now;
        before = now;
      }
      CHECK(entered > 0.5);
    }
}

namespace {

// The greatest error of a reconstruction, as a share of the greatest coefficient.
double reconstruction_error(int width, int height, const char* name, int levels) {
  Coefficients c = map_of(Kind::random, width, height, 3);
  for (double& value : c.values) value *= 1e3;
  const Coefficients back = reconstruct(decompose(c, family(name), levels), family(name));
  REQUIRE(back.values.size() == c.values.size());
  double error = 0, greatest = 0;
  for (std::size_t i = 0; i < c.values.size(); ++i) {
    error = std::max(error, std::abs(back.values[i] - c.values[i]));
    greatest = std::max(greatest, std::abs(c.values[i]));
  }
  if (std::getenv("AIRLIGHT_TEST_FIGURES"))
    fmt::print("{} {} x {}, {} levels: {:.2e} of the greatest\n", name, width, height, levels, error / greatest);
  return error / greatest;
}

}  // namespace

TEST_CASE("wavelets: reconstruction to 4e-15 of the greatest coefficient, up to 2048 x 2048", "[wavelet_fog]") {
  for (const char* name : {"haar", "cdf22", "cdf33"}) {
    for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {1, 17}, {7, 5}, {64, 64}, {255, 129}, {512, 512}})
      for (int levels = 1; levels <= 6; ++levels) CHECK(reconstruction_error(width, height, name, levels) <= 4e-15);
    CHECK(reconstruction_error(2048, 2048, name, 6) <= 4e-15);
  }
}

TEST_CASE("wavelets: reconstruction at every number of levels and odd sizes", "[.][wavelet_fog_long]") {
  for (const char* name : {"haar", "cdf22", "cdf33"})
    for (const auto& [width, height] : {std::pair(2048, 2048), {2047, 1025}, {1999, 1}})
      for (int levels = 1; levels <= 6; ++levels) CHECK(reconstruction_error(width, height, name, levels) <= 4e-15);
}

namespace {

// The greatest error of `bound`, as a share of its tolerance, over that many rays.
double worst_share(long rays) {
  double worst = 0;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> lengths(1, 120);
  const double tolerances[] = {0.3, 0.1, 0.03, 0.01, 0.003, 0.001};
  const long configurations = 3 * 3 * 3 * std::size(tolerances);
  for (int degree = 0; degree <= 2; ++degree)
    for (const Kind kind : {Kind::smooth, Kind::patchy, Kind::hard})
      for (const scene::HeightProfile& profile : profiles())
        for (const double tolerance : tolerances) {
          scene::Medium medium = medium_of(degree, map_of(kind, 96, 80, 17 + degree), profile);
          medium.sigma_t = {0.1, 0.3, 0.05};
          Options o;
          o.variant = Options::Variant::bound;
          o.tolerance = tolerance;
          o.levels = 4;
          const LeveledFog fog(medium, o);
          for (long i = 0; i < rays / configurations + 1; ++i) {
            const Ray ray = random_ray(random);
            const double length = i % 16 == 0 ? infinity : lengths(random);
            Visits visits;
            const double got = fog.column(ray, length, visits), exact = density_integral(medium, ray, {0, length});
            const double share = 0.3 * std::abs(got - exact) / tolerance;
            REQUIRE(share <= 1);
            worst = std::max(worst, share);
          }
        }
  if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("bound: at most {:.3f} of its tolerance\n", worst);
  return worst;
}

}  // namespace

TEST_CASE("wavelet fog: bound keeps its tolerance, on any map", "[wavelet_fog]") { CHECK(worst_share(20000) > 0.05); }

TEST_CASE("wavelet fog: bound keeps its tolerance on a million rays", "[.][wavelet_fog_long]") {
  CHECK(worst_share(1000000) > 0.05);
}

}  // namespace acceptance_test
