// Tabulated reflectances: what is read is what is evaluated, reciprocal and never more than all of the light.
#include "scene/geometry/brdf_table.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "reference/path_tracer/surface_sampling.h"
#include "scene/base/error.h"
#include "scene/geometry/surface.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/random.h"
#include "scene/scene.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace brdf_table_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

const std::string synthetic = std::string(AIRLIGHT_SOURCE_DIR) + "/experiments/data/synthetic_satin.brdf";

std::vector<Rgb> constant(int thetas, int phis, double value) {
  return std::vector<Rgb>(std::size_t(thetas) * thetas * phis, Rgb::Constant(value));
}

std::string message(int thetas, int phis, const std::vector<Rgb>& values) {
  return test::message_of([&] { BrdfTable(thetas, phis, values); });
}

bool says(const std::string& what, const std::vector<std::string>& parts) {
  INFO(what);
  bool all = what.find('\n') == std::string::npos;
  for (const std::string& part : parts) all = all && what.find(part) != std::string::npos;
  CHECK(all);
  return all;
}

Vec3 at(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

}  // namespace

// f = 1/pi everywhere is a white Lambert surface: albedo 1 at every angle.
TEST_CASE("a constant table is a Lambert surface", "[geometry][surface]") {
  for (const int size : {2, 3, 17}) {
    const BrdfTable table(size, size + 1, constant(size, size + 1, 0.5 / pi));
    const Material tabulated = Tabulated{std::make_shared<const BrdfTable>(table)};
    for (const double angle : {0.0, 0.4, 1.0, 1.5}) {
      CHECK(table.albedo(angle)[0] == Approx(0.5).epsilon(1e-13));
      CHECK(brdf(tabulated, Vec3::UnitY(), at(angle, 0.3), at(0.7, 2))[1] == Approx(0.5 / pi).epsilon(1e-14));
    }
    CHECK((brdf(tabulated, Vec3::UnitY(), at(2, 0), at(0.2, 0)) == 0).all());
    CHECK(message(size, size + 1, constant(size, size + 1, 1 / pi)).empty());
    says(message(size, size + 1, constant(size, size + 1, 1.001 / pi)), {"create energy", "theta_in = 0 degrees"});
  }
}

TEST_CASE("bad reflectances are told by their angles", "[geometry][surface]") {
  const auto entry = [](int i, int j, int k) { return 3 * (3 * i + j) + k; };
  std::vector<Rgb> values = constant(3, 3, 0.1);
  CHECK(message(3, 3, values).empty());
  values[entry(1, 2, 1)][2] = 0.2;
  says(message(3, 3, values), {"not reciprocal", "(90, 45, 90)", "(45, 90, 90)"});
  values[entry(2, 1, 1)][2] = 0.2;
  CHECK(message(3, 3, values).empty());
  values[entry(1, 1, 2)][0] = -0.1;
  says(message(3, 3, values), {"-0.1", "(45, 45, 180)", "finite values >= 0"});
  values[entry(1, 1, 2)][0] = std::nan("");
  says(message(3, 3, values), {"nan", "(45, 45, 180)"});
  values = constant(3, 3, 0.1);
  values[entry(0, 1, 1)] = values[entry(1, 0, 1)] = Rgb::Constant(0.2);
  says(message(3, 3, values), {"along the normal there is no azimuth", "(0, 45, 90)"});
  says(message(1, 3, values), {"1 polar and 3 azimuthal", "2 to 256"});
  says(message(3, 4, values), {"27 values", "expected 36 = 3 x 3 x 4"});
  // Too bright at one angle alone: much light from 45 degrees to 45 degrees.
  values = constant(3, 3, 0.1);
  for (int k = 0; k < 3; ++k) values[entry(1, 1, k)] = Rgb(0.1, 0.9, 0.1);
  says(message(3, 3, values), {"theta_in = 45 degrees", "at most 1", "energy"});
}

