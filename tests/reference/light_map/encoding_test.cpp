// Encodings of a texel, against closed forms, numerical integrals and plain implementations.
#include "reference/light_map/encoding.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "reference/light_map/nodes.h"
#include "scene/math/types.h"

namespace encoding_test {

using namespace airlight;
using namespace airlight::light_map;

namespace {

constexpr Encoding all_encodings[] = {Encoding::slices, Encoding::avsm, Encoding::fourier, Encoding::beer};

Options options_for(Encoding encoding, int steps, int number = 0) {
  Options o;
  o.encoding = encoding;
  o.steps = steps;
  if (number > 0) o.slices = o.nodes = o.coefficients = number;
  return o;
}

std::vector<float> texel_of(const Options& o, const std::vector<double>& steps) {
  std::vector<float> texel(floats_per_texel(o));
  Encoder(o).encode(steps, texel.data());
  return texel;
}

// Optical depths of steps of a medium whose depth from 0 to d is given.
std::vector<double> steps_of(const std::function<double(double)>& depth, int count) {
  std::vector<double> steps;
  for (int i = 0; i < count; ++i) steps.push_back(depth((i + 1.0) / count) - depth(double(i) / count));
  return steps;
}

// A homogeneous slab from 1/4 to 5/8, and a Gaussian around 0.45 of width 0.1, both `total` deep.
std::function<double(double)> slab(double total) {
  return [=](double d) { return total * std::clamp((d - 0.25) / 0.375, 0.0, 1.0); };
}
std::function<double(double)> bell(double total) {
  return [=](double d) { return 0.5 * total * (std::erf((d - 0.45) / 0.1) + std::erf(4.5)); };
}

// Root mean square error of the transmittance over the depths between the steps' ends.
double error(const Options& o, const std::function<double(double)>& depth) {
  const std::vector<float> texel = texel_of(o, steps_of(depth, o.steps));
  double sum = 0;
  const int count = 1000;
  for (int i = 0; i < count; ++i) {
    const double d = (i + 0.5) / count;
    sum += std::pow(std::exp(-decode(o, texel.data(), d)) - std::exp(-depth(d)), 2);
  }
  return std::sqrt(sum / count);
}

// Salvi et al. 2010 without anything clever: the area between the curves with and without an inner node, by trapezoids.
std::vector<Node> plain_nodes(const std::vector<Node>& curve, int most) {
  std::vector<Node> nodes;
  const auto area = [](const std::vector<Node>& n) {
    double sum = 0;
    for (std::size_t i = 1; i < n.size(); ++i)
      sum += 0.5 * (n[i].depth - n[i - 1].depth) * (n[i].transmittance + n[i - 1].transmittance);
    return sum;
  };
  for (const Node& node : curve) {
    nodes.push_back(node);
    if (int(nodes.size()) <= most) continue;
    std::size_t best = 0;
    double least = infinity;
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
      std::vector<Node> without = nodes;
      without.erase(without.begin() + std::ptrdiff_t(i));
      const double change = std::abs(area(nodes) - area(without));
      if (change < least) least = change, best = i;
    }
    nodes.erase(nodes.begin() + std::ptrdiff_t(best));
  }
  return nodes;
}

}  // namespace

TEST_CASE("light map: avsm removes the nodes that a plain implementation removes", "[light_map]") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Node> curve = {{0, 1}};
    for (int i = 1; i < 40; ++i)
      curve.push_back({curve.back().depth + 0.01 + uniform(random), curve.back().transmittance * uniform(random)});
    for (const int most : {2, 3, 5, 8}) {
      Nodes nodes(most);
      for (const Node& node : curve) nodes.add(node);
      const std::vector<Node> expected = plain_nodes(curve, most);
      REQUIRE(nodes.count() == int(expected.size()));
      for (int i = 0; i < most; ++i) {
        CHECK(nodes[i].depth == expected[std::size_t(i)].depth);
        CHECK(nodes[i].transmittance == expected[std::size_t(i)].transmittance);
      }
    }
  }
}

