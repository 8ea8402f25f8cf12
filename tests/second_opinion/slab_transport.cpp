#include "tests/second_opinion/slab_transport.h"

#include <cmath>

#include "scene/math/dense.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/types.h"

namespace airlight::test {
namespace {

// (1 - exp(-x)) / x.
double mean_left(double x) { return std::abs(x) < 1e-8 ? 1 - x / 2 : -std::expm1(-x) / x; }

}  // namespace

// With S and D the sum and the difference of opposite directions, and C_e, C_o the scattering of even and odd bands:
//   mu S' = -(1 - C_o) D,   mu D' = -(1 - C_e) S + 2 J.
// Weighted with the roots of the quadrature's weights both matrices are symmetric, and so is the equation for S made to be.
SlabTransport::SlabTransport(const SlabLight& light, int directions)
    : light_(light), mu_(directions), weight_(directions) {
  const scene::GaussLegendre rule = scene::gauss_legendre(directions);
  for (int i = 0; i < directions; ++i) {
    const double u = 0.5 + 0.5 * rule.node[std::size_t(i)];  // mu = u^2: radiance near a face has a root there
    mu_[i] = u * u;
    weight_[i] = 0.5 * rule.weight[std::size_t(i)] * 2 * u;
  }
  const Eigen::VectorXd root = weight_.cwiseSqrt();
  Eigen::MatrixXd sides[2];  // 1 - C of even and of odd bands
  for (Eigen::MatrixXd& side : sides) side = Eigen::MatrixXd::Identity(directions, directions);
  for (int l = 0; l < int(light.phase.size()); ++l) {
    Eigen::VectorXd p(directions);
    for (int i = 0; i < directions; ++i) p[i] = std::legendre(unsigned(l), mu_[i]) * root[i];
    sides[l % 2] -= light.albedo * (2 * l + 1) * light.phase[std::size_t(l)] * p * p.transpose();
  }
  const Eigen::VectorXd slowness = mu_.cwiseInverse();
  const Eigen::MatrixXd lower = scene::DefiniteFactors(sides[0]).lower();
  const Eigen::MatrixXd inner = slowness.asDiagonal() * lower;
  const scene::SymmetricModes modes = scene::symmetric_modes(inner.transpose() * sides[1] * inner);
  rate_ = modes.values.cwiseSqrt();
  const Eigen::MatrixXd weighted = scene::solve_upper(lower.transpose(), modes.vectors);
  sum_ = root.cwiseInverse().asDiagonal() * weighted;
  difference_ = root.cwiseInverse().asDiagonal() *
                scene::DefiniteFactors(sides[1]).solve(mu_.asDiagonal() * weighted * rate_.asDiagonal());
  even_ = 2 * light.emission / (1 - light.albedo);
  moments_ = Eigen::MatrixXd::Zero(Eigen::Index(light.phase.size()), directions);
  for (int l = 0; l < int(light.phase.size()); ++l)
    for (int i = 0; i < directions; ++i)
      moments_.row(l) += 0.5 * weight_[i] * std::legendre(unsigned(l), mu_[i]) * (l % 2 ? difference_ : sum_).row(i);

  // Inflow: (S + D) / 2 at the top, (S - D) / 2 at the bottom.
  const Eigen::VectorXd far = (-light.thickness * rate_).array().exp();
  Eigen::MatrixXd faces(2 * directions, 2 * directions);
  faces << sum_ + difference_, (sum_ - difference_) * far.asDiagonal(), (sum_ - difference_) * far.asDiagonal(),
      sum_ + difference_;
  Eigen::VectorXd comes(2 * directions);
  comes.head(directions).setConstant(2 * light.top - even_);
  comes.tail(directions).setConstant(2 * light.bottom - even_);
  const Eigen::VectorXd shares = scene::SquareFactors(faces).solve(comes);
  falling_ = shares.head(directions);
  growing_ = shares.tail(directions);
}

Eigen::VectorXd SlabTransport::sums(double depth) const {
  const Eigen::VectorXd near = (-depth * rate_).array().exp() * falling_.array(),
                        far = (-(light_.thickness - depth) * rate_).array().exp() * growing_.array();
  return (sum_ * (near + far)).array() + even_;
}

Eigen::VectorXd SlabTransport::differences(double depth) const {
  const Eigen::VectorXd near = (-depth * rate_).array().exp() * falling_.array(),
                        far = (-(light_.thickness - depth) * rate_).array().exp() * growing_.array();
  return difference_ * (near - far);
}

double SlabTransport::mean(double depth) const { return 0.5 * weight_.dot(sums(depth)); }

double SlabTransport::flux_leaving(bool top) const {
  const double depth = top ? 0 : light_.thickness;
  const Eigen::VectorXd leaves = 0.5 * (sums(depth) + (top ? -1 : 1) * differences(depth));
  return 2 * pi * weight_.cwiseProduct(mu_).dot(leaves);
}

double SlabTransport::gathered(double depth, double mu, bool turned) const {
  std::vector<double> factors;
  for (int l = 0; l < int(light_.phase.size()); ++l)
    factors.push_back(light_.albedo * (2 * l + 1) * light_.phase[std::size_t(l)] * std::legendre(unsigned(l), mu));
  // Mode by mode: a source exp(-k t), and exp(-k (T - t)), with T where the modes that grow begin.
  const double rest = light_.thickness - depth;
  const Eigen::VectorXd &first = turned ? growing_ : falling_, &second = turned ? falling_ : growing_;
  double sum = 0;
  for (Eigen::Index j = 0; j < rate_.size(); ++j) {
    const double k = rate_[j], x = (1 / mu - k) * depth;
    const double with =
        depth / mu * (x > 0 ? std::exp(-k * depth) * mean_left(x) : std::exp(-depth / mu) * mean_left(-x));
    const double against = (std::exp(-k * rest) - std::exp(-k * light_.thickness - depth / mu)) / (1 + k * mu);
    for (int l = 0; l < int(light_.phase.size()); ++l) {
      // Odd moments turn with the mode, and with the slab.
      const double scattered = factors[std::size_t(l)] * moments_(l, j);
      sum += scattered * (first[j] * with + (l % 2 ? -1 : 1) * second[j] * against);
    }
  }
  return sum + (light_.albedo * even_ / 2 + light_.emission) * -std::expm1(-depth / mu);
}

double SlabTransport::radiance(double depth, double mu) const {
  if (mu > 0) return light_.top * std::exp(-depth / mu) + gathered(depth, mu, false);
  const double from = light_.thickness - depth;
  return light_.bottom * std::exp(from / mu) + gathered(from, -mu, true);
}

double SlabTransport::reduced_moment(int l, double depth) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < mu_.size(); ++i)
    sum += 0.5 * weight_[i] * std::legendre(unsigned(l), mu_[i]) *
           (light_.top * std::exp(-depth / mu_[i]) +
            (l % 2 ? -1 : 1) * light_.bottom * std::exp(-(light_.thickness - depth) / mu_[i]));
  return sum;
}

