#include "experiments/judging/flip.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace airlight::experiments {
namespace {

using Plane = Eigen::ArrayXXd;         // [height, width]
using Picture = std::array<Plane, 3>;  // in some space of colours
using Taps = Eigen::ArrayXd;           // of a filter along one axis, of odd length

// The tone curve (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5) of 2021, whose authors call it ACES.
constexpr double k0 = 0.36 * 2.51, k1 = 0.6 * 0.03, k3 = 0.36 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

double toned(double x) { return std::clamp((k0 * x * x + k1 * x) / (k3 * x * x + k4 * x + k5), 0.0, 1.0); }

// The x at which the curve reaches t.
double untoned(double t) {
  const double half = 0.5 * (k1 - k4 * t) / (k0 - k3 * t), c = -k5 * t / (k0 - k3 * t);
  return std::sqrt(half * half - c) - half;
}

Picture tone_mapped(std::span<const float> rgb, int width, int height, double exposure) {
  Picture out;
  const double scale = std::exp2(exposure);
  for (int c = 0; c < 3; ++c) {
    out[std::size_t(c)].resize(height, width);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        out[std::size_t(c)](y, x) = toned(scale * std::max(0.0F, rgb[(std::size_t(y) * width + x) * 3 + c]));
  }
  return out;
}

// Linear sRGB to XYZ over that of white (D65), and back.
const Eigen::Matrix3d& to_xyz() {
  static const Eigen::Matrix3d m = [] {
    Eigen::Matrix3d rgb;
    rgb << 10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,  //
        2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,       //
        1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382;
    const Eigen::Vector3d white = rgb * Eigen::Vector3d::Ones();
    return Eigen::Matrix3d(white.cwiseInverse().asDiagonal() * rgb);
  }();
  return m;
}

Picture times(const Eigen::Matrix3d& m, const Picture& p) {
  Picture out;
  for (int i = 0; i < 3; ++i) out[std::size_t(i)] = m(i, 0) * p[0] + m(i, 1) * p[1] + m(i, 2) * p[2];
  return out;
}

// Lightness, red-green and blue-yellow of XYZ: linear (YCxCz), or after the curve of L*a*b*.
Picture opponent(const Picture& xyz) { return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])}; }

Picture from_opponent(const Picture& p) {
  const Plane y = (p[0] + 16) / 116;
  return {y + p[1] / 500, y, y - p[2] / 200};
}

// L*a*b* of linear RGB, whose colours fade in the dark (Hunt): 2020, equation 4.
Picture hunt_lab(const Picture& rgb) {
  Picture xyz = times(to_xyz(), rgb);
  constexpr double d = 6.0 / 29;
  for (Plane& p : xyz)
    p = p.unaryExpr([](double t) { return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29; });
  Picture lab = opponent(xyz);
  lab[1] *= 0.01 * lab[0];
  lab[2] *= 0.01 * lab[0];
  return lab;
}

// HyAB, equation 5, to the power 0.7.
Plane color_distance(const Picture& a, const Picture& b) {
  return ((a[0] - b[0]).abs() + ((a[1] - b[1]).square() + (a[2] - b[2]).square()).sqrt()).pow(0.7);
}

// Pixels beyond the border are those at it.
Plane filtered(const Plane& in, const Taps& along_x, const Taps& along_y) {
  const Eigen::Index h = in.rows(), w = in.cols(), rx = along_x.size() / 2, ry = along_y.size() / 2;
  Plane rows = Plane::Zero(h, w), out = Plane::Zero(h, w);
  for (Eigen::Index k = -rx; k <= rx; ++k)
    for (Eigen::Index x = 0; x < w; ++x)
      rows.col(x) += along_x(k + rx) * in.col(std::clamp<Eigen::Index>(x + k, 0, w - 1));
  for (Eigen::Index k = -ry; k <= ry; ++k)
    for (Eigen::Index y = 0; y < h; ++y)
      out.row(y) += along_y(k + ry) * rows.row(std::clamp<Eigen::Index>(y + k, 0, h - 1));
  return out;
}

Taps gaussian(Eigen::Index radius, double variance) {
  const Taps x = Taps::LinSpaced(2 * radius + 1, -double(radius), double(radius));
  return (-x.square() / (2 * variance)).exp();
}

