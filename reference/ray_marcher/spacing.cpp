#include "reference/ray_marcher/spacing.h"

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/depth.h"

namespace airlight::ray_marcher {
namespace {

// The map of the zone around a light: x / h = u / (1 - u^2)^3 from (-1, 1) onto the line, and its derivative.
double stretch(double u) { return u / std::pow(1 - u * u, 3); }
double stretch_slope(double u) { return (1 + 5 * u * u) / std::pow(1 - u * u, 4); }

// Its inverse.
double unstretch(double x) {
  double lo = 0, hi = 1;  // |u|; the map is monotone, so bisection guards every step
  double u = std::abs(x) < 1 ? 0.5 * std::abs(x) : 1 - 0.5 / std::cbrt(std::abs(x));
  for (int i = 0; i < 60; ++i) {
    const double error = stretch(u) - std::abs(x);
    (error > 0 ? hi : lo) = u;
    // Newton on the logarithm where the map is steep, on the map itself near 0.
    double next = std::abs(x) < 1 ? u - error / stretch_slope(u)
                                  : u - stretch(u) * std::log(stretch(u) / std::abs(x)) / stretch_slope(u);
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (std::abs(next - u) <= 1e-15) break;
    u = next;
  }
  return std::copysign(u, x);
}

// A part of the ray between two cuts, with a measure: the number of steps in it is proportional to that, and each step
// has the same share of it. The measure of a plain part is its length.
struct Part {
  double lo, hi;
  unsigned long long inside;
  double rate = 0;             // > 0: measure exp(-rate (t - lo) / 2) dt
  const Approach* light = {};  // set: measure proportional to du of the zone's map
  double u_lo = 0, u_hi = 0;   // its ends there
  double weight = 1;           // factor of the measure

