#include "methods/fogshop/ray_airlight.h"

#include <catch2/catch.hpp>

#include "methods/fogshop/paper_airlight.h"
#include "tests/methods/fogshop/ray_model.h"
#include "tests/methods/fogshop/vectors.h"

namespace ray_airlight_test {

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::exact;
using fogshop_test::grey_fog;
using fogshop_test::number;
using fogshop_test::ray_airlight;
using fogshop_test::relative_error;
using fogshop_test::vec;

// The vector path of the paper variant against its oracle vectors: the error function is good to 1.2e-12 of each depth.
TEST_CASE("paper variant on vectors", "[fogshop]") {
  for (const auto& v : fogshop_test::vectors_of("airlight_paper")) {
    INFO(v["id"]);
    const auto& in = v["in"];
    const Line line{vec(in["view"]), vec(in["dir"]).normalized(), number(in["d_r"])};
    const Rgb got = ray_airlight(exact(Options::Variant::paper, 0), grey_fog(fogshop_test::fog_of(in)),
                                 vec(in["light"]), Rgb(1, 2, 3), line);
    for (int c = 0; c < 3; ++c) CHECK(relative_error(got[c], (c + 1) * number(v["value"])) <= 1e-10);
  }
}

// Slices against the exact integrals: the error falls as K^-2. The factor of 16 between K = 64 and 256 is asked for as
// 10 or more, or an error below 1e-9.
TEST_CASE("slices converge to the exact airlight", "[fogshop]") {
  for (const auto& v : fogshop_test::vectors_of("airlight_scene")) {
    INFO(v["id"]);
    const auto& in = v["in"];
    const Line line{vec(in["view"]), vec(in["dir"]).normalized(), number(in["d_r"])};
    const auto error = [&](int slices, bool boxes) {
      Options o = exact(Options::Variant::slices, slices);
      o.boxes = boxes;
      const Rgb got = ray_airlight(o, grey_fog(fogshop_test::fog_of(in)), vec(in["light"]), Rgb::Ones(), line);
      return relative_error(got[0], number(v["value"]));
    };
    for (bool boxes : {false, true}) {
      const double coarse = error(64, boxes), fine = error(256, boxes), finest = error(1024, boxes);
      CHECK(coarse <= 4e-3);
      CHECK(fine <= 2.6e-4);
      CHECK(finest <= std::max(1e-8, fine / 10));
    }
  }
}

// Extrapolated, as K^-4: the factor of 256 between K = 64 and 256 is asked for as 50 or more, down to 1e-9.
TEST_CASE("extrapolated slices converge faster", "[fogshop]") {
  for (const auto& v : fogshop_test::vectors_of("airlight_scene")) {
    INFO(v["id"]);
    const auto& in = v["in"];
    const Line line{vec(in["view"]), vec(in["dir"]).normalized(), number(in["d_r"])};
    const auto error = [&](int slices) {
      Options o = exact(Options::Variant::slices, slices);
      o.extrapolate = true;
      const Rgb got = ray_airlight(o, grey_fog(fogshop_test::fog_of(in)), vec(in["light"]), Rgb::Ones(), line);
      return relative_error(got[0], number(v["value"]));
    };
    const double coarse = error(64), fine = error(256);
    CHECK(coarse <= 1e-4);
    CHECK(fine <= std::max(1e-9, coarse / 50));
  }
}

// Splitting a Gaussian into k equal ones changes no depth, so slices stay; the paper's self terms change.
TEST_CASE("slices do not see how a medium is split", "[fogshop]") {
  const scene::Gaussian g{Point3(0.2, 0.1, 4), 1.25, 0.9};
  scene::Gaussian third = g;
  third.amplitude /= 3;
  const Fog one = grey_fog({{g}, 0, infinity}), three = grey_fog({{third, third, third}, 0, infinity});
  const Line line{Point3(0, 0, 0), Vec3(0, 0, 1), 8};
  const Point3 light(2, 1, 3);
  const Options s = exact(Options::Variant::slices, 26);
  CHECK(relative_error(ray_airlight(s, three, light, Rgb::Ones(), line)[0],
                       ray_airlight(s, one, light, Rgb::Ones(), line)[0]) <= 1e-10);
}

// Three channels of one extinction_ratio: each equals a grey medium with its own extinction.
TEST_CASE("coloured extinction equals three grey media", "[fogshop]") {
  Fog fog = grey_fog({{{Point3(0.3, 0.2, 4), 1.1, 0.8}, {Point3(-0.5, 0, 5), 0.7, 1.2}}, 0.05, infinity});
  fog.extinction_ratio = Rgb(0.5, 1, 0.2);
  fog.albedo = Rgb(0.9, 0.8, 0.5);
  const Line line{Point3(0, 0, 0), Vec3(0, 0, 1), 9};
  const Point3 light(1, 2, 3);
  for (auto variant : {Options::Variant::paper, Options::Variant::slices}) {
    const Options options = exact(variant, 12);
    const Rgb coloured = ray_airlight(options, fog, light, Rgb::Ones(), line);
    for (int c = 0; c < 3; ++c) {
      Fog grey = grey_fog(fog.sum);
      grey.sum.constant *= fog.extinction_ratio[c];
      for (auto& g : grey.sum.gaussians) g.amplitude *= fog.extinction_ratio[c];
      const Rgb alone = ray_airlight(options, grey, light, Rgb::Ones(), line);
      // Without boxes the edges do not depend on the strength of the medium; the reach of the culled spheres does, by
      // parts in 1e3 of where the edges lie, which with 12 slices is worth 1e-4.
      CHECK(relative_error(coloured[c], fog.albedo[c] * alone[0]) <=
            (variant == Options::Variant::paper ? 1e-9 : 1e-4));
    }
  }
}

// An infinite ray in a constant medium with one faint Gaussian: slices, then the closed form.
TEST_CASE("slices on an infinite ray", "[fogshop]") {
  const Line endless{Point3(0, 0, 0), Vec3(0, 0, 1), infinity};
  for (double constant : {1e-8, 1e-3, 0.3, 20.0})
    for (const Point3& light : {Point3(3, 0, 4), Point3(0.5, 0, -6), Point3(0, 0.001, 2)}) {
      const Fog fog = grey_fog({{{Point3(0, 0, 5), 0.5, 1e-13 * constant}}, constant, infinity});
      Options o = exact(Options::Variant::slices, 512);
      o.depth_threshold = 1e-300;
      const double expected =
          homogeneous_airlight(LightFromRay{light.z(), std::hypot(light.x(), light.y())}, infinity, constant);
      INFO(constant << " " << light.transpose());
      CHECK(relative_error(ray_airlight(o, fog, light, Rgb::Ones(), endless)[0], expected) <= 1e-4);
    }
}

// Exact depths from the light against the map: refining the map by 2 in all directions divides its error by 4.
TEST_CASE("the light map converges", "[fogshop]") {
  std::vector<scene::Gaussian> gaussians;
  for (int i = 0; i < 40; ++i)
    gaussians.push_back({Point3(3 * std::sin(1.3 * i), 2 * std::sin(2.1 * i), 5 + 3 * std::cos(1.7 * i)), 0.8, 0.5});
  const GaussianArrays arrays = make_arrays(gaussians, Cull::depth, 1e-14).arrays;
  for (const Point3& light : {Point3(0.5, 0.2, 5), Point3(20, 3, 5)}) {
    const auto rms = [&](int factor) {
      const LightMap map(arrays, light, 32 * factor, 32 * factor, Erf::precise, {});
      double sum = 0;
      int n = 0;
      for (double x = -4; x <= 4; x += 0.83)
        for (double y = -3; y <= 3; y += 0.71)
          for (double z = 0; z <= 10; z += 0.97) {
            const Point3 p(x, y, z);
            const double error = map.depth(p) - optical_depth(scene::GaussianSum{gaussians, 0, infinity}, light, p);
            sum += error * error;
            ++n;
          }
      return std::sqrt(sum / n);
    };
    const double coarse = rms(1), fine = rms(4);
    // A texel of 4/32 rad is 0.5 m wide at 4 m; linear interpolation of depths that bend by 2 peak / width^2 = 3 per
    // square metre errs by 0.5^2 / 8 of that.
    CHECK(coarse <= 0.1);
    CHECK(fine <= coarse / 12);  // 16 for smooth depths
  }
}

}  // namespace ray_airlight_test
