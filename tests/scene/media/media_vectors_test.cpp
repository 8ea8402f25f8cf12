// Media against the numbers of tests/vectors, which were computed without this program.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/media/gaussian_sum.h"
#include "scene/media/medium.h"
#include "scene/media/voxel_grid.h"

using namespace airlight;
using namespace airlight::scene;
using nlohmann::json;

namespace {

json vectors(const std::string& file) {
  std::ifstream stream(std::string(AIRLIGHT_SOURCE_DIR) + "/tests/vectors/" + file);
  REQUIRE(stream);
  return json::parse(stream).at("vectors");
}

Vec3 vec(const json& a) { return {a.at(0).get<double>(), a.at(1).get<double>(), a.at(2).get<double>()}; }

double number(const json& v) {
  if (!v.is_string()) return v.get<double>();
  const std::string text = v.get<std::string>();
  return text == "inf" ? infinity : std::stod(text);
}

// Relative 1e-12 or absolute 1e-300: the stated tolerance of the file.
void check_fogshop(double got, double expected) {
  CHECK(std::abs(got - expected) <= std::max(1e-12 * std::abs(expected), 1e-300));
}

struct Segment {
  Ray ray;
  double length;
};
Segment between(const Point3& p, const Point3& q) {
  const double length = (q - p).norm();
  return {{p, length > 0 ? Vec3((q - p) / length) : Vec3(Vec3::UnitZ())}, length};
}

}  // namespace

TEST_CASE("line integrals of one Gaussian: fogshop vectors", "[media]") {
  int count = 0;
  for (const json& v : vectors("fogshop.json")) {
    if (v.at("kind") != "line_integral") continue;
    const json& in = v.at("in");
    const Gaussian g{vec(in.at("b")), 1 / number(in.at("a")), number(in.at("c"))};
    const Ray ray{vec(in.at("o")), vec(in.at("dir")).normalized()};
    INFO(v.dump());
    check_fogshop(line_integral(g, ray, number(in.at("d"))), number(v.at("value")));
    check_fogshop(density_integral(GaussianSum{{g}}, ray, {0, number(in.at("d"))}), number(v.at("value")));
    ++count;
  }
  CHECK(count == 15);
}

TEST_CASE("optical depths of sums of Gaussians: fogshop vectors", "[media]") {
  int count = 0;
  for (const json& v : vectors("fogshop.json")) {
    if (v.at("kind") != "depth") continue;
    const json& in = v.at("in");
    GaussianSum sum;
    sum.constant = number(in.at("beta0"));
    for (const json& g : in.at("gaussians"))
      sum.gaussians.push_back({vec(g.at("b")), 1 / number(g.at("a")), number(g.at("c"))});
    const Segment segment = between(vec(in.at("p")), vec(in.at("q")));
    INFO(v.dump());
    check_fogshop(density_integral(sum, segment.ray, {0, segment.length}), number(v.at("value")));
    ++count;
  }
  CHECK(count == 3);
}

TEST_CASE("optical depths of trilinear grids: reference vectors", "[media]") {
  int count = 0;
  for (const json& v : vectors("references.json")) {
    if (v.at("kind") != "optical_depth" || v.at("id").get<std::string>().rfind("od-trilinear", 0) != 0) continue;
    const json& in = v.at("input");
    const int n = in.at("n"), seed = in.at("seed");
    VoxelGrid grid;
    grid.size.setConstant(n);
    // The vector's samples are tenths, which a float holds to 3e-8 only. Ten times the samples are integers: exact, and
    // so is the tenth of the answer.
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) grid.values.push_back((7 * i + 13 * j + 31 * k + seed) % 11);
    const Segment segment = between(vec(in.at("p")), vec(in.at("q")));
    INFO(v.at("id"));
    const double got = density_integral(grid, segment.ray, {0, segment.length}) / 10;
    CHECK(std::abs(got - v.at("expected").at("tau").get<double>()) <= 1e-12);
    ++count;
  }
  CHECK(count == 3);
}

TEST_CASE("bounds of a sum of Gaussians: reference vector", "[media]") {
  int count = 0;
  for (const json& v : vectors("references.json")) {
    if (v.at("id") != "bound-gauss") continue;
    GaussianSum sum;
    sum.constant = v.at("input").at("b0");
    // Amplitude, 1/width, centre.
    for (const json& g : v.at("input").at("gaussians"))
      sum.gaussians.push_back({vec(g.at(2)), 1 / g.at(1).get<double>(), g.at(0).get<double>()});
    const Interval bounds = density_bounds(sum, {vec(v.at("input").at("lo")), vec(v.at("input").at("hi"))});
    CHECK(std::abs(bounds.lo - v.at("expected").at("lower").get<double>()) <= 1e-11);
    CHECK(std::abs(bounds.hi - v.at("expected").at("upper").get<double>()) <= 1e-11);
    ++count;
  }
  CHECK(count == 1);
}

// The line-integral entries of the stress table, 13 digits: half a unit of the last is 5e-13 relative at worst.
TEST_CASE("line integrals of one Gaussian: stress table", "[media]") {
  struct Case {
    double a, c;
    Point3 b;
    double d, value;
  };
  const Case cases[] = {
      {1, 1e6, {0, 0, 3}, 6, 1.772414696519e6},
      {1e-6, 1e6, {0, 0, 3}, infinity, 8.862299254528e11},
      {1e6, 1e6, {1e-6, 0, 3}, 6, 0.6520493321733},
      {1e6, 1, {1e-4, 0, 3}, 6, 0},
      {1e-6, 1, {0, 0, 1e6}, 1e6, 7.468241328124e5},
      {1, 1, {0, 0, -1}, infinity, 0.1394027926403},
      {1, 1, {0, 0, -26}, infinity, 5.018873596748e-296},
      {1, 1e-8, {0, 0, 3}, 6, 1.772414696519e-8},
      {1, 1, {0, 0, 3}, 1e-15, 1.234098040867e-19},
      {1, 1, {0, 0, 8}, 7.9999999, 0.8862268254528},
      {1, 0, {0, 0, 3}, 6, 0},
      {1, 1, {0, 0, 3}, 0, 0},
  };
  for (const Case& c : cases) {
    INFO(c.a << " " << c.c << " " << c.b.transpose() << " " << c.d);
    const double got = line_integral({c.b, 1 / c.a, c.c}, {Point3::Zero(), Vec3::UnitZ()}, c.d);
    CHECK(std::abs(got - c.value) <= std::max(6e-13 * c.value, 1e-300));
  }
}
