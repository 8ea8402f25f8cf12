#include "reference/ray_marcher/depth.h"

#include <algorithm>
#include <cmath>

namespace airlight::ray_marcher {
namespace {

// Front to back through the halves of a step.
struct Division {
  const Plan& plan;
  const Ray& ray;
  double deepest;
  std::vector<Step>& out;
  Rgb before = Rgb::Zero();

  void divide(const Step& step, const Rgb& at_lo, const Rgb& at_hi, int level) {
    const Rgb middle = extinction_at(plan, ray, step.t, step.inside);
    if (level < most_halvings &&
        is_deep(plan.options, deepest, before, at_lo.max(middle).max(at_hi), step.length, level == 0)) {
      const double half = 0.5 * step.length;
      divide({step.t - 0.5 * half, half, step.inside}, at_lo, middle, level + 1);
      divide({step.t + 0.5 * half, half, step.inside}, middle, at_hi, level + 1);
      return;
    }
    out.push_back(step);
    before += middle * step.length;
  }
};

}  // namespace

bool may_be_deep(const std::vector<Layer>& layers, const Options& options, const Step& step) {
  Rgb most = Rgb::Zero();
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const Layer& layer = layers[k];
    if (in_constant(step.inside, k)) most += layer.constant * layer.medium->sigma_t;
    if (in_varied(step.inside, k)) most += layer.most_varied * layer.medium->sigma_t;
  }
  return is_deep(options, infinity, Rgb::Zero(), most, step.length, true);
}

Rgb extinction_at(const Plan& plan, const Ray& ray, double t, unsigned long long inside) {
  Rgb sum = Rgb::Zero();
  for (std::size_t k = 0; k < plan.layers.size(); ++k) {
    const Layer& layer = plan.layers[k];
    double density = in_constant(inside, k) ? layer.constant : 0;
    if (in_varied(inside, k)) density += varied_density(layer, ray.at(t));
    sum += density * layer.medium->sigma_t;
  }
  return sum;
}

bool is_deep(const Options& options, double deepest, const Rgb& before, const Rgb& greatest, double length,
             bool whole) {
  const Rgb depth = greatest * length;
  return (before < deepest && depth > (whole ? most_whole : 1) * deepest_step(options)).any();
}

void follow_depth(const Plan& plan, const Ray& ray, double deepest, const Step* begin, const Step* end,
                  std::vector<Step>& out) {
  Division division{plan, ray, deepest, out};
  for (const Step* step = begin; step != end; ++step) {
    const double lo = step->t - 0.5 * step->length, hi = step->t + 0.5 * step->length;
    division.divide(*step, extinction_at(plan, ray, lo, step->inside), extinction_at(plan, ray, hi, step->inside), 0);
  }
}

double deep_column(const Layer& layer, const Options& options, const Ray& ray, Interval extent, int count,
                   long long& steps) {
  const double whole = extent.length() / count, limit = deepest_shadow_step(options), extinction = layer.thickest;
  double column = 0;
  const auto density_at = [&](double t) { return varied_density(layer, ray.at(t)); };
  double first = density_at(extent.lo);
  // [from, from + width] of a step, in shares of it: dyadic, so exact. Densities are looked up once where steps share a place.
  for (int i = 0; i < count && column * extinction < 750; ++i) {
    double last = density_at(extent.lo + (i + 1) * whole);
    for (double from = 0, width = 1; from < 1;) {
      const double lo = extent.lo + (i + from) * whole, h = width * whole;
      const double middle = density_at(lo + 0.5 * h);
      if (column * extinction < deepest_shaded && width > std::ldexp(1.0, -most_halvings) &&
          std::max({first, middle, last}) * extinction * h > limit) {
        width *= 0.5;
        last = middle;
        continue;
      }
      column += (first + 4 * middle + last) / 6 * h;
      ++steps;
      from += width;
      first = last;
      while (from < 1 && std::fmod(from, 2 * width) == 0) width *= 2;
      if (from < 1) last = density_at(extent.lo + (i + from + width) * whole);
    }
  }
  return column;
}

}  // namespace airlight::ray_marcher
