#include "scene/math/sh_rotation.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <mutex>

#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::scene {
namespace {

constexpr int greatest_turned_order = 12;

// <Y_i, Y_j(X^-1 .)> by a rule that is exact for polynomials of twice the highest degree.
ShQuarterTurn quarter_turn(int order) {
  const int size = order * order, around = 2 * order;
  const GaussLegendre rule = gauss_legendre(order);
  std::vector<double> dense(std::size_t(size) * size, 0.0);
  for (int n = 0; n < order; ++n)
    for (int k = 0; k < around; ++k) {
      const double z = rule.node[n], s = std::sqrt((1 - z) * (1 + z)), phi = 2 * pi * (k + 0.5) / around;
      const Vec3 w(s * std::cos(phi), s * std::sin(phi), z);
      const std::vector<double> y = evaluate_sh(order, w), before = evaluate_sh(order, Vec3(w[0], w[2], -w[1]));
      for (int l = 0; l < order; ++l)
        for (int i = l * l; i < (l + 1) * (l + 1); ++i)
          for (int j = l * l; j < (l + 1) * (l + 1); ++j)
            dense[std::size_t(i) * size + j] += 2 * pi / around * rule.weight[n] * y[i] * before[j];
    }
  ShQuarterTurn turn;
  for (int i = 0; i < size; ++i) {
    turn.first.push_back(int(turn.column.size()));
    for (int j = 0; j < size; ++j)
      if (const double value = dense[std::size_t(i) * size + j]; std::abs(value) > 1e-12) {
        turn.column.push_back(j);
        turn.value.push_back(value);
      }
  }
  turn.first.push_back(int(turn.column.size()));
  return turn;
}

// Turns by the angle with this cosine and sine about z.
void turn_about_z(std::vector<Rgb>& f, int order, double cosine, double sine) {
  double c = 1, s = 0;  // of m times the angle
  for (int m = 1; m < order; ++m) {
    const double next = c * cosine - s * sine;
    s = c * sine + s * cosine;
    c = next;
    for (int l = m; l < order; ++l) {
      Rgb &even = f[sh_index(l, m)], &odd = f[sh_index(l, -m)];
      const Rgb before = even;
      even = c * before - s * odd;
      odd = s * before + c * odd;
    }
  }
}

std::vector<Rgb> quarter_turned(const std::vector<Rgb>& f, const ShQuarterTurn& turn) {
  std::vector<Rgb> result(f.size(), Rgb::Zero());
  for (std::size_t i = 0; i < f.size(); ++i)
    for (int k = turn.first[i]; k < turn.first[i + 1]; ++k) result[i] += turn.value[k] * f[turn.column[k]];
  return result;
}

}  // namespace

const ShQuarterTurn& sh_quarter_turn(int order) {
  static std::mutex mutex;
  static std::array<std::unique_ptr<const ShQuarterTurn>, greatest_turned_order + 1> kept;
  if (order < 1 || order > greatest_turned_order)
    throw Error(fmt::format("a rotation of harmonics of order {}, expected 1 to {}", order, greatest_turned_order));
  const std::lock_guard lock(mutex);
  if (!kept[order]) kept[order] = std::make_unique<const ShQuarterTurn>(quarter_turn(order));
  return *kept[order];
}

std::vector<Rgb> turned_sh(const std::vector<Rgb>& f, const Mat3& rotation) {
  const int order = int(std::lround(std::sqrt(double(f.size()))));
  if (std::size_t(order) * order != f.size())
    throw Error(fmt::format("{} coefficients of harmonics, expected a square number", f.size()));
  const ShQuarterTurn& turn = sh_quarter_turn(order);
  // Where the pole stays the pole, or becomes its opposite, a is free: 0.
  const Vec3 x = rotation.col(0), z = rotation.col(2);
  const double sine = std::hypot(z[0], z[1]);
  const double ca = sine > 0 ? z[0] / sine : 1, sa = sine > 0 ? z[1] / sine : 0;
  const double cc = x.dot(Vec3(z[2] * ca, z[2] * sa, -sine)), sc = x.dot(Vec3(-sa, ca, 0));
  std::vector<Rgb> g = f;
  turn_about_z(g, order, cc, sc);
  g = quarter_turned(g, turn);
  turn_about_z(g, order, -z[2], -sine);
  g = quarter_turned(g, turn);
  turn_about_z(g, order, -ca, -sa);
  return g;
}

}  // namespace airlight::scene
