#include "reference/deterministic/gaussian_table.h"

#include <algorithm>
#include <cmath>

namespace airlight::deterministic {

std::optional<GaussianTable> make_gaussian_table(const scene::GaussianSum& sum) {
  GaussianTable table;
  table.constant = sum.constant;
  table.cutoff = sum.cutoff;
  for (const scene::Gaussian& g : sum.gaussians) {
    if (g.amplitude < 0) return std::nullopt;
    if (g.amplitude == 0) continue;
    const double scaled = 0.5 * std::sqrt(pi) * g.width * g.amplitude;
    table.x.push_back(g.center[0]);
    table.y.push_back(g.center[1]);
    table.z.push_back(g.center[2]);
    table.inverse_width.push_back(1 / g.width);
    table.amplitude.push_back(g.amplitude);
    table.scaled_amplitude.push_back(scaled);
    table.log_scaled.push_back(std::log(scaled));
  }
  return table;
}

double erf_difference(double u, double v) {
  if (!(u < v)) return 0;
  if (u > 0) return std::erfc(u) - std::erfc(v);
  if (v < 0) return std::erfc(-v) - std::erfc(-u);
  return std::erf(v) - std::erf(u);
}

double density_integral(const GaussianTable& table, const Ray& ray, Interval t, double skip) {
  if (t.empty()) return 0;
  const double log_skip = std::log(std::max(0.5 * skip, 1e-300));
  const double ox = ray.origin[0], oy = ray.origin[1], oz = ray.origin[2];
  const double rx = ray.direction[0], ry = ray.direction[1], rz = ray.direction[2];
  double sum = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double qx = table.x[i] - ox, qy = table.y[i] - oy, qz = table.z[i] - oz;
    const double along = qx * rx + qy * ry + qz * rz;
    const double px = qx - along * rx, py = qy - along * ry, pz = qz - along * rz;
    const double a = table.inverse_width[i];
    const double squared = a * a * (px * px + py * py + pz * pz);
    if (squared > table.log_scaled[i] - log_skip) continue;
    double u = a * (t.lo - along), v = a * (t.hi - along);
    if (table.cutoff < infinity) {
      const double rest = table.cutoff * table.cutoff - squared;
      if (rest <= 0) continue;
      u = std::max(u, -std::sqrt(rest));
      v = std::min(v, std::sqrt(rest));
    }
    // The tail beyond 6.2 widths holds less than 1e-17 of the integral.
    if (u > 6.2 || v < -6.2) {
      if (table.scaled_amplitude[i] * 1e-17 < skip) continue;
    }
    sum += table.scaled_amplitude[i] * std::exp(-squared) * erf_difference(u, v);
  }
  return sum + (table.constant > 0 ? table.constant * t.length() : 0);
}

}  // namespace airlight::deterministic