  double measure() const {
    if (light) return weight * (u_hi - u_lo);
    if (rate > 0) return weight * (2 / rate) * -std::expm1(-0.5 * rate * (hi - lo));
    return weight * (hi - lo);
  }
  // The point below which lies the share s of the measure.
  double at(double s) const {
    if (light) return light->t + light->h * stretch((1 - s) * u_lo + s * u_hi);
    if (rate > 0) return lo - (2 / rate) * std::log1p(s * std::expm1(-0.5 * rate * (hi - lo)));
    return lo + s * (hi - lo);
  }
};

// Extinction of the constant media of a part, in the least extinct channel that sees any.
double constant_rate(const std::vector<Layer>& layers, unsigned long long inside) {
  Rgb sum = Rgb::Zero();
  for (std::size_t k = 0; k < layers.size(); ++k)
    if (in_constant(inside, k)) sum += layers[k].constant * layers[k].medium->sigma_t;
  double least = infinity;
  for (int c = 0; c < 3; ++c)
    if (sum[c] > 0) least = std::min(least, sum[c]);
  return least == infinity ? 0 : least;
}

// Light falls little on the way to a lamp, and steps may not grow there; not worth a change where a lamp is so near.
constexpr double deep_lamp = 4;

// Extinction of the constant media of a part, in the most extinct channel.
double greatest_rate(const std::vector<Layer>& layers, unsigned long long inside) {
  Rgb sum = Rgb::Zero();
  for (std::size_t k = 0; k < layers.size(); ++k)
    if (in_constant(inside, k)) sum += layers[k].constant * layers[k].medium->sigma_t;
  return sum.maxCoeff();
}

bool any_varies(const std::vector<Layer>& layers, unsigned long long inside) {
  for (std::size_t k = 0; k < layers.size(); ++k)
    if (in_varied(inside, k)) return true;
  return false;
}

// The ray between all cuts, without the parts that no medium touches.
void cut(const std::vector<Layer>& layers, const Ray& ray, double t_end, std::vector<Part>& parts) {
  static thread_local std::vector<Interval> extents;
  static thread_local std::vector<double> cuts;
  extents.clear();
  cuts.clear();
  parts.clear();
  for (const Layer& layer : layers) {
    extents.push_back(constant_extent(layer, ray, {0, t_end}));
    extents.push_back(varied_extent(layer, ray, {0, t_end}));
  }
  for (const Interval& e : extents)
    if (!e.empty()) cuts.insert(cuts.end(), {e.lo, e.hi});
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (!(cuts[i] < cuts[i + 1])) continue;
    unsigned long long inside = 0;
    for (std::size_t e = 0; e < extents.size(); ++e)
      if (extents[e].lo <= cuts[i] && extents[e].hi >= cuts[i + 1]) inside |= 1ull << e;
    if (inside) parts.push_back({cuts[i], cuts[i + 1], inside});
  }
}

// The endless part gets steps that grow from t on.
void grade_endless(std::vector<Part>& parts, double rate, double t) {
  Part tail = parts.back();
  if (t > tail.lo) {
    parts.back().hi = std::min(t, tail.hi);
    if (!(t < tail.hi)) return;
    tail.lo = t;
    parts.push_back(tail);
  }
  parts.back().rate = rate;
}

// At most as many steps for the constant parts as for the varying ones: a vast thin fog must not starve a small cloud.
void limit_constant(const std::vector<Layer>& layers, std::vector<Part>& parts) {
  double varied = 0, constant = 0;
  for (const Part& p : parts) (any_varies(layers, p.inside) ? varied : constant) += p.measure();
  if (varied > 0 && constant > varied)
    for (Part& p : parts)
      if (!any_varies(layers, p.inside)) p.weight = varied / constant;
}

// Splits the parts at the zone around the light. Its radius makes the zone's measure about that of the rest, when steps
// have one length on both sides of its ends. False if there is no zone on this ray.
bool grade_light(std::vector<Part>& parts, const Approach& light) {
  double length = 0;
  for (const Part& p : parts) length += p.measure();
  const double radius = std::pow(length / 12, 0.75) * std::pow(light.h, 0.25);
  if (!(radius > light.h)) return false;
  bool met = false;
  std::vector<Part> split;
  for (const Part& p : parts) {
    const double lo = std::clamp(light.t - radius, p.lo, p.hi), hi = std::clamp(light.t + radius, p.lo, p.hi);
    if (!(lo < hi)) {
      split.push_back(p);
      continue;
    }
    met = true;
    const auto piece = [&](double a, double b) {
      Part q = p;
      q.lo = a, q.hi = b;
      // A growing part goes on where it was.
      if (p.rate > 0) q.weight *= std::exp(-0.5 * p.rate * (a - p.lo));
      return q;
    };
    if (p.lo < lo) split.push_back(piece(p.lo, lo));
    Part zone = piece(lo, hi);
    zone.rate = 0;
    zone.light = &light;
    zone.u_lo = unstretch((lo - light.t) / light.h);
    zone.u_hi = unstretch((hi - light.t) / light.h);
    zone.weight = light.h * stretch_slope(unstretch(radius / light.h));
    split.push_back(zone);
    if (hi < p.hi) split.push_back(piece(hi, p.hi));
  }
  parts = std::move(split);
  return met;
}

// A ray through a grid's map of free space, in steps.
struct Walk {
  const GridField* grid;
  double x[3], dx[3];   // local midpoint of step 0, and from one to the next
  double per_cell[3];   // steps per cell along each axis, signed; infinite across the ray
  double per_distance;  // steps per cell of the largest component

  Walk(const GridField& field, const Point3& start, const Vec3& step) : grid(&field) {
    const Point3 local = field.frame.point(start);
    const Vec3 delta = field.frame.vector(step);
    for (int a = 0; a < 3; ++a) x[a] = local[a] + 0.5 * delta[a], dx[a] = delta[a], per_cell[a] = 1 / delta[a];
    per_distance = 1 / delta.cwiseAbs().maxCoeff();
  }

