#include "scene/convert/fit_normal_matrix.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace airlight::scene {
namespace {

constexpr double least_exponent = 6.9;  // 1e-3

// Gaussians in cubes as wide as the farthest pair reaches.
class Cells {
 public:
  explicit Cells(const std::vector<Gaussian>& gaussians) : gaussians_(gaussians) {
    double widest = 1e-300;
    for (const Gaussian& g : gaussians) widest = std::max(widest, g.width);
    side_ = std::sqrt(2 * least_exponent) * widest;
    for (std::size_t i = 0; i < gaussians.size(); ++i) cells_[key(gaussians[i].center)].push_back(std::uint32_t(i));
  }
  // In ascending order.
  std::vector<std::uint32_t> near(std::size_t i) const {
    std::vector<std::uint32_t> found;
    const auto [x, y, z] = key(gaussians_[i].center);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const auto cell = cells_.find({x + dx, y + dy, z + dz});
          if (cell == cells_.end()) continue;
          for (const std::uint32_t j : cell->second) {
            const Gaussian &a = gaussians_[i], &b = gaussians_[j];
            const double reach2 = least_exponent * (a.width * a.width + b.width * b.width);
            if (j != i && (a.center - b.center).squaredNorm() < reach2) found.push_back(j);
          }
        }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  using Key = std::array<long, 3>;
  Key key(const Point3& x) const {
    return {std::lround(x[0] / side_), std::lround(x[1] / side_), std::lround(x[2] / side_)};
  }
  const std::vector<Gaussian>& gaussians_;
  double side_;
  std::map<Key, std::vector<std::uint32_t>> cells_;
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
  const Cells cells(gaussians);
  std::vector<std::vector<std::uint32_t>> near(gaussians.size());
  const auto each = [&](auto&& body) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, gaussians.size(), 16),
        [&](const auto& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
  };
  each([&](std::size_t i) { near[i] = cells.near(i); });
  for (std::size_t i = 0; i < gaussians.size(); ++i) begin_[i + 1] = begin_[i] + near[i].size();
  column_.resize(begin_.back());
  block_.resize(begin_.back());
  each([&](std::size_t i) {
    diagonal_[i] = overlap_derivatives(gaussians[i], gaussians[i]);
    for (std::size_t k = 0; k < near[i].size(); ++k) {
      column_[begin_[i] + k] = near[i][k];
      block_[begin_[i] + k] = overlap_derivatives(gaussians[i], gaussians[near[i][k]]).cast<float>();
    }
  });
}

void NormalMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, size(), 64),
      [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          Vector5 sum = diagonal_[i] * x.segment<5>(Eigen::Index(5 * i));
          for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k)
            sum.noalias() += block_[k].cast<double>() * x.segment<5>(Eigen::Index(5 * column_[k]));
          y.segment<5>(Eigen::Index(5 * i)) = sum;
        }
      },
      tbb::simple_partitioner());
}

}  // namespace airlight::scene
