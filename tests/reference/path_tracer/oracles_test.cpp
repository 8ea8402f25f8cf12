// The Monte Carlo oracles of spec/references.md, section 8, with the budget "what CI runs".
//
// Every comparison of this file is a two-sided test; together they raise a false alarm with probability 1e-3, seeds are
// fixed. Sample counts are such that a bias of 1 % of an image's mean is found (limit + 1.645 standard errors < 1 %),
// which each test also checks.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "reference/path_tracer/sampling.h"
#include "tests/oracle_vectors.h"
#include "tests/reference/path_tracer/scenes.h"

namespace oracles_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;
using airlight::test::vec;
using airlight::test::vector_of;

namespace {

constexpr int comparisons = 400;
const double limit = threshold(1e-3, comparisons);  // 4.7

void compare(const std::string& what, double expected, double expected_error, const Estimate& e) {
  const double error = std::hypot(e.error[0], expected_error);
  CAPTURE(what, expected, e.mean[0], error);
  CHECK(std::abs(e.mean[0] - expected) <= limit * error + 1e-9 * std::abs(expected));
}
void detects_one_percent(double expected, double expected_error, const Estimate& e) {
  const double error = std::hypot(e.error[0], expected_error);
  CAPTURE(expected, error);
  CHECK((limit + 1.645) * error < 0.01 * expected);
}

scene::Region shape_of(const nlohmann::json& j, const std::string& type) {
  if (type == "sphere") return scene::Sphere{{0, 0, 0}, j.value("R", 1.0)};
  if (j.contains("lo")) return Box{vec(j.at("lo")), vec(j.at("hi"))};
  return Box{{0, 0, 0}, {1, 1, 1}};
}

scene::Light light_of(const nlohmann::json& j, const std::string& type) {
  if (type == "directional")
    return scene::DirectionalLight{vec(j.at("to_light")).normalized(), Rgb::Constant(j.at("E").get<double>())};
  if (type == "point") return scene::PointLight{vec(j.at("pos")), Rgb::Constant(j.at("I").get<double>()), 0};
  return white();
}

}  // namespace

// Nine scenes of an independent Monte Carlo; M7 and M8 need hours (their own standard errors are 0.2 and 0.6 %).
TEST_CASE("multiple scattering agrees with the independent Monte Carlo", "[path_tracer][oracle][slow]") {
  // Paths for 1 % of the sum over orders, from the variance per path of each scene.
  const std::map<std::string, std::uint64_t> budget = {{"mc-M1", 4 << 20}, {"mc-M2", 5 << 18}, {"mc-M3", 1 << 19},
                                                       {"mc-M4", 1 << 18}, {"mc-M5", 3 << 18}, {"mc-M6", 3 << 19},
                                                       {"mc-M9", 1 << 18}};
  int index = 0;
  for (const auto& [id, n] : budget) {
    const auto v = vector_of(id);
    const auto &in = v.at("input"), &expected = v.at("expected");
    const World world(
        scene_of({medium(shape_of(in, in.at("shape")), in.at("sigma_t"), in.at("albedo"), phase_of("hg", in.at("g")))},
                 {light_of(in, in.at("light"))}),
        Options{});
    const auto e = radiance(world, ray_of(vec(in.at("o")), vec(in.at("d"))), n, {}, ++index);
    for (int m = 0; m <= 4; ++m) {
      const auto& row = expected.at(fmt::format("o{}", m));
      compare(fmt::format("{} order {}", id, m), row[0], row[1], e.orders[m]);
    }
    compare(fmt::format("{} all", id), expected.at("all")[0], expected.at("all")[1], e.total);
    detects_one_percent(expected.at("all")[0], expected.at("all")[1], e.total);
  }
}

TEST_CASE("single scattering agrees with quadrature", "[path_tracer][oracle]") {
  // The two with large relative variance by nature: a backlit dense sphere, and an optical depth of 1e-4.
  const std::map<std::string, std::uint64_t> more = {{"ss-sphere-directional-murky-backlit", 1 << 18},
                                                     {"ss-sphere-thin", 1 << 18}};
  int index = 100, seen = 0;
  for (const auto& v : airlight::test::vectors_in("references")) {
    const std::string id = v.at("id"), kind = v.at("kind");
    if (kind != "single_scattering_sphere" && kind != "single_scattering_box" &&
        kind != "single_scattering_environment")
      continue;
    ++seen;
    const auto& in = v.at("input");
    const bool environment = kind == "single_scattering_environment";
    const std::string shape = environment ? in.at("kind") : in.at("shape").at("type");
    Options options;
    options.max_order = 1;
    const auto& p = in.at("phase");
    const World world(
        scene_of({medium(shape_of(environment ? in : in.at("shape"), shape), in.at("sigma_t"), in.at("albedo"),
                         phase_of(p.at("name"), p.value("g", 0.0)))},
                 {environment ? scene::Light(white()) : light_of(in.at("light"), in.at("light").at("type"))}),
        options);
    const auto n = more.count(id) ? more.at(id) : std::uint64_t(1) << 16;
    const auto e = radiance(world, ray_of(vec(in.at("o")), vec(in.at("d"))), n, {}, ++index);
    compare(id, v.at("expected").at("L1"), 0, e.orders[1]);
  }
  CHECK(seen == 19);
}

