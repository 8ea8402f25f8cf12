#include "tests/second_opinion/ball_transport.h"

#include <algorithm>
#include <cmath>

#include "scene/math/dense.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/types.h"

namespace airlight::test {
namespace {

constexpr int shells = 10, points = 10, angles = 40, points_on_a_chord = 12;

}  // namespace

BallTransport::BallTransport(const BallLight& light) : light_(light), bands_(int(light.phase.size())) {
  const scene::GaussLegendre rule = scene::gauss_legendre(points);
  for (int s = 0; s <= shells; ++s) edges_.push_back(light.cut * s / shells);
  for (int s = 0; s < shells; ++s)
    for (const double x : rule.node)
      node_.push_back(edges_[std::size_t(s)] + 0.5 * (1 + x) * (edges_[std::size_t(s) + 1] - edges_[std::size_t(s)]));
  Eigen::MatrixXd values(points, points);
  for (int i = 0; i < points; ++i)
    for (int k = 0; k < points; ++k) values(i, k) = std::legendre(unsigned(k), rule.node[std::size_t(i)]);
  interpolation_ = scene::inverse(values);
  const auto n = Eigen::Index(node_.size()) * bands_;
  Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right(n);
  for (std::size_t i = 0; i < node_.size(); ++i) {
    system.middleRows(Eigen::Index(i) * bands_, bands_) -= moment_rows(node_[i]);
    for (int l = 0; l < bands_; ++l) right[Eigen::Index(i) * bands_ + l] = reduced_moment(l, node_[i]);
  }
  moments_ = scene::SquareFactors(system).solve(right);
}

double BallTransport::depth_from_face(double impact, double along) const {
  const double half = std::sqrt(std::max(0.0, light_.cut * light_.cut - impact * impact));
  return light_.extinction * std::exp(-impact * impact) * 0.5 * std::sqrt(pi) * (std::erf(along) + std::erf(half));
}

Eigen::RowVectorXd BallTransport::gathered(double impact, double along) const {
  static const scene::GaussLegendre rule = scene::gauss_legendre(points_on_a_chord);
  const double half = std::sqrt(std::max(0.0, light_.cut * light_.cut - impact * impact));
  std::vector<double> ends{-half, along, 0};
  for (const double edge : edges_)
    if (edge > impact)
      ends.insert(ends.end(), {-std::sqrt(edge * edge - impact * impact), std::sqrt(edge * edge - impact * impact)});
  std::erase_if(ends, [&](double x) { return x < -half || x > along; });
  std::sort(ends.begin(), ends.end());
  const double column = light_.extinction * std::exp(-impact * impact) * 0.5 * std::sqrt(pi), here = std::erf(along);
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(Eigen::Index(node_.size()) * bands_);
  std::vector<double> p(std::size_t(bands_), 0.0);
  Eigen::Matrix<double, 1, points> polynomials;
  const Eigen::Matrix<double, points, points> interpolation = interpolation_;
  for (std::size_t e = 0; e + 1 < ends.size(); ++e) {
    const double length = ends[e + 1] - ends[e];
    if (!(length > 0)) continue;
    for (int q = 0; q < points_on_a_chord; ++q) {
      const double x = ends[e] + 0.5 * (1 + rule.node[std::size_t(q)]) * length;
      const double radius = std::hypot(impact, x), mu = x / radius;
      const double weight = 0.5 * rule.weight[std::size_t(q)] * length * light_.extinction *
                            std::exp(column * (std::erf(x) - here) - radius * radius);
      const int shell = std::clamp(int(radius / light_.cut * shells), 0, shells - 1);
      const double lo = edges_[std::size_t(shell)], hi = edges_[std::size_t(shell) + 1];
      const double place = 2 * (radius - lo) / (hi - lo) - 1;
      polynomials[0] = 1, polynomials[1] = place;
      for (int k = 1; k + 1 < points; ++k)
        polynomials[k + 1] = ((2 * k + 1) * place * polynomials[k] - k * polynomials[k - 1]) / (k + 1);
      for (int l = 0; l < bands_; ++l)
        p[std::size_t(l)] =
            weight * light_.albedo * (2 * l + 1) * light_.phase[std::size_t(l)] * std::legendre(unsigned(l), mu);
      const Eigen::Matrix<double, 1, points> shares = polynomials * interpolation;
      for (int i = 0; i < points; ++i)
        for (int l = 0; l < bands_; ++l) row[(shell * points + i) * bands_ + l] += shares[i] * p[std::size_t(l)];
    }
  }
  return row;
}

namespace {

// Calls of(cosine to the radius, weight): half the integral over cosines, with most nodes where a ray touches the sphere.
template <class Of>
void each_cosine(const Of& of) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(angles);
  for (const double side : {-1.0, 1.0})
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double u = 0.5 + 0.5 * rule.node[k];
      of(side * u * u, 0.5 * rule.weight[k] * u);
    }
}

}  // namespace

Eigen::MatrixXd BallTransport::moment_rows(double radius) const {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(bands_, Eigen::Index(node_.size()) * bands_);
  each_cosine([&](double mu, double weight) {
    const Eigen::RowVectorXd row = gathered(radius * std::sqrt(1 - mu * mu), radius * mu);
    for (int l = 0; l < bands_; ++l) rows.row(l) += weight * std::legendre(unsigned(l), mu) * row;
  });
  return rows;
}

double BallTransport::moment(int l, double radius) const {
  return reduced_moment(l, radius) + moment_rows(radius).row(l).dot(moments_);
}

double BallTransport::reduced_moment(int l, double radius) const {
  double reduced = 0;
  each_cosine([&](double mu, double weight) {
    reduced += weight * std::legendre(unsigned(l), mu) * light_.environment *
               std::exp(-depth_from_face(radius * std::sqrt(1 - mu * mu), radius * mu));
  });
  return reduced;
}

double BallTransport::exit_transmittance(double impact) const {
  return std::exp(-depth_from_face(impact, std::sqrt(light_.cut * light_.cut - impact * impact)));
}

double BallTransport::exit_radiance(double impact) const {
  const double half = std::sqrt(light_.cut * light_.cut - impact * impact);
  return light_.environment * exit_transmittance(impact) + gathered(impact, half).dot(moments_);
}

}  // namespace airlight::test
