#include "methods/fogshop/homogeneous_airlight.h"

#include <algorithm>
#include <cmath>

#include "scene/math/exponential_integral.h"
#include "scene/math/types.h"

namespace airlight::fogshop {
namespace {

// Gauss-Legendre, 16 points on [0, 1]: distances of the nodes from the middle, and their weights.
constexpr double node[8] = {0.047506254918818720, 0.140801775389629460, 0.229008388828613690, 0.308938122201321870,
                            0.377702204177501520, 0.432815601193915900, 0.472287511536616280, 0.494700467495824970};
constexpr double weight[8] = {0.094725305227534260, 0.091301707522461790, 0.084578259697501270, 0.074797994408288370,
                              0.062314485627766936, 0.047579255841246394, 0.031126761969323946, 0.013576229705877047};

template <class Function>
double gauss16(Function f) {
  double sum = 0;
  for (int k = 0; k < 8; ++k) sum += weight[k] * (f(0.5 - node[k]) + f(0.5 + node[k]));
  return sum;
}

double imaginary_e1s(double re, double im) { return scene::scaled_exponential_integral({re, im}).imag(); }

// The integral over x in [xa, xa + length], measured from the closest approach, of exp(-beta (t + d)) / (x^2 + h^2),
// where t = along + x and d^2 = x^2 + distance^2. The nodes are equiangular about h, in a form that needs no angle of
// its own and so stays exact for h = 0. The length is its own argument because xb - xa has lost the digits of a short
// one.
double equiangular_gauss16(double xa, double length, double h, double along, double distance, double beta) {
  const double xb = xa + length;
  const double angle = std::atan2(h * length, h * h + xa * xb);
  const double measure = h > 0 ? angle / h : length / (xa * xb);
  return measure * gauss16([&](double s) {
           const double tau = h > 0 ? std::tan(s * angle) / h : s * length / (xa * xb);
           const double x = (xa + h * h * tau) / (1 - xa * tau);
           return std::exp(-beta * (along + x + std::hypot(x, distance)));
         });
}

// Towards the light 1/d^2 may grow by any factor: pieces, each with at most eightfold distance.
double approach_in_pieces(const LightFromRay& light, double d_vp, double beta) {
  double sum = 0;
  double xa = -light.along;
  for (double left = d_vp; left > 0;) {
    const double length = -xa > 8 * light.h ? std::min(left, -xa * 0.875) : left;
    sum += equiangular_gauss16(xa, length, light.h, light.along, light.h, beta);
    xa += length;
    left -= length;
  }
  return sum;
}

}  // namespace

double F(double u, double v) {
  if (v <= 0) return 0;
  if (u == 0) return v;
  const double tan_v = v < 1.5707963267948966 ? std::tan(v) : infinity;
  // Here the closed form is a small difference of two numbers of order 1.
  if (v < 0.5 && u * tan_v < 2) return v * gauss16([&](double s) { return std::exp(-u * std::tan(s * v)); });
  const double whole = imaginary_e1s(0, -u);
  const double rest = std::exp(-u * tan_v);
  return rest > 0 ? whole - rest * imaginary_e1s(u * tan_v, -u) : whole;
}

double homogeneous_airlight(const LightFromRay& light, double d_vp, double beta) {
  const auto [along, h] = light;
  if (!(beta > 0) || !(d_vp > 0)) return 0;
  const double d_sv = std::hypot(along, h);
  if (h == 0 && along >= 0 && along <= d_vp) return infinity;

  const double xa = -along, xb = d_vp - along, d_ps = std::hypot(h, xb);
  const double angle = std::isinf(d_vp) ? std::atan2(h, xa) : std::atan2(h * d_vp, h * h + xa * xb);
  if (angle < 0.5 && beta * (d_vp + d_ps - d_sv) < 2) {
    if (xb <= 0) return beta / (4 * pi) * approach_in_pieces(light, d_vp, beta);
    if (d_ps < 8 * d_sv) return beta / (4 * pi) * equiangular_gauss16(xa, d_vp, h, along, h, beta);
  }

  // L_a^h with F in closed form: the factors e^(-T_sv cos gamma) and e^z of the two ends combine into these two.
  const double height = std::max(h, 1e-120 * d_sv);  // the limit of an exactly aligned light behind the camera
  const double one_minus_cos = along > 0 ? height / d_sv * (height / (d_sv + along)) : (d_sv - along) / d_sv;
  double sum = std::exp(-beta * d_sv) * imaginary_e1s(beta * d_sv * one_minus_cos, -beta * height);
  const double end = std::exp(-beta * (d_vp + d_ps));
  if (end > 0) {
    const double re = xb < 0 ? beta * height * (height / (d_ps - xb)) : beta * (d_ps + xb);
    sum -= end * imaginary_e1s(re, -beta * height);
  }
  return std::max(0.0, beta / (2 * pi * height) * sum);
}

double homogeneous_airlight(double gamma, double d_sv, double d_vp, double beta) {
  return homogeneous_airlight({d_sv * std::cos(gamma), d_sv * std::sin(gamma)}, d_vp, beta);
}

double softened_homogeneous_airlight(const LightFromRay& light, double d_vp, double beta, double radius) {
  if (radius == 0) return homogeneous_airlight(light, d_vp, beta);
  if (!(beta > 0) || !(d_vp > 0)) return 0;
  const auto [along, h] = light;
  const double soft = std::hypot(h, radius);
  // From the closest approach outwards, in pieces that double; the exponent moves by less than 2 in each.
  const auto outwards = [&, along = along, h = h](double from, double length, double sign) {
    double sum = 0;
    for (double x = from, left = length; left > 0;) {
      const double step = std::min({left, std::max(soft, x) / 2, sign > 0 ? 1 / beta : infinity});
      const double piece = equiangular_gauss16(sign > 0 ? x : -x - step, step, soft, along, h, beta);
      sum += piece;
      if (sign > 0 && piece <= 1e-18 * sum) break;
      x += step;
      left -= step;
    }
    return sum;
  };
  const double split = std::clamp(along, 0.0, d_vp);
  const double before = outwards(std::max(0.0, along - d_vp), split, -1);
  const double after = outwards(std::max(0.0, -along), d_vp - split, +1);
  return beta / (4 * pi) * (before + after);
}

}  // namespace airlight::fogshop
