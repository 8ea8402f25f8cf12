// Source radiance of single scattering against the oracle's, by directions and by harmonics.
#include "methods/compensated_ray_marching/source_radiance.h"

#include <catch2/catch.hpp>

#include "scene/math/spherical_harmonics.h"
#include "tests/oracle_vectors.h"

namespace source_radiance_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::compensated_ray_marching;

namespace {

struct Case {
  scene::GaussianSum smoke;
  double sigma_t, albedo = 1;
  std::vector<double> phase;
  SourceLight light;
  Point3 x;

  explicit Case(const json& in)
      : sigma_t(number(in.at("sigma_t"))),
        albedo(in.contains("albedo") ? number(in.at("albedo")) : 1),
        x(vec(in.at("point"))) {
    for (const json& b : in.at("rbf_x_y_z_r_w")) smoke.gaussians.push_back({vec(b), number(b[3]), number(b[4])});
    smoke.cutoff = in.at("cut").is_null() ? infinity : number(in.at("cut"));
    const double g = in.contains("g") ? number(in.at("g")) : 0;
    phase = {1, g, g * g, g * g * g};
    for (const json& c : in.at("environment_sh_lookup")) light.harmonics.push_back(Rgb::Constant(number(c)));
    light.radiance = [sh = light.harmonics](const Vec3& w) { return scene::evaluate_sh(sh, w); };
  }
  SourceRadiance source(Transmittance kind, int levels = 8) const {
    return {smoke,
            Rgb::Constant(sigma_t),
            Rgb::Constant(albedo),
            phase,
            light,
            kind,
            ordinate_directions(levels, 2 * levels, false)};
  }
};

// RMS over the sphere of what two functions differ by.
double distance(const std::vector<Rgb>& got, const json& expected) {
  double sum = 0;
  for (std::size_t i = 0; i < got.size(); ++i) sum += std::pow(got[i][0] - number(expected[i]), 2);
  return std::sqrt(sum / (4 * pi));
}

std::vector<json> of_kind(const std::string& kind) { return vectors_of("compensated_ray_marching", kind); }

}  // namespace

TEST_CASE("source radiance by directions converges to the exact one", "[compensated_ray_marching]") {
  for (const json& v : of_kind("single_scattering_source")) {
    const Case c(v.at("input"));
    const json& expected = v.at("expected").at("exact_projection");
    const double coarse = distance(c.source(Transmittance::directional, 8).at(c.x), expected),
                 fine = distance(c.source(Transmittance::directional, 96).at(c.x), expected);
    CAPTURE(v.at("id").get<std::string>(), coarse, fine);
    CHECK(coarse < 0.02);
    CHECK(fine < 1e-4);
  }
  for (const json& v : of_kind("transmittance_environment")) {
    const Case c(v.at("input"));
    const json& expected = v.at("expected");
    const std::vector<Rgb> left = c.source(Transmittance::directional, 96).attenuated_light(c.x);
    CAPTURE(v.at("id").get<std::string>());
    CHECK(distance(left, expected.at("attenuated_light_projection")) < 1e-4);
    CHECK(left[0][0] / std::sqrt(4 * pi) == Approx(number(expected.at("mean_attenuated_radiance"))).epsilon(1e-4));
    // The integral of L tau w: harmonics 3, 1, 2 are -x, -y, z times sqrt(3/(4 pi)).
    const double scale = std::sqrt(4 * pi / 3);
    const Vec3 irradiance(-scale * left[3][0], -scale * left[1][0], scale * left[2][0]);
    CHECK((irradiance - vec(expected.at("vector_irradiance"))).norm() < 1e-3 * irradiance.norm());
    const json& ways = v.at("input").at("lookup_directions");
    for (std::size_t i = 0; i < ways.size(); ++i)
      CHECK(c.sigma_t * density_integral(c.smoke, {c.x, vec(ways[i]).normalized()}, {0, infinity}) ==
            Approx(number(expected.at("optical_depth")[i])).epsilon(1e-9).margin(1e-9));
  }
}

TEST_CASE("source radiance in harmonics: the depths are exact, the exponential as good as it is known to be",
          "[compensated_ray_marching]") {
  for (const json& v : of_kind("single_scattering_source")) {
    const Case c(v.at("input"));
    const json& expected = v.at("expected");
    const SourceRadiance series = c.source(Transmittance::series);
    Harmonics depth = series.minus_depth(c.x);
    CAPTURE(v.at("id").get<std::string>());
    for (std::size_t i = 0; i < depth.size(); ++i)  // by a table of 256
      CHECK(std::abs(c.sigma_t * depth[i] - number(expected.at("minus_depth_vector")[i])) <
            2e-3 * std::abs(number(expected.at("minus_depth_vector")[0])));
    const double ours = distance(series.at(c.x), expected.at("band_limited")),
                 squared = distance(c.source(Transmittance::paper_squared).at(c.x), expected.at("band_limited")),
                 linear = distance(c.source(Transmittance::paper_linear).at(c.x), expected.at("band_limited"));
    CAPTURE(ours, squared, linear);
    CHECK(ours < 0.02);
    CHECK(squared < 0.03);
    CHECK(linear < 0.12);
    // Light from behind: without a phase function a wrong sign of (-1)^l would pass.
    const std::vector<Rgb> turned = c.source(Transmittance::directional, 32).at(c.x);
    if (c.phase[1] != 0) {
      std::vector<Rgb> wrong = turned;
      for (const int i : {1, 2, 3, 9, 10, 11, 12, 13, 14, 15}) wrong[std::size_t(i)] = -wrong[std::size_t(i)];
      CHECK(distance(wrong, expected.at("exact_projection")) > 5 * distance(turned, expected.at("exact_projection")));
    }
  }
}

TEST_CASE("source radiance: coloured smoke is each colour by itself; at a centre it is finite",
          "[compensated_ray_marching]") {
  const Case c(of_kind("single_scattering_source").at(0).at("input"));
  for (const Transmittance kind :
       {Transmittance::paper_linear, Transmittance::paper_squared, Transmittance::series, Transmittance::directional}) {
    const Rgb extinction(1, 4, 9);
    const std::vector<Rgb> all =
        SourceRadiance(c.smoke, extinction, Rgb::Constant(0.9), c.phase, c.light, kind).at(c.x);
    for (int channel = 0; channel < 3; ++channel) {
      const std::vector<Rgb> one =
          SourceRadiance(c.smoke, Rgb::Constant(extinction[channel]), Rgb::Constant(0.9), c.phase, c.light, kind)
              .at(c.x);
      for (std::size_t i = 0; i < all.size(); ++i)
        CHECK(all[i][channel] == Approx(one[i][channel]).epsilon(1e-12).margin(1e-14));
    }
    for (const Rgb& value :
         SourceRadiance(c.smoke, extinction, Rgb::Ones(), c.phase, c.light, kind).at(c.smoke.gaussians[0].center))
      CHECK(value.isFinite().all());
  }
}

}  // namespace source_radiance_test
