#include "scene/convert/fit_normal_matrix.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace airlight::scene {
namespace {

constexpr double least_exponent = 6.9;  // 1e-3
constexpr std::size_t block_size = 5 * 8;

// Gaussians by classes of width, a factor of 1.5 each; those of a class in cubes as wide as two of its widest reach. One list for all would
// look at every pair as soon as a single Gaussian is wide.
class Neighbours {
 public:
  explicit Neighbours(const std::vector<Gaussian>& gaussians) : gaussians_(gaussians) {
    double least = infinity;
    for (const Gaussian& g : gaussians) least = std::min(least, g.width);
    for (std::size_t i = 0; i < gaussians.size(); ++i) {
      const Gaussian& g = gaussians[i];
      const int which = int(std::log(g.width / least) / std::log(1.5));
      Class& c = classes_[which];
      if (c.cells.empty()) {
        c.widest = least * std::pow(1.5, which + 1);
        c.side = std::sqrt(2 * least_exponent) * c.widest;
      }
      c.cells[key(g.center, c.side)].push_back(std::uint32_t(i));
    }
  }
  // In ascending order, without itself.
  std::vector<std::uint32_t> near(std::size_t i) const {
    const Gaussian& a = gaussians_[i];
    std::vector<std::uint32_t> found;
    for (const auto& [which, c] : classes_) {
      const Vec3 reach = Vec3::Constant(std::sqrt(least_exponent * (a.width * a.width + c.widest * c.widest)));
      const Key lo = key(a.center - reach, c.side), hi = key(a.center + reach, c.side);
      for (long x = lo[0]; x <= hi[0]; ++x)
        for (long y = lo[1]; y <= hi[1]; ++y)
          for (long z = lo[2]; z <= hi[2]; ++z) {
            const auto cell = c.cells.find({x, y, z});
            if (cell == c.cells.end()) continue;
            for (const std::uint32_t j : cell->second) {
              const Gaussian& b = gaussians_[j];
              const double reach2 = least_exponent * (a.width * a.width + b.width * b.width);
              if (j != i && (a.center - b.center).squaredNorm() < reach2) found.push_back(j);
            }
          }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  using Key = std::array<long, 3>;
  struct Class {
    double widest = 0, side = 0;
    std::map<Key, std::vector<std::uint32_t>> cells;
  };
  static Key key(const Point3& x, double side) {
    return {std::lround(x[0] / side), std::lround(x[1] / side), std::lround(x[2] / side)};
  }
  const std::vector<Gaussian>& gaussians_;
  std::map<int, Class> classes_;
};

}  // namespace

Matrix5 overlap_derivatives(const Gaussian& i, const Gaussian& j) {
  const double a = i.width, b = j.width, u = a * a, v = b * b, s = u + v, wi = i.amplitude, wj = j.amplitude;
  const Vec3 d = i.center - j.center;
  const double d2 = d.squaredNorm(), root = std::sqrt(pi * u * v / s);
  const double g = root * root * root * std::exp(-d2 / s);
  // Logarithmic derivatives by the two widths, and the mixed one.
  const double la = 3 / a - 3 * a / s + 2 * a * d2 / (s * s), lb = 3 / b - 3 * b / s + 2 * b * d2 / (s * s);
  const double lab = 6 * a * b / (s * s) - 8 * a * b * d2 / (s * s * s);
  Matrix5 m;
  m.topLeftCorner<3, 3>() = wi * wj * g * (2 / s * Mat3::Identity() - 4 / (s * s) * d * d.transpose());
  m.topRightCorner<3, 1>() = -2 / s * wi * g * d;
  m.bottomLeftCorner<1, 3>() = (2 / s * wj * g * d).transpose();
  m.block<3, 1>(0, 3) = wi * wj * g * (4 * b / (s * s) - 2 * lb / s) * d;
  m.block<1, 3>(3, 0) = -wi * wj * g * (4 * a / (s * s) - 2 * la / s) * d.transpose();
  m(3, 3) = wi * wj * g * (la * lb + lab);
  m(3, 4) = wi * g * la;
  m(4, 3) = wj * g * lb;
  m(4, 4) = g;
  return m;
}

NormalMatrix::NormalMatrix(const std::vector<Gaussian>& gaussians)
    : diagonal_(gaussians.size()), begin_(gaussians.size() + 1, 0) {
  const Neighbours neighbours(gaussians);
  std::vector<std::vector<std::uint32_t>> near(gaussians.size());
  const auto each = [&](auto&& body) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, gaussians.size(), 16),
        [&](const auto& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
  };
  each([&](std::size_t i) { near[i] = neighbours.near(i); });
  for (std::size_t i = 0; i < gaussians.size(); ++i) begin_[i + 1] = begin_[i] + near[i].size();
  column_.resize(begin_.back());
  block_.resize(begin_.back() * block_size);
  each([&](std::size_t i) {
    diagonal_[i] = overlap_derivatives(gaussians[i], gaussians[i]);
    for (std::size_t k = 0; k < near[i].size(); ++k) {
      column_[begin_[i] + k] = near[i][k];
      const Matrix5 m = overlap_derivatives(gaussians[i], gaussians[near[i][k]]);
      float* const to = block_.data() + (begin_[i] + k) * block_size;
      for (int column = 0; column < 5; ++column)
        for (int row = 0; row < 8; ++row) to[8 * column + row] = row < 5 ? float(m(row, column)) : 0.0f;
    }
  });
}

void NormalMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, size(), 64),
      [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          separable::Vector<float> others{};
          for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
            const auto* const column =
                reinterpret_cast<const separable::Vector<float>*>(block_.data() + k * block_size);
            const double* const from = x.data() + 5 * column_[k];
            for (int c = 0; c < 5; ++c) others += column[c] * float(from[c]);
          }
          Vector5 sum = diagonal_[i] * x.segment<5>(Eigen::Index(5 * i));
          for (int row = 0; row < 5; ++row) sum[row] += double(others[row]);
          y.segment<5>(Eigen::Index(5 * i)) = sum;
        }
      },
      tbb::simple_partitioner());
}

}  // namespace airlight::scene