// Empty space takes a node at its end, and none behind the last step that is not empty.
TEST_CASE("light map: avsm's nodes of two clouds", "[light_map]") {
  const Options o = options_for(Encoding::avsm, 8, 5);
  const std::vector<float> texel = texel_of(o, {0, 0.5, 0, 0, 1, 0, 0, 0});
  const float depths[] = {0.125f, 0.25f, 0.5f, 0.625f, 0.625f};
  const double transmittances[] = {1, std::exp(-0.5), std::exp(-0.5), std::exp(-1.5), std::exp(-1.5)};
  for (int k = 0; k < 5; ++k) {
    CHECK(texel[k] == depths[k]);
    CHECK(texel[5 + k] == float(transmittances[k]));
  }
}

// a_k = 2 integral of density(d) cos 2 pi k d, b_k with the sine. The steps' midpoint rule against an integral with 50
// times as many: (2 pi k / 128)^2 / 24 of the total at most, which is 10 deep.
TEST_CASE("light map: Fourier coefficients are those integrals", "[light_map]") {
  const Options o = options_for(Encoding::fourier, 128, 15);
  for (const auto& depth : {bell(10), slab(10)}) {
    const std::vector<float> texel = texel_of(o, steps_of(depth, o.steps));
    for (int k = 0; k <= 7; ++k) {
      double a = 0, b = 0;
      const int fine = 6400;
      for (int i = 0; i < fine; ++i) {
        const double tau = depth((i + 1.0) / fine) - depth(double(i) / fine), angle = 2 * pi * k * (i + 0.5) / fine;
        a += 2 * tau * std::cos(angle);
        b += 2 * tau * std::sin(angle);
      }
      const double margin = 20 * std::pow(2 * pi * k / 128, 2) / 24 + 1e-5;
      CHECK(texel[k == 0 ? 0 : 2 * k - 1] == Approx(a).margin(margin));
      if (k > 0) CHECK(texel[2 * k] == Approx(b).margin(margin));
    }
    // The whole series ends at the whole depth, at any number of coefficients.
    CHECK(decode(o, texel.data(), 1) == Approx(10).epsilon(1e-6));
  }
}

// Steps 2 and 4 of six have optical depths 1 and 3: the front is at 2/6, the mean 4 in 2/6, the total 4.
TEST_CASE("light map: beer is front, mean and total", "[light_map]") {
  const Options o = options_for(Encoding::beer, 6);
  const std::vector<float> texel = texel_of(o, {0, 0, 1, 0, 3, 0});
  CHECK(texel[0] == Approx(1.0 / 3));
  CHECK(texel[1] == Approx(12));
  CHECK(texel[2] == 4);
  CHECK(decode(o, texel.data(), 0.3) == 0);
  CHECK(decode(o, texel.data(), 0.5) == Approx(2));
  CHECK(decode(o, texel.data(), 2.0 / 3) == Approx(4));
  CHECK(decode(o, texel.data(), 1) == Approx(4));
  // A step that has 1 % of the deepest one is empty, but its depth counts.
  const std::vector<float> fringe = texel_of(o, {0.03, 0, 1, 0, 3, 0});
  CHECK(fringe[0] == texel[0]);
  CHECK(fringe[1] == Approx(12.09));
  CHECK(fringe[2] == Approx(4.03));
}

// A homogeneous slab between ends of steps is beer's own form and a straight line of optical depth between slices; of
// avsm's transmittance the step ends are nodes where there are enough of them.
TEST_CASE("light map: a homogeneous slab is exact where the encoding can be", "[light_map]") {
  for (const double total : {0.01, 1.0, 30.0}) {
    const auto depth = slab(total);
    for (const Options& o : {options_for(Encoding::slices, 64, 32), options_for(Encoding::slices, 8, 64),
                             options_for(Encoding::beer, 64), options_for(Encoding::avsm, 16, 17)}) {
      const std::vector<float> texel = texel_of(o, steps_of(depth, o.steps));
      for (int i = 0; i <= 64; ++i) {
        const double d = i / 64.0;
        if (o.encoding == Encoding::avsm && i % 4 != 0) continue;
        CAPTURE(encoding_name(o.encoding), total, d);
        CHECK(std::exp(-decode(o, texel.data(), d)) == Approx(std::exp(-depth(d))).margin(1e-6));
      }
    }
  }
}