TEST_CASE("bad files of reflectances", "[geometry][surface]") {
  const TemporaryFolder folder;
  const auto reading = [&](const std::string& text) -> std::string {
    const std::string path = folder.file("t.brdf");
    std::ofstream(path) << text;
    try {
      read_brdf_table(path);
    } catch (const Error& e) {
      CHECK(e.exit_code() == 2);
      return e.what();
    }
    return "";
  };
  std::string good = "# a comment\n2 2\n";
  for (int i = 0; i < 8; ++i) good += "0.1 0.1 0.1\n";
  CHECK(reading(good).empty());
  says(reading("2\n"), {"t.brdf:1:", "the end of the line", "azimuthal angles"});
  says(reading("2 1\n"), {"'1'", "2 to 256"});
  says(reading("2 2 2\n"), {"'2'", "end of the line"});
  says(reading("2 2\n0.1 0.1 0.1\n"), {"the end of the file", "8 lines of r g b, 1 of them found"});
  says(reading(good + "0.1 0.1 0.1\n"), {"t.brdf:11:", "end of the file after 8 values"});
  says(reading("2 2\n0.1 x 0.1\n"), {"t.brdf:2:", "'x'", "a reflectance"});
  says(reading("2 2\n0.1 0.1\n"), {"t.brdf:2:", "the end of the line"});
  says(reading("2 2\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n"), {"t.brdf:", "energy"});
}

TEST_CASE("a table is linear between its entries", "[geometry][surface]") {
  const BrdfTable table = read_brdf_table(synthetic);
  const double step = 0.5 * pi / (table.thetas() - 1), turn = pi / (table.phis() - 1);
  const auto entry = [&](int i, int j, int k) {
    return table.values()[std::size_t(table.phis()) * (std::size_t(table.thetas()) * i + j) + k];
  };
  CHECK(table.at(4 * step, 7 * step, 5 * turn).isApprox(entry(4, 7, 5), 1e-12));
  CHECK(table.at(4.5 * step, 7 * step, 5 * turn).isApprox(0.5 * (entry(4, 7, 5) + entry(5, 7, 5)), 1e-12));
  CHECK(table.at(4 * step, 7.25 * step, 5 * turn).isApprox(0.75 * entry(4, 7, 5) + 0.25 * entry(4, 8, 5), 1e-12));
  CHECK(table.at(4 * step, 7 * step, 5.5 * turn).isApprox(0.5 * (entry(4, 7, 5) + entry(4, 7, 6)), 1e-12));
  CHECK(table.at(0.5 * pi, 0.5 * pi, pi).isApprox(entry(15, 15, 18), 1e-12));
  // Angles between vectors, about any normal.
  const Mat3 turned = Eigen::AngleAxisd(1.2, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  for (const double phi : {0.0, 0.9, 2.5, pi})
    CHECK(table(turned * Vec3::UnitY(), turned * at(0.6, 0.4), turned * at(1.1, 0.4 - phi))
              .isApprox(table.at(0.6, 1.1, phi), 1e-12));
}

// The closed form of the albedo against quadrature over the cells of the table, at entries and between them;
// reciprocity in random directions; the highest albedo bounds them all.
TEST_CASE("the synthetic reflectance is reciprocal and keeps its energy", "[geometry][surface]") {
  const BrdfTable table = read_brdf_table(synthetic);
  const Material material = Tabulated{std::make_shared<const BrdfTable>(table)};
  const GaussLegendre rule = gauss_legendre(6);
  const double step = 0.5 * pi / (table.thetas() - 1), turn = pi / (table.phis() - 1);
  for (const double theta : {0.0, 0.2, 6 * step, 1.3, 1.5}) {
    Rgb sum = Rgb::Zero();
    for (int j = 0; j + 1 < table.thetas(); ++j)
      for (int k = 0; k + 1 < table.phis(); ++k)
        for (int a = 0; a < 6; ++a)
          for (int b = 0; b < 6; ++b) {
            const double out = step * (j + 0.5 * (1 + rule.node[a])), phi = turn * (k + 0.5 * (1 + rule.node[b]));
            sum += 2 * 0.25 * step * turn * rule.weight[a] * rule.weight[b] * std::sin(out) * std::cos(out) *
                   brdf(material, Vec3::UnitY(), at(theta, 0), at(out, phi));
          }
    CHECK(table.albedo(theta).isApprox(sum, 1e-9));
    CHECK((sum <= table.greatest_albedo() + 1e-12).all());
  }
  CHECK((table.greatest_albedo() < 1).all());
  CHECK((table.greatest_albedo() > 0.3).all());
  for (std::uint32_t i = 0; i < 500; ++i) {
    const RandomBlock block{philox4x32_10({i, 1, 0, 0}, {3, 0})};
    const Vec3 in = at(1.57 * block.coarse(0), 6 * block.coarse(1)), out = at(1.57 * block.coarse(2), block.coarse(3));
    CHECK(brdf(material, Vec3::UnitY(), in, out).isApprox(brdf(material, Vec3::UnitY(), out, in), 1e-12));
  }
}

// In a furnace of radiance 1 the sampled mean of reflectance * cosine / density is the albedo, at most 1.
TEST_CASE("tabulated reflections are sampled as their density says", "[path_tracer]") {
  const auto table = std::make_shared<const BrdfTable>(read_brdf_table(synthetic));
  const Material material = Tabulated{table};
  const Vec3 normal(0, 0.6, 0.8), side(1, 0, 0);
  for (const double theta : {0.1, 0.8, 1.4}) {
    const Vec3 in = std::cos(theta) * normal + std::sin(theta) * side;
    double sum = 0, square = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
      const RandomBlock block{philox4x32_10({std::uint32_t(i), 2, 0, 0}, {5, 0})};
      const Vec3 out =
          path_tracer::sample_reflection(material, normal, in, block.coarse(2), block.fine(0), block.coarse(3));
      const double pdf = path_tracer::pdf_reflection(material, normal, in, out);
      CHECK(pdf == Approx(normal.dot(out) / pi).margin(1e-12));
      const double share = pdf > 0 ? brdf(material, normal, in, out)[0] * normal.dot(out) / pdf : 0;
      sum += share;
      square += share * share;
    }
    const double mean = sum / n, error = std::sqrt((square / n - mean * mean) / n);
    CAPTURE(theta, mean, error, table->albedo(theta)[0]);
    CHECK(std::abs(mean - table->albedo(theta)[0]) < 4.9 * error);  // 1e-6 of false alarms
    CHECK(mean < 1);
  }
}

