#include "methods/compensated_ray_marching/sphere_shadow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/base/error.h"
#include "scene/math/dense.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr int most_steps = 60;          // of Levenberg and Marquardt's
constexpr double difference = 1e-5;     // of coefficients, for derivatives
constexpr double small_enough = 1e-12;  // of what a step gains, relative

double legendre(int l, double x) { return std::legendre(unsigned(l), std::abs(x)) * (x < 0 && l % 2 ? -1 : 1); }

// The zonal function about z, and back.
Harmonics about_z(const Eigen::VectorXd& zonal) {
  return about_axis(std::vector<double>(zonal.begin(), zonal.end()), Vec3::UnitZ());
}
Eigen::VectorXd zonal_of(const Harmonics& f, int order) {
  Eigen::VectorXd zonal(order);
  for (int l = 0; l < order; ++l) zonal[l] = f[std::size_t(scene::sh_index(l, 0))];
  return zonal;
}

// Least squares of exponential(f) = visible, f no longer than `longest` without its mean, from f on (Levenberg 1944, Marquardt 1963).
double fit(const HarmonicExponential& exponential, const Eigen::VectorXd& visible, double longest, Eigen::VectorXd& f) {
  const auto n = f.size();
  const auto residual = [&](const Eigen::VectorXd& at) {
    return Eigen::VectorXd(zonal_of(exponential(about_z(at)), int(n)) - visible);
  };
  Eigen::VectorXd now = residual(f);
  double damping = 1e-3;
  for (int step = 0; step < most_steps && now.norm() > 1e-13; ++step) {
    Eigen::MatrixXd jacobian(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::VectorXd up = f, down = f;
      up[i] += difference;
      down[i] -= difference;
      jacobian.col(i) = (residual(up) - residual(down)) / (2 * difference);
    }
    const Eigen::MatrixXd normal = scene::product(jacobian.transpose(), jacobian);
    const Eigen::VectorXd right = -jacobian.transpose() * now;
    bool better = false;
    double gain = 0;
    for (; !better && damping < 1e12; damping *= better ? 0.1 : 8) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + 1e-12).matrix();
      Eigen::VectorXd next = f + scene::solve_definite(damped, right);
      if (const double length = next.tail(n - 1).norm(); length > longest) next.tail(n - 1) *= longest / length;
      const Eigen::VectorXd then = residual(next);
      better = then.allFinite() && then.squaredNorm() < now.squaredNorm();
      if (!better) continue;
      gain = now.squaredNorm() - then.squaredNorm();
      f = next;
      now = then;
    }
    if (!better || gain < small_enough * now.squaredNorm()) break;
  }
  return now.norm() / std::sqrt(4 * pi);
}

}  // namespace

// Integrals of P_l from -1 to c are (P_{l+1}(c) - P_{l-1}(c)) / (2l+1).
std::vector<double> visible_zonal(int order, double cosine) {
  const double c = std::clamp(cosine, -1.0, 1.0);
  std::vector<double> zonal{std::sqrt(pi) * (1 + c)};
  for (int l = 1; l < order; ++l)
    zonal.push_back(std::sqrt(pi / (2 * l + 1)) * (legendre(l + 1, c) - legendre(l - 1, c)));
  return zonal;
}

std::optional<double> hidden_angle(const scene::Sphere& sphere, const Point3& x) {
  const double distance = (sphere.center - x).norm();
  if (distance <= sphere.radius) return {};
  return std::asin(sphere.radius / distance);
}

ShadowTable::ShadowTable(int order, const HarmonicExponential& exponential, int samples, double longest)
    : order_(order) {
  if (order < 1 || order > 6 || samples < 2 || !(longest > 0))
    throw Error("shadows of spheres: expected an order of 1 to 6, two samples or more, and a length");
  Eigen::VectorXd f = Eigen::VectorXd::Zero(order);
  for (int i = 0; i < samples; ++i) {
    const std::vector<double> visible = visible_zonal(order, std::cos(0.5 * pi * i / (samples - 1)));
    errors_.push_back(fit(exponential, Eigen::Map<const Eigen::VectorXd>(visible.data(), order), longest, f));
    samples_.emplace_back(f.begin(), f.end());
  }
}

std::vector<double> ShadowTable::zonal(double angle) const {
  const double place = std::clamp(angle / (0.5 * pi), 0.0, 1.0) * double(samples_.size() - 1);
  const std::size_t first = std::min(std::size_t(place), samples_.size() - 2);
  std::vector<double> between = samples_[first];
  for (std::size_t l = 0; l < between.size(); ++l)
    between[l] += (place - double(first)) * (samples_[first + 1][l] - between[l]);
  return between;
}

std::optional<Harmonics> log_visibility(const std::vector<scene::Sphere>& spheres, const Point3& x,
                                        const ShadowTable& table, double least) {
  Harmonics sum(std::size_t(table.order() * table.order()), 0.0);
  for (const scene::Sphere& sphere : spheres) {
    const std::optional<double> angle = hidden_angle(sphere, x);
    if (!angle) return {};
    if (*angle < least) continue;
    const Harmonics one = about_axis(table.zonal(*angle), (sphere.center - x).normalized());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += one[i];
  }
  return sum;
}

// Ramamoorthi and Hanrahan 2001.
std::vector<double> cosine_zonal(int order) {
  std::vector<double> cosine{std::sqrt(pi) / 2, std::sqrt(pi / 3), std::sqrt(5 * pi) / 8, 0, -std::sqrt(pi) / 16, 0};
  cosine.resize(std::size_t(order));
  return cosine;
}

Rgb irradiance(const Vec3& normal, const Harmonics& visible, const std::vector<Rgb>& light) {
  const int order = int(std::lround(std::sqrt(double(visible.size()))));
  if (light.size() != visible.size() || order < 1 || order > 6)
    throw Error("irradiance: light and visibility of different orders, or of none from 1 to 6");
  const std::vector<double> lobe = about_axis(cosine_zonal(order), normal);
  const std::vector<Rgb> lit = scene::triple_product(order)(light, visible);
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < lobe.size(); ++i) sum += lobe[i] * lit[i];
  return sum.max(0);
}

double visible_share(const std::vector<scene::Sphere>& spheres, const Point3& x, const Vec3& toward, double spacing) {
  double share = 1;
  for (const scene::Sphere& sphere : spheres) {
    const std::optional<double> angle = hidden_angle(sphere, x);
    if (!angle) return 0;
    const Vec3 way = (sphere.center - x).normalized();
    const double away = std::atan2(way.cross(toward).norm(), way.dot(toward)) - *angle;
    share *= spacing > 0 ? std::clamp(0.5 + away / spacing, 0.0, 1.0) : double(away >= 0);
  }
  return share;
}

}  // namespace airlight::compensated_ray_marching