// Filters each of the three channels by the eye's resolution (contrast sensitivity, 2020, equation 1 and
// table 1); returns linear RGB.
Picture seen(const Picture& yxz, double ppd) {
  struct Lobe {
    double a, b;
  };
  static const std::array<std::vector<Lobe>, 3> lobes = {std::vector<Lobe>{{1, 0.0047}}, std::vector<Lobe>{{1, 0.0053}},
                                                         std::vector<Lobe>{{34.1, 0.04}, {13.5, 0.025}}};
  constexpr double pi = std::numbers::pi;
  const auto radius = Eigen::Index(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
  Picture out;
  for (std::size_t c = 0; c < 3; ++c) {
    double total = 0;
    out[c] = Plane::Zero(yxz[c].rows(), yxz[c].cols());
    for (const Lobe& lobe : lobes[c]) {
      const Taps taps = gaussian(radius, lobe.b * ppd * ppd / (2 * pi * pi));
      const double weight = lobe.a * std::sqrt(pi / lobe.b);
      out[c] += weight * filtered(yxz[c], taps, taps);
      total += weight * taps.sum() * taps.sum();
    }
    out[c] /= total;
  }
  Picture rgb = times(to_xyz().inverse(), from_opponent(out));
  for (Plane& p : rgb) p = p.cwiseMax(0).cwiseMin(1);
  return rgb;
}

// Sizes of edges and of points in the lightness: filters by the first and second derivative of a Gaussian (2020, section 4.2), whose
// positive and negative weights sum to 1 each.
struct Features {
  Plane edges, points;
};

Features features(const Plane& lightness, double ppd) {
  const double sd = 0.5 * 0.082 * ppd;
  const auto radius = Eigen::Index(std::ceil(3 * sd));
  const Taps x = Taps::LinSpaced(2 * radius + 1, -double(radius), double(radius)), g = gaussian(radius, sd * sd);
  const Taps across = g / g.sum();
  const auto size = [&](const Taps& derivative) {
    const double up = derivative.cwiseMax(0).sum(), down = -derivative.cwiseMin(0).sum();
    const Taps taps = (derivative > 0).select(derivative / up, derivative / down);
    return Plane((filtered(lightness, taps, across).square() + filtered(lightness, across, taps).square()).sqrt());
  };
  return {size(-x * g), size((x.square() / (sd * sd) - 1) * g)};
}

// Values of one picture at one exposure that are compared.
struct Seen {
  Picture color;
  Features features;
};

Seen look(std::span<const float> rgb, int width, int height, double exposure, double ppd) {
  const Picture yxz = opponent(times(to_xyz(), tone_mapped(rgb, width, height, exposure)));
  return {hunt_lab(seen(yxz, ppd)), features((yxz[0] + 16) / 116, ppd)};
}

Picture one_pixel(double r, double g, double b) {
  return {Plane::Constant(1, 1, r), Plane::Constant(1, 1, g), Plane::Constant(1, 1, b)};
}

Plane difference(const Seen& a, const Seen& b) {
  // Equation 6: the distances of 0.4 of the greatest there is, that of green and blue, fill 0 to 0.95.
  static const double greatest = color_distance(hunt_lab(one_pixel(0, 1, 0)), hunt_lab(one_pixel(0, 0, 1)))(0, 0);
  constexpr double most = 0.95;
  const double knee = 0.4 * greatest;
  const Plane color = color_distance(a.color, b.color).unaryExpr([&](double d) {
    return d < knee ? most / knee * d : most + (1 - most) * (d - knee) / (greatest - knee);
  });
  const Plane feature =
      (a.features.edges - b.features.edges).abs().cwiseMax((a.features.points - b.features.points).abs());
  const Plane power = 1 - (feature / std::numbers::sqrt2).sqrt();
  return color.pow(power);  // equation 9
}

}  // namespace

std::vector<double> flip_exposures(std::span<const float> reference) {
  std::vector<double> lit;
  for (std::size_t i = 0; i + 2 < reference.size(); i += 3) {
    const double y = 0.2126 * reference[i] + 0.7152 * reference[i + 1] + 0.0722 * reference[i + 2];
    lit.push_back(y);
  }
  std::sort(lit.begin(), lit.end());
  if (lit.empty() || !(lit.back() > 0)) return {};
  if (!(lit[lit.size() / 2] > 0)) lit.erase(lit.begin(), std::upper_bound(lit.begin(), lit.end(), 0.0));
  const double start = std::log2(untoned(0.85) / lit.back()), stop = std::log2(untoned(0.85) / lit[lit.size() / 2]);
  const int count = std::max(2, int(std::ceil(stop - start)));
  std::vector<double> all;
  for (int i = 0; i < count; ++i) all.push_back(start + i * (stop - start) / (count - 1));
  return all;
}

std::vector<double> flip_map(std::span<const float> image, std::span<const float> reference, int width, int height,
                             const FlipView& view) {
  Plane worst = Plane::Zero(height, width);
  for (const double exposure : flip_exposures(reference))
    worst = worst.cwiseMax(difference(look(image, width, height, exposure, view.pixels_per_degree),
                                      look(reference, width, height, exposure, view.pixels_per_degree)));
  std::vector<double> map;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) map.push_back(worst(y, x));
  return map;
}

double flip(std::span<const float> image, std::span<const float> reference, int width, int height) {
  const std::vector<double> map = flip_map(image, reference, width, height);
  double sum = 0;
  for (const double d : map) sum += d;
  return map.empty() ? 0 : sum / double(map.size());
}

}  // namespace airlight::experiments