TEST_CASE("scenes with a tabulated material", "[load]") {
  const std::string begin =
      "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[surface]]\ntype = 'plane'\npoint = [0, 0, 0]\nmaterial "
      "= ";
  const std::string folder = std::string(AIRLIGHT_SOURCE_DIR) + "/experiments/scenes";
  const auto load = [&](const std::string& material) { return parse_scene(begin + material + "\n", "s.toml", folder); };
  const Scene scene = load("{ type = 'tabulated', file = '../data/synthetic_satin.brdf' }");
  const auto& tabulated = std::get<Tabulated>(scene.surfaces[0].material);
  CHECK(tabulated.table->thetas() == 16);
  CHECK(tabulated.table->phis() == 19);
  // The values are in the hash, the file's name is not.
  std::vector<Rgb> values = tabulated.table->values();
  Scene same = scene, other = scene;
  same.surfaces[0].material = Tabulated{std::make_shared<const BrdfTable>(16, 19, values)};
  values[19 * (16 * 3 + 3) + 2][1] *= 1.01;
  other.surfaces[0].material = Tabulated{std::make_shared<const BrdfTable>(16, 19, values)};
  finish(same);
  finish(other);
  CHECK(same.hash == scene.hash);
  CHECK(other.hash != scene.hash);
  const auto what = [&](const std::string& material) -> std::string {
    return test::message_of([&] { load(material); });
  };
  says(what("{ type = 'tabulated' }"), {"s.toml:7:", "file"});
  says(what("{ type = 'tabulated', file = 'none.brdf' }"), {"s.toml:7:", "none.brdf"});
  says(what("{ type = 'tabulated', file = '../data/knot1.off' }"), {"s.toml:7:", "knot1.off:1:", "polar angles"});
  says(what("{ type = 'tabulated', file = '../data/synthetic_satin.brdf', albedo = 1 }"), {"albedo", "unknown key"});
}

}  // namespace brdf_table_test