TEST_CASE("orders in a sphere agree with the Peierls equation", "[path_tracer][oracle]") {
  int index = 200;
  for (const char* const id : {"sphere-env-0.5-0.9", "sphere-env-2-0.9", "sphere-env-2-0.5", "sphere-env-5-0.99",
                               "sphere-env-1-0.8", "sphere-env-10-0.999", "sphere-env-0.1-0.95"}) {
    const auto v = vector_of(id);
    const auto& expected = v.at("expected");
    const World world(
        scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, v.at("input").at("optical_radius"), v.at("input").at("albedo"))},
                 {white()}),
        Options{});
    for (const auto& [b, L] : expected.at("L").items()) {
      const auto e = radiance(world, ray_of({std::stod(b), 0, -3}, {0, 0, 1}), 1 << 16, {}, ++index);
      compare(fmt::format("{} b {}", id, b), L, 0, e.total);
      if (b == "0.5")
        for (int m = 1; m <= 3; ++m)
          compare(fmt::format("{} order {}", id, m), expected.at("orders_b0.5")[m - 1], 0, e.orders[m]);
    }
    // The mean radiance at the centre, which is also the escape probability of an emitter there.
    const auto centre = mean_radiance(
        world,
        [](const RandomBlock& u) {
          return Ray{{0, 0, 0}, turned(Vec3(0, 0, 1), 2 * u.fine(0) - 1, u.fine(1))};
        },
        1 << 16, {}, ++index);
    compare(fmt::format("{} centre", id), expected.at("J_centre"), 0, centre.total);
  }
}

TEST_CASE("a point light in the middle of a sphere agrees with the Peierls equation", "[path_tracer][oracle]") {
  int index = 300;
  for (const char* const id :
       {"sphere-point-2-0.9", "sphere-point-1-1", "sphere-point-4-0.95", "sphere-point-0.5-0.8"}) {
    const auto v = vector_of(id);
    const double R = v.at("input").at("optical_radius");
    const World world(
        scene_of({medium(scene::Sphere{{0, 0, 0}, R}, 1, v.at("input").at("albedo"))}, {scene::PointLight{}}),
        Options{});
    for (const auto& [b, L] : v.at("expected").at("L1_L2_Lall").items()) {
      const auto e = radiance(world, ray_of({std::stod(b) * R, 0, -3 * R}, {0, 0, 1}), 1 << 16, {}, ++index);
      compare(fmt::format("{} order 1, b {}", id, b), L[0], 0, e.orders[1]);
      compare(fmt::format("{} order 2, b {}", id, b), L[1], 0, e.orders[2]);
      compare(fmt::format("{} all, b {}", id, b), L[2], 0, e.total);
    }
  }
}

namespace {

scene::Medium slab(double tau, double albedo, const scene::PhaseFunction& phase) {
  return medium(scene::Slab{{0, 1, 0}, 0, 1}, tau, albedo, phase);
}

Vec3 down(double mu) { return {std::sqrt(1 - mu * mu), -mu, 0}; }

}  // namespace

TEST_CASE("slab orders and exit radiance", "[path_tracer][oracle]") {
  int index = 600;
  for (const char* const id : {"slab-orders-1-0.9", "slab-orders-5-1"}) {
    const auto v = vector_of(id);
    Options options;
    options.orders = 6;
    const World world(scene_of({slab(v.at("input").at("tau"), v.at("input").at("albedo"), scene::Isotropic{})},
                               {scene::DirectionalLight{Vec3::UnitY(), Rgb::Ones()}}),
                      options);
    for (const bool reflected : {true, false}) {
      // Flux that leaves on one side over the incident flux 1: pi times the mean over cosine-weighted directions.
      const auto e = mean_radiance(
          world,
          [&](const RandomBlock& u) {
            const Vec3 axis(0, reflected ? -1 : 1, 0);
            return Ray{{0, reflected ? 2.0 : -1.0, 0}, turned(axis, std::sqrt(u.fine(0)), u.fine(1))};
          },
          1 << 17, {}, ++index);
      const auto& orders = v.at("expected").at(reflected ? "R_order" : "T_order");
      for (int m = 1; m <= 6; ++m) {
        Estimate flux = e.orders[m];
        flux.mean *= pi;
        flux.error *= pi;
        compare(fmt::format("{} {} {}", id, reflected ? "R" : "T", m), orders[m - 1], 0, flux);
      }
    }
  }
  for (const char* const id :
       {"slab-exit-iso-0-0.9-1", "slab-exit-hg-0.75-0.9-1", "slab-exit-ray-0-1-1", "slab-exit-hg--0.5-0.99-5"}) {
    const auto v = vector_of(id);
    const auto& in = v.at("input");
    const World world(scene_of({slab(in.at("tau"), in.at("albedo"), phase_of(in.at("phase"), in.at("g")))},
                               {scene::DirectionalLight{Vec3::UnitY(), Rgb::Ones()}}),
                      Options{});
    for (const char* const side : {"L_reflected", "L_transmitted"})
      for (const auto& [mu, L] : v.at("expected").at(side).items()) {
        const bool reflected = side[2] == 'r';
        Vec3 d = down(std::stod(mu));
        if (!reflected) d[1] = -d[1];
        const auto e = radiance(world, {{0, reflected ? 2.0 : -1.0, 0}, d}, 1 << 15, {}, ++index);
        compare(fmt::format("{} {} {}", id, side, mu), L, 0, e.total);
      }
  }
}

}  // namespace oracles_test
