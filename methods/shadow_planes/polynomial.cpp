#include "methods/shadow_planes/polynomial.h"

#include "scene/base/error.h"
#include "scene/math/types.h"

namespace airlight::shadow_planes {
namespace {

using Series = std::vector<double>;

Series product(const Series& a, const Series& b) {
  Series c(a.size(), 0.0);
  for (std::size_t n = 0; n < a.size(); ++n)
    for (std::size_t i = 0; i <= n; ++i) c[n] += a[i] * b[n - i];
  return c;
}

// v^alpha for v_0 > 0, by v b' = alpha v' b.
Series power(const Series& v, double alpha) {
  Series b(v.size());
  b[0] = std::pow(v[0], alpha);
  for (std::size_t n = 1; n < v.size(); ++n) {
    double sum = 0;
    for (std::size_t k = 1; k <= n; ++k) sum += (k * alpha - double(n - k)) * v[k] * b[n - k];
    b[n] = sum / (n * v[0]);
  }
  return b;
}

Series sine(int degree, double centre) {
  Series s(degree + 1);
  double factorial = 1;
  for (int n = 0; n <= degree; ++n) {
    if (n > 0) factorial *= n;
    const double derivative[] = {std::sin(centre), std::cos(centre), -std::sin(centre), -std::cos(centre)};
    s[n] = derivative[n % 4] / factorial;
  }
  return s;
}

// tan(pi/4 + theta/2), by q' = (1 + q^2)/2.
Series tangent(int degree, double centre) {
  Series q(degree + 1);
  q[0] = std::tan(0.25 * pi + 0.5 * centre);
  for (int n = 0; n < degree; ++n) {
    double sum = n == 0 ? 1 : 0;
    for (int i = 0; i <= n; ++i) sum += q[i] * q[n - i];
    q[n + 1] = 0.5 * sum / (n + 1);
  }
  return q;
}

// tan(theta), by t' = 1 + t^2.
Series plain_tangent(int degree, double centre) {
  Series t(degree + 1);
  t[0] = std::tan(centre);
  for (int n = 0; n < degree; ++n) {
    double sum = n == 0 ? 1 : 0;
    for (int i = 0; i <= n; ++i) sum += t[i] * t[n - i];
    t[n + 1] = sum / (n + 1);
  }
  return t;
}

// e^(-a (q - q_0)), by e' = -a q' e.
Series decay(const Series& q, double a) {
  Series e(q.size(), 0.0);
  e[0] = 1;
  for (std::size_t n = 1; n < q.size(); ++n) {
    double sum = 0;
    for (std::size_t j = 1; j <= n; ++j) sum += double(j) * q[j] * e[n - j];
    e[n] = -a * sum / double(n);
  }
  return e;
}

Series phase_series(const PhaseForm& phase, int degree, double centre) {
  const Series s = sine(degree, centre);
  Series p(degree + 1, 0.0);
  const auto lobe = [&](double alpha, double factor) {
    Series v = s;  // 1 - sin: twice (1 + c)/2
    for (double& x : v) x = -x;
    v[0] += 1;
    p = power(v, alpha);
    for (double& x : p) x *= phase.scale * factor / std::pow(2, alpha);
    p[0] += phase.scale;
  };
  switch (phase.kind) {
    case PhaseForm::Kind::isotropic:
      p[0] = 1;
      break;
    case PhaseForm::Kind::rayleigh:
      p = product(s, s);
      p[0] += 1;
      for (double& x : p) x *= 0.75;
      break;
    case PhaseForm::Kind::hazy:
      lobe(8, 9);
      break;
    case PhaseForm::Kind::murky:
      lobe(32, 50);
      break;
    case PhaseForm::Kind::henyey_greenstein: {
      Series v = s;
      for (double& x : v) x *= 2 * phase.g;
      v[0] += 1 + phase.g * phase.g;
      p = power(v, -1.5);
      for (double& x : p) x *= (1 - phase.g) * (1 + phase.g);
      break;
    }
  }
  return p;
}

}  // namespace

std::vector<double> taylor_coefficients(const PhaseForm& phase, double a, int degree, double centre) {
  return product(decay(tangent(degree, centre), a), phase_series(phase, degree, centre));
}

std::vector<double> bounded_coefficients(const PhaseForm& phase, double a, int degree, double centre) {
  return product(decay(plain_tangent(degree, centre), a), phase_series(phase, degree, centre));
}

std::vector<std::vector<double>> coefficients_in_a(const PhaseForm& phase, int degree, bool bounded) {
  const Series q = bounded ? plain_tangent(degree, 0) : tangent(degree, 0), p = phase_series(phase, degree, 0);
  // Rows are polynomials in a: exp(-a (q - q_0)), by the recurrence of decay().
  std::vector<Series> e(degree + 1, Series(degree + 1, 0.0)), c = e;
  e[0][0] = 1;
  for (int n = 1; n <= degree; ++n)
    for (int j = 1; j <= n; ++j)
      for (int k = 0; k < degree; ++k) e[n][k + 1] -= j * q[j] * e[n - j][k] / n;
  for (int n = 0; n <= degree; ++n)
    for (int i = 0; i <= n; ++i)
      for (int k = 0; k <= degree; ++k) c[n][k] += e[i][k] * p[n - i];
  return c;
}

std::vector<std::vector<double>> printed_in_a(const PhaseForm& phase) {
  switch (phase.kind) {
    case PhaseForm::Kind::isotropic:
      return {{1, 0, 0, 0, 0},
              {0, -1, 0, 0, 0},
              {0, -1, 1, 0, 0},
              {0, -1, 1.0 / 2 - 1.0 / 6, 0, 0},
              {0, -5.0 / 24, 11.0 / 24, -1.0 / 4, 1.0 / 24}};
    case PhaseForm::Kind::rayleigh:
      return {{0.75, 0, 0}, {0, -0.75, 0}, {0.75, 0, 0.375}};
    case PhaseForm::Kind::hazy:
      return {{265.0 / 256, 0, 0}, {9.0 / 36, -265.0 / 256, 0}, {63.0 / 64, -121.0 / 512, 265.0 / 256}};
    case PhaseForm::Kind::murky: {
      const double p = 2147483673.0 / 2147483648;
      return {{p, 0, 0}, {-25.0 / 367108864, p, 0}, {775.0 / 134217728, -2147482073.0 / 4294967296, p / 2}};
    }
    case PhaseForm::Kind::henyey_greenstein:
      break;
  }
  throw Error("the annex of Biri et al. 2006 prints no coefficients for Henyey-Greenstein");
}

std::vector<double> printed_coefficients(const PhaseForm& phase, double a) {
  std::vector<double> result;
  for (const Series& row : printed_in_a(phase)) {
    double sum = 0;
    for (auto c = row.rbegin(); c != row.rend(); ++c) sum = sum * a + *c;
    result.push_back(sum);
  }
  return result;
}

double integrate_polynomial(const std::vector<double>& c, double centre, double theta0, double theta1) {
  const double begin = theta0 - centre, end = theta1 - centre;
  double sum = 0, low = begin, high = end;
  for (std::size_t n = 0; n < c.size(); ++n) {
    sum += c[n] * (high - low) / double(n + 1);
    low *= begin;
    high *= end;
  }
  return sum;
}

double polynomial_airlight(const std::vector<double>& c, double centre, double extinction, double albedo,
                           double intensity, double T, double h, double theta0, double theta1) {
  // e^(-extinction T) apart from e^(-a q) would overflow behind the light.
  const double depth = extinction * (T + h * std::tan(0.25 * pi + 0.5 * centre));
  return albedo * extinction * intensity / (4 * pi * h) * std::exp(-depth) *
         integrate_polynomial(c, centre, theta0, theta1);
}

}  // namespace airlight::shadow_planes
