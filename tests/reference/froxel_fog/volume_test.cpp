// The parts of froxel fog one by one: slices, cells, frames, filters, integration, look-ups.
#include "reference/froxel_fog/volume.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "reference/froxel_fog/frames.h"
#include "scene/base/error.h"
#include "scene/base/limits.h"
#include "tests/reference/froxel_fog/fog_scenes.h"

namespace volume_test {

using namespace airlight;
using namespace airlight::froxel_fog;

namespace {

Slices equal_slices(int count) { return {count, {2, 4}, Distribution::equal, 1}; }

// A volume whose froxels are f(x, y, k).
template <class F>
Volume filled(const Cells& cells, int slices, const F& f) {
  Volume volume(cells, equal_slices(slices));
  for (int y = 0; y < cells.rows; ++y)
    for (int x = 0; x < cells.columns; ++x)
      for (int k = 0; k < slices; ++k) volume.column(x, y)[k] = f(x, y, k);
  return volume;
}

Froxel grey(double light, double media) {
  return {Eigen::Array3f::Constant(float(light)), Eigen::Array3f::Constant(float(media))};
}

scene::View parallel_view(int width, int height) { return {parallel_camera(), width, height}; }

}  // namespace

TEST_CASE("froxel fog: slices encode what they decode, as the engines' formulas say", "[froxel_fog]") {
  const Slices log(64, {0.1, 64}, Distribution::log, 0.5), power(64, {0, 64}, Distribution::power, 2),
      exponential(64, {0.1, 64}, Distribution::exponential, 1), equal(64, {1, 9}, Distribution::equal, 1),
      flat(8, {3, 1e9}, Distribution::log, 1e-6), steep(8, {1e-3, 5}, Distribution::power, 0.1);
  for (const Slices& slices : {log, power, exponential, equal, flat, steep}) {
    const auto [n, f] = slices.range();
    CHECK(slices.decode(0) == n);
    CHECK(slices.decode(1) == Approx(f).epsilon(1e-14));
    // Relative to the range, where a steep end is not worth more digits than its depths have.
    for (int i = 0; i <= 1000; ++i) {
      const double z = slices.decode(i / 1000.0);
      CHECK(std::abs(slices.decode(slices.encode(z)) - z) <= 1e-12 * (f - n));
      if (i > 0) CHECK(z >= slices.decode((i - 1) / 1000.0));
    }
    CHECK(slices.encode(0) == 0);
    CHECK(slices.encode(infinity) == 1);
  }
  // (2^(0.5 log2(0.5 * 63.9 + 1)) - 1) / 0.5 + 0.1; 64 * 0.25^2; 0.1 * 640^0.5; 1 + 8 * 0.75.
  CHECK(log.decode(0.5) == Approx(0.1 + 2 * (std::sqrt(32.95) - 1)).epsilon(1e-14));
  CHECK(log.encode(10.1) == Approx(std::log2(6.0) / std::log2(32.95)).epsilon(1e-14));
  CHECK(power.decode(0.25) == Approx(4).epsilon(1e-14));
  CHECK(power.encode(36) == Approx(0.75).epsilon(1e-14));
  CHECK(exponential.decode(0.5) == Approx(2.529822128134704).epsilon(1e-14));
  CHECK(equal.decode(0.75) == 7);
}

TEST_CASE("froxel fog: cells cover the film, by their side or as Godot divides it", "[froxel_fog]") {
  Options o;
  const Cells by_side = cells_of(o, 810, 1080);
  CHECK((by_side.columns == 102 && by_side.rows == 135 && by_side.width == 8 && by_side.height == 8));
  o.volume_size = 64;  // ratio 810 / 945
  const Cells godot = cells_of(o, 810, 1080);
  CHECK((godot.columns == 54 && godot.rows == 74));
  CHECK(godot.width == 15);
  CHECK(godot.height == Approx(1080 / 74.0));
  CHECK(count_froxels(o, 810, 1080) == 54.0 * 74 * 64);
}

TEST_CASE("froxel fog: jitters stay in their froxel and have its middle as their mean", "[froxel_fog]") {
  CHECK(jitter(Jitter::none, 5) == Vec3(0.5, 0.5, 0.5));
  CHECK(jitter(Jitter::halton, 0).isApprox(Vec3(1.0 / 2, 1.0 / 3, 1.0 / 5)));
  CHECK(jitter(Jitter::halton, 4).isApprox(Vec3(5.0 / 8, 7.0 / 9, 1.0 / 25)));
  CHECK(jitter(Jitter::hdrp, 1)[2] == 3.0 / 14);
  CHECK(jitter(Jitter::hdrp, 8) == jitter(Jitter::hdrp, 1));
  Vec3 halton = Vec3::Zero(), hdrp = Vec3::Zero();
  for (int i = 0; i < 900; ++i) {
    CHECK((jitter(Jitter::halton, i).array() >= 0 && jitter(Jitter::halton, i).array() < 1).all());
    halton += jitter(Jitter::halton, i) / 900;
    if (i < 7) hdrp += jitter(Jitter::hdrp, i) / 7;
  }
  // The star discrepancy of 900 points in base 5 is below log5(900) * 5 / 900.
  CHECK((halton - Vec3::Constant(0.5)).cwiseAbs().maxCoeff() < 0.024);
  CHECK(hdrp.isApprox(Vec3::Constant(0.5), 1e-14));
}

TEST_CASE("froxel fog: frames are blended to their mean or a moving average", "[froxel_fog]") {
  Options o;
  o.frames = 16;
  float mean = 0, average = 0;
  double expected = 0;
  for (int frame = 0; frame < 16; ++frame) {
    const float value = float(frame * frame);
    o.blend = Blend::mean;
    mean = value + history_weight(o, frame) * (mean - value);
    o.blend = Blend::ema;
    average = value + history_weight(o, frame) * (average - value);
    expected += value * (frame == 0 ? std::pow(0.9, 15) : 0.1 * std::pow(0.9, 15 - frame));
  }
  CHECK(mean == Approx(15 * 16 * 31 / 6 / 16.0).epsilon(1e-6));
  CHECK(average == Approx(expected).epsilon(1e-6));
}

TEST_CASE("froxel fog: filters weigh 1 and keep a constant", "[froxel_fog]") {
  const Cells cells{9, 11, 8, 8};
  for (const Filter filter : {Filter::gauss3, Filter::gauss7}) {
    const std::vector<float> weights = filter_weights(filter);
    CHECK(2 * std::accumulate(weights.begin(), weights.end(), 0.0) - weights[0] == Approx(1).margin(1e-6));
    Volume constant = filled(cells, 9, [](int, int, int) { return grey(0.7, 3e-5); });
    constant.filter(filter, {2, {}});
    Volume one = filled(cells, 9, [](int x, int y, int k) { return grey(x == 4 && y == 5 && k == 4, x + 2 * y); });
    one.filter(filter, {2, {}});
    double sum = 0;
    const int reach = int(weights.size()) - 1, depth = filter == Filter::gauss7 ? reach : 0;
    for (int y = 0; y < cells.rows; ++y)
      for (int x = 0; x < cells.columns; ++x)
        for (int k = 0; k < 9; ++k) {
          CHECK((constant.column(x, y)[k].light == 0.7F).all());
          CHECK((constant.column(x, y)[k].media == 3e-5F).all());
          const int i = std::abs(x - 4), j = std::abs(y - 5), l = std::abs(k - 4);
          const bool inside = i <= reach && j <= reach && l <= depth;
          const double expected =
              inside ? double(weights[std::size_t(i)]) * weights[std::size_t(j)] * (depth ? weights[std::size_t(l)] : 1)
                     : 0;
          CHECK(one.column(x, y)[k].light[1] == Approx(expected).margin(1e-7));
          sum += one.column(x, y)[k].light[1];
          // Linear values do not change away from the border.
          if (x >= reach && x < 9 - reach && y >= reach && y < 11 - reach)
            CHECK(one.column(x, y)[k].media[2] == Approx(x + 2 * y).epsilon(1e-6));
        }
    CHECK(sum == Approx(1).margin(1e-6));
  }
  // exp(-r^2) over the 3 x 3 of a slice.
  const std::vector<float> hdrp = filter_weights(Filter::gauss3);
  CHECK(hdrp[1] * hdrp[1] / (hdrp[0] * hdrp[0]) == Approx(std::exp(-2.0)).epsilon(1e-6));
  CHECK(hdrp[1] / hdrp[0] == Approx(std::exp(-1.0)).epsilon(1e-6));
}

TEST_CASE("froxel fog: integration of a constant is exact, whatever the extinction", "[froxel_fog]") {
  for (const double extinction : {0.0, 1e-30, 1e-6, 1.0, 40.0, 1e6, 1e30}) {
    Volume volume = filled({2, 2, 1, 1}, 8, [&](int, int, int) { return grey(0.5, extinction); });
    volume.integrate(parallel_view(2, 2), {1, {}});
    CAPTURE(extinction);
    for (int k = 0; k < 8; ++k) {
      const double length = 2 * (k + 1) / 8.0;
      const double lit = extinction > 0 ? 0.5 * -std::expm1(-extinction * length) / extinction : 0.5 * length;
      CHECK(volume.column(1, 0)[k].light[0] == Approx(lit).epsilon(1e-6));
      CHECK(volume.column(1, 0)[k].media[0] == Approx(std::exp(-extinction * length)).epsilon(1e-6).margin(1e-37));
    }
  }
}

TEST_CASE("froxel fog: look-ups are trilinear, and nothing lies before the first slice", "[froxel_fog]") {
  // Linear in all three: f = x + 10 y + 100 (k + 1), x and y the middles of cells.
  const Volume volume =
      filled({3, 4, 8, 4}, 5, [](int x, int y, int k) { return grey(x + 10 * y + 100 * (k + 1), 0.1 * (5 - k)); });
  const auto light = [&](double x, double y, double u) { return volume.look_up(x, y, u).airlight[1]; };
  CHECK(light(4, 2, 0.2) == Approx(100));
  CHECK(light(12, 6, 0.6) == Approx(311));
  CHECK(light(7, 5, 0.75) == Approx(0.375 + 7.5 + 375));
  CHECK(light(0, 0, 1) == Approx(500));  // beyond the middles of the outermost cells: as there
  CHECK(light(24, 16, 1) == Approx(532));
  CHECK(light(4, 2, 0.1) == Approx(50));
  CHECK(light(20, 14, 0) == 0);
  CHECK(volume.look_up(9, 9, 0).transmittance[0] == Approx(1).epsilon(1e-15));
  CHECK(volume.look_up(9, 9, 0.1).transmittance[0] == Approx(0.75).epsilon(1e-6));
  CHECK(volume.look_up(9, 9, 1).transmittance[0] == Approx(0.1).epsilon(1e-6));
  const Volume one = filled({1, 1, 8, 8}, 1, [](int, int, int) { return grey(3, 0.5); });
  CHECK(one.look_up(7, 2, 1).airlight[0] == 3);
  CHECK(one.look_up(7, 2, 0.5).transmittance[0] == 0.75);
}

TEST_CASE("froxel fog: volumes that do not fit into memory are refused", "[froxel_fog]") {
  scene::set_limit("1GiB");
  CHECK_THROWS_WITH(Volume({1000, 1000, 8, 8}, equal_slices(100)),
                    Catch::Contains("froxel_fog: 1000 x 1000 x 100 froxels"));
  scene::reset_limits();
}

}  // namespace volume_test
