#include "methods/wavelet_fog/path_table.h"

#include <algorithm>
#include <cmath>

#include "scene/math/bspline.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::wavelet_fog {

void UnitPieces::at(double u, double* values) const {
  scene::with_degree(degree, [&](auto n) {
    double whole[n() + 1], half[n() + 1];
    scene::cell_basis<n()>(u, whole);
    std::copy(whole, whole + n() + 1, values);
    if (wavelet() == 0) return;
    // In half cell s, 2 (u + wavelet_first + m) - k is that cell's local position and a whole number, at most n.
    const int s = u < 0.5 ? 0 : 1;
    scene::cell_basis<n()>(2 * u - s, half);
    for (int m = 0; m < wavelet(); ++m) {
      double sum = 0;
      for (int d = 0; d <= n(); ++d) {
        const int k = s + 2 * (wavelet_first() + m) - d - q.first;
        if (k >= 0 && k < int(q.values.size())) sum += q.values[k] * half[d];
      }
      values[scaling() + m] = sum;
    }
  });
}

double PathTable::place(double u, double v) {
  const double away[4] = {std::abs(v), std::abs(1 - u), std::abs(1 - v), std::abs(u)};
  const int side = int(std::min_element(away, away + 4) - away);
  const double along[4] = {u, v, 1 - u, 1 - v};
  return side + std::clamp(along[side], 0.0, 1.0);
}

Vec3 PathTable::point(double place) {
  const int side = std::min(int(place), 3);
  const double s = place - side;
  switch (side) {
    case 0:
      return {s, 0, 0};
    case 1:
      return {1, s, 0};
    case 2:
      return {1 - s, 1, 0};
    default:
      return {0, 1 - s, 0};
  }
}

PathTable::PathTable(const UnitPieces& pieces, int R, Lookup lookup, bool moments)
    : count_(pieces.count()), places_(4 * R), channels_(moments ? 2 : 1), lookup_(lookup) {
  const std::size_t of_channel = std::size_t(count_) * count_, tables = of_channel * channels_;
  values_.resize(tables * places_ * places_);
  // A wavelet is a polynomial in half cells: each way is cut there, and n + 1 points are exact, of moments too.
  const scene::GaussLegendre rule = scene::gauss_legendre(pieces.degree + 1);
  std::vector<double> along_u(count_), along_v(count_), sum(tables);
  for (int entry = 0; entry < places_; ++entry)
    for (int exit = 0; exit < places_; ++exit) {
      const Vec3 from = point(double(entry) / R), step = point(double(exit) / R) - from;
      double cuts[4] = {0, 1, 1, 1};
      int count = 1;
      for (int a = 0; a < 2; ++a)
        if (const double t = (0.5 - from[a]) / step[a]; step[a] != 0 && t > 0 && t < 1) cuts[count++] = t;
      std::sort(cuts, cuts + count);
      cuts[count] = 1;
      std::fill(sum.begin(), sum.end(), 0.0);
      for (int part = 0; part < count; ++part)
        for (std::size_t k = 0; k < rule.node.size(); ++k) {
          const double half = 0.5 * (cuts[part + 1] - cuts[part]), share = cuts[part] + half * (1 + rule.node[k]);
          const Vec3 x = from + share * step;
          pieces.at(x[0], along_u.data());
          pieces.at(x[1], along_v.data());
          const double weight = half * rule.weight[k] * step.norm();
          for (int a = 0; a < count_; ++a)
            for (int b = 0; b < count_; ++b) {
              const double piece = weight * along_u[a] * along_v[b];
              sum[a * count_ + b] += piece;
              if (moments) sum[of_channel + a * count_ + b] += share * piece;
            }
        }
      float* to = values_.data() + (std::size_t(entry) * places_ + exit) * tables;
      std::transform(sum.begin(), sum.end(), to, [](double value) { return float(value); });
    }
}

void PathTable::integrals(double entry, double exit, double* out) const {
  const int tables = count_ * count_ * channels_, R = places_ / 4;
  const auto row = [&](long a, long b) {
    return values_.data() + (std::size_t(a % places_) * places_ + std::size_t(b % places_)) * tables;
  };
  if (lookup_ == Lookup::nearest) {
    const float* nearest = row(std::lround(entry * R), std::lround(exit * R));
    std::copy(nearest, nearest + tables, out);
    return;
  }
  const long a = long(entry * R), b = long(exit * R);
  const double s = entry * R - double(a), t = exit * R - double(b);
  const float *p00 = row(a, b), *p01 = row(a, b + 1), *p10 = row(a + 1, b), *p11 = row(a + 1, b + 1);
  for (int i = 0; i < tables; ++i)
    out[i] = (1 - s) * ((1 - t) * p00[i] + t * p01[i]) + s * ((1 - t) * p10[i] + t * p11[i]);
}

}  // namespace airlight::wavelet_fog
