#include "methods/fogshop/map_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace airlight::fogshop {
namespace {

constexpr int around = 12;     // directions
constexpr int radii = 96;      // on each
constexpr int brightest = 24;  // Gaussians
constexpr int padding = GaussianArrays::padding;

class Probe {
 public:
  Probe(const GaussianArrays& g, const Point3& light, int directions, int edges, Erf erf)
      : g_(g), light_(light), grid_{frame_of(g, light), directions, edges}, erf_(erf) {
    distance_.resize((edges + 1 + padding - 1) / padding * padding);
    for (std::size_t k = 0; k < distance_.size(); ++k) distance_[k] = grid_.distance_of(std::min(int(k), edges));
  }

  // Depths at distances in a direction, in ascending order: exact, and by linear interpolation between texels and edges.
  struct Profile {
    std::vector<double> exact, mapped;
  };
  Profile along(const Vec3& direction, const std::vector<double>& at) {
    Profile p;
    p.exact = depths(direction, at);
    p.mapped.assign(at.size(), 0.0);
    const MapGrid::Place place = grid_.place(direction);
    if (!place.seen) return p;
    for (int corner = 0; corner < 4; ++corner) {
      const int di = corner & 1, dj = corner >> 1;
      const double share = (di ? place.fu : 1 - place.fu) * (dj ? place.fv : 1 - place.fv);
      const std::vector<double> texel = depths(grid_.direction(place.i + di - 1, place.j + dj - 1), distance_);
      for (std::size_t n = 0; n < at.size(); ++n) {
        if (!(at[n] > grid_.frame.near)) continue;
        const auto above = std::upper_bound(distance_.begin(), distance_.begin() + grid_.edges + 1, at[n]);
        const int k = std::clamp(int(above - distance_.begin()) - 1, 0, grid_.edges - 1);
        const double width = distance_[k + 1] - distance_[k];
        const double f = width > 0 ? std::min(1.0, (at[n] - distance_[k]) / width) : 0;
        p.mapped[n] += share * (texel[k] + f * (texel[k + 1] - texel[k]));
      }
    }
    return p;
  }

  const MapGrid& grid() const { return grid_; }
  double evaluations() const { return evaluations_; }

 private:
  std::vector<double> depths(const Vec3& direction, const std::vector<double>& at) {
    std::vector<double> t(at), depth((at.size() + padding - 1) / padding * padding);
    t.resize(depth.size(), at.back());
    cross(g_, {light_, direction, std::max(at.back(), grid_.frame.far)}, erf_, crossings_);
    depths_at(crossings_, t.data(), int(t.size()), depth.data(), erf_);
    evaluations_ += double(crossings_.count) * double(t.size() + 1);
    depth.resize(at.size());
    return depth;
  }

  const GaussianArrays& g_;
  Point3 light_;
  MapGrid grid_;
  Erf erf_;
  std::vector<double> distance_;  // of the edges
  Crossings crossings_;
  double evaluations_ = 0;
};

double factor_off(double exact, double mapped) { return std::abs(std::exp(std::min(exact - mapped, 50.0)) - 1); }

// Relative error of the power that the medium scatters, summed over stretches between neighbouring distances from the light.
double error_of_power(Probe& probe, double least_width) {
  const MapFrame& frame = probe.grid().frame;
  std::vector<double> at(2 * radii + 1);
  const double first = 0.05 * least_width;
  for (int k = 0; k <= 2 * radii; ++k) {
    const double s = k / (2.0 * radii);
    at[k] = frame.near > 0 || !(first < frame.far) ? frame.near + s * (frame.far - frame.near)
                                                   : first * std::pow(frame.far / first, s);
  }
  double power = 0, missed = 0;
  for (int n = 0; n < around; ++n) {
    // Even over the view, or over the sphere.
    const double u = (n + 0.5) / around, v = std::fmod((n + 0.5) * 0.6180339887498949, 1.0), angle = 2 * pi * v;
    const double z = 1 - 2 * u, r = std::sqrt(1 - z * z);
    const Vec3 direction =
        frame.tangent > 0
            ? Vec3((frame.axes.transpose() * Vec3(frame.tangent * (2 * u - 1), frame.tangent * (2 * v - 1), 1))
                       .normalized())
            : Vec3(r * std::cos(angle), r * std::sin(angle), z);
    const Probe::Profile p = probe.along(direction, at);
    double before = 0;
    for (int k = 1; k < 2 * radii; k += 2) {
      const double scattered = std::exp(-before) - std::exp(-p.exact[k + 1]);
      power += scattered;
      missed += scattered * factor_off(p.exact[k], p.mapped[k]);
      before = p.exact[k + 1];
    }
  }
  return power > 0 ? missed / power : 0;
}

// Relative L2 error of a picture of the Gaussians, each drawn as a spot of even radiance, as bright as its middle.
double error_of_picture(Probe& probe, const GaussianArrays& g, const Point3& light, const Point3& eye) {
  std::vector<double> weight(g.count);
  std::vector<int> order(g.count);
  std::iota(order.begin(), order.end(), 0);
  for (int i = 0; i < g.count; ++i) {
    const double squared = 1 / (g.a[i] * g.a[i]);
    const double radiance = std::min(1.0, 2 * g.half_depth[i]) / std::max((g.center(i) - light).squaredNorm(), squared);
    weight[i] = radiance * radiance * squared / std::max((g.center(i) - eye).squaredNorm(), squared);
  }
  const int count = std::min(brightest, g.count);
  std::partial_sort(order.begin(), order.begin() + count, order.end(),
                    [&](int a, int b) { return weight[a] > weight[b]; });
  double sum = 0, missed = 0;
  for (int n = 0; n < count; ++n) {
    const int i = order[n];
    const double width = 1 / g.a[i], distance = (g.center(i) - light).norm();
    const Vec3 direction = distance > 0 ? Vec3((g.center(i) - light) / distance) : Vec3(Vec3::UnitX());
    const std::vector<double> at{std::max(0.1 * width, distance - 0.7 * width), distance + 0.1 * width,
                                 distance + 0.7 * width};
    const Probe::Profile p = probe.along(direction, at);
    for (int k = 0; k < 3; ++k) {
      const double off = factor_off(p.exact[k], p.mapped[k]), light_left = std::exp(-2 * p.exact[k]) * weight[i];
      missed += light_left * off * off;
      sum += light_left;
    }
  }
  return sum > 0 ? std::sqrt(missed / sum) : 0;
}

}  // namespace

double map_error(const GaussianArrays& g, const Point3& light, const Point3& eye, int directions, int edges, Erf erf,
                 double& evaluations) {
  if (g.count == 0) return 0;
  Probe probe(g, light, directions, edges, erf);
  const double steepest = *std::max_element(g.a.begin(), g.a.begin() + g.count);
  const double error = std::max(error_of_power(probe, 1 / steepest), error_of_picture(probe, g, light, eye));
  evaluations += probe.evaluations();
  return error;
}

}  // namespace airlight::fogshop