  // From step i on, how many steps lie in free space; negative: how many may not.
  double run(double i) const {
    const double p[3] = {x[0] + i * dx[0], x[1] + i * dx[1], x[2] + i * dx[2]};
    const double free = grid->free_at(p[0], p[1], p[2]);
    if (free >= 0) return 1 + int(std::min(free * per_distance, 1e9));
    // To the nearest face of the brick that lies ahead; a step too many or too few changes no result.
    constexpr int shift = GridField::brick_shift;
    double steps = 1e9;
    for (int a = 0; a < 3; ++a) {
      if (dx[a] == 0) continue;
      const double face = double(((int(p[a]) >> shift) + (dx[a] > 0)) << shift);
      steps = std::min(steps, (face - p[a]) * per_cell[a]);
    }
    return -1 - int(steps);
  }
};

// Equal steps through a part, less those in the free space of its grids if it has nothing but grids.
void step_evenly(const std::vector<Layer>& layers, const Options& options, const Ray& ray, const Part& part, int n,
                 std::vector<Step>& steps) {
  const double h = (part.hi - part.lo) / n;
  static thread_local std::vector<Walk> walks;
  walks.clear();
  // Where steps may be divided (depth.h), one whose middle is empty may end in what is not.
  bool skip = options.skip_empty && !may_be_deep(layers, options, {0.5 * (part.lo + part.hi), h, part.inside});
  for (std::size_t k = 0; skip && k < layers.size(); ++k) {
    skip = !in_constant(part.inside, k) && !(in_varied(part.inside, k) && !layers[k].grid);
    if (skip && in_varied(part.inside, k)) walks.emplace_back(*layers[k].grid, ray.at(part.lo), h * ray.direction);
  }
  for (int i = 0; i < n;) {
    double free = infinity, taken = skip ? 0 : n;
    for (const Walk& walk : walks) {
      if (!skip) break;
      const double run = walk.run(i);
      if (run < 0)
        taken = std::max(taken, -run);
      else
        free = std::min(free, run);
    }
    if (taken > 0) {
      const int end = int(std::min(i + taken, double(n)));
      for (; i < end; ++i) steps.push_back({part.lo + (i + 0.5) * h, h, part.inside});
    } else {
      i += int(std::min(free, double(n)));
    }
  }
}

}  // namespace

Approach approach(const Ray& ray, const Point3& light) {
  const Vec3 to_light = light - ray.origin;
  const double t = to_light.dot(ray.direction);
  return {t, (to_light - t * ray.direction).norm()};
}

double mean_inverse_square(const Approach& light, const Step& step) {
  // A ray through the light itself has no finite airlight; this keeps it finite, and the rest of the picture alive.
  const double h = std::max(light.h, 1e-12 * step.length);
  const double x = step.t - light.t, half = 0.5 * step.length;
  return std::atan2(h * step.length, h * h + (x - half) * (x + half)) / (h * step.length);
}

double beyond_lamp(const Approach& lamp, double from, double longer) {
  const double along = lamp.t - from, d = std::hypot(along, lamp.h);
  const double turn = along > 0 ? lamp.h * lamp.h / (d + along) : d - along;  // d - along
  return 0.5 * longer * (2 * d + longer) / (turn + longer);
}

Spacing make_spacing(const std::vector<Layer>& layers, const Options& options, const Ray& ray, double t_end,
                     std::span<const Approach> lamps, const std::optional<Approach>& light, std::vector<Step>& steps) {
  Spacing spacing;
  spacing.begin = spacing.end = steps.size();
  static thread_local std::vector<Part> parts;
  cut(layers, ray, t_end, parts);
  if (parts.empty()) return spacing;
  if (Part& last = parts.back(); last.hi == infinity) {
    for (std::size_t k = 0; k < layers.size(); ++k)
      if (in_constant(last.inside, k)) spacing.endless = spacing.endless || layers[k].medium->sigma_t > 0;
    const double rate = constant_rate(layers, last.inside);
    double length = options.horizon / rate;
    const double most = greatest_rate(layers, last.inside);
    double growing = light ? light->t : last.lo;
    for (const Approach& lamp : lamps) {
      if (rate * (lamp.t - last.lo) > deep_lamp) growing = std::max(growing, lamp.t);
      length = std::max(length, beyond_lamp(lamp, last.lo, options.horizon / rate));
      spacing.deepest = std::max(spacing.deepest, Spacing().deepest + most * std::hypot(lamp.t - last.lo, lamp.h));
    }
    spacing.deepest = std::min(spacing.deepest, 110.0);
    last.hi = last.lo + length;
    if (options.graded) grade_endless(parts, rate, growing);
  }
  if (options.graded) {
    limit_constant(layers, parts);
    if (light && light->h > 0) spacing.around_light = grade_light(parts, *light);
  }
  double total = 0;
  for (const Part& p : parts) total += p.measure();
  for (const Part& p : parts) {
    const double share = p.measure();
    const int n = options.step > 0 ? steps_through({0, share}, 0, options.step)
                                   : std::max(1, int(std::lround(options.steps * (share / total))));
    if (!p.light && p.rate == 0) {
      step_evenly(layers, options, ray, p, n, steps);
      continue;
    }
    double from = p.lo;
    for (int i = 1; i <= n; ++i) {
      const double to = i == n ? p.hi : p.at(double(i) / n);
      if (to > from) steps.push_back({0.5 * (from + to), to - from, p.inside});
      from = std::max(from, to);
    }
  }
  spacing.end = steps.size();
  return spacing;
}

}  // namespace airlight::ray_marcher