// 1 / H = sqrt(1 - albedo) + albedo / 2 integral of mu' H(mu') / (mu + mu'), which iteration meets for every albedo.
HFunction::HFunction(double albedo, int nodes) : albedo_(albedo) {
  const scene::GaussLegendre rule = scene::gauss_legendre(nodes);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double u = 0.5 + 0.5 * rule.node[i];
    node_.push_back(u * u);
    weight_.push_back(rule.weight[i] * u);
  }
  value_.assign(node_.size(), 1.0);
  for (double change = 1; change > 1e-15;) {
    std::vector<double> next;
    change = 0;
    for (std::size_t i = 0; i < node_.size(); ++i) {
      next.push_back((*this)(node_[i]));
      change = std::max(change, std::abs(next[i] - value_[i]) / next[i]);
    }
    value_ = std::move(next);
    if (change < 4e-15) break;
  }
}

double HFunction::operator()(double mu) const {
  double sum = std::sqrt(1 - albedo_);
  for (std::size_t i = 0; i < node_.size(); ++i)
    sum += 0.5 * albedo_ * weight_[i] * node_[i] * value_[i] / (mu + node_[i]);
  return 1 / sum;
}

double HFunction::first_moment() const {
  double sum = 0;
  for (std::size_t i = 0; i < node_.size(); ++i) sum += weight_[i] * node_[i] * value_[i];
  return sum;
}

}  // namespace airlight::test