// Linear interpolation of a smooth curve: order 2 in the number of slices or nodes; measured 1.98 and, of nodes, whose
// choice front to back is not the best one, 2.15 over two octaves. A series converges faster than any power of its number
// in a smooth medium: the bell's coefficients fall as exp(-(pi k / 10)^2), by 200
// times from 7 to 15 floats (measured), by 3000 to 31. Behind the slab's jumps they fall as 1/k, their sum's mean square
// as K^-3/2: 1.44 measured.
TEST_CASE("light map: encodings converge in their own numbers", "[light_map]") {
  const auto ratio = [](Encoding encoding, const std::function<double(double)>& depth, int few, int many) {
    return error(options_for(encoding, 4096, few), depth) / error(options_for(encoding, 4096, many), depth);
  };
  CHECK(std::log2(ratio(Encoding::slices, bell(10), 32, 64)) == Approx(2).margin(0.1));
  CHECK(std::log2(ratio(Encoding::avsm, bell(10), 16, 64)) / 2 == Approx(2.15).margin(0.15));
  CHECK(ratio(Encoding::fourier, bell(10), 7, 15) > 100);
  CHECK(ratio(Encoding::fourier, bell(10), 15, 31) > 1000);
  CHECK(std::log2(ratio(Encoding::fourier, slab(2), 15, 31)) == Approx(1.5).margin(0.1));
}

TEST_CASE("light map: transmittance falls from the front to the back", "[light_map]") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Encoding encoding : {Encoding::slices, Encoding::avsm, Encoding::beer}) {  // a series swings
    const Options o = options_for(encoding, 100);
    for (int trial = 0; trial < 100; ++trial) {
      std::vector<double> steps(100, 0.0);
      for (double& step : steps)
        if (uniform(random) < 0.6) step = 0.3 * uniform(random);
      const std::vector<float> texel = texel_of(o, steps);
      double before = 0;
      for (int i = 0; i <= 1000; ++i) {
        const double depth = decode(o, texel.data(), i / 1000.0);
        CHECK(depth >= before - 1e-12);
        before = depth;
      }
    }
  }
}

// Nothing at all is exactly clear. The thinnest is right to what its encoding's floats resolve: optical depths to 1e-7 of
// themselves, transmittances to 1e-7. The thickest is black.
TEST_CASE("light map: nothing, next to nothing and almost everything", "[light_map]") {
  for (const Encoding encoding : all_encodings) {
    const Options o = options_for(encoding, 64);
    CAPTURE(encoding_name(encoding));
    const std::vector<float> nothing = texel_of(o, std::vector<double>(64, 0.0));
    for (int i = 0; i <= 64; ++i) CHECK(decode(o, nothing.data(), i / 64.0) == 0);
    const std::vector<float> thin = texel_of(o, steps_of(slab(1e-6), 64));
    const std::vector<float> thick = texel_of(o, steps_of(slab(1e3), 64));
    CHECK(decode(o, thin.data(), 1) == Approx(1e-6).margin(encoding == Encoding::avsm ? 1e-7 : 1e-12));
    CHECK(std::exp(-decode(o, thick.data(), 1)) < 1e-36);
    CHECK(std::isfinite(decode(o, thick.data(), 1)));
    CHECK(decode(o, thick.data(), 0) == Approx(0).margin(1e-3));
  }
}

TEST_CASE("light map: what a texel takes", "[light_map]") {
  CHECK(floats_per_texel(options_for(Encoding::slices, 64, 32)) == 33);
  CHECK(floats_per_texel(options_for(Encoding::avsm, 64, 8)) == 16);
  CHECK(floats_per_texel(options_for(Encoding::fourier, 64, 15)) == 15);
  CHECK(floats_per_texel(options_for(Encoding::beer, 64)) == 3);
}

}  // namespace encoding_test
