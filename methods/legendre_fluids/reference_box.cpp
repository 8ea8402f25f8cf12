#include "methods/legendre_fluids/reference_box.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/base/error.h"

namespace airlight::legendre_fluids {

using scene::FlowProblem;

ReferenceBox::ReferenceBox(const FlowProblem& p)
    : half(0.5 * p.box.size()), center(0.5 * (p.box.lo + p.box.hi)), dimensions(p.dimensions) {
  if (dimensions == 2) half[2] = 1;
}

Vec3 ReferenceBox::inside(const Point3& x) const {
  Vec3 result = (x - center).cwiseQuotient(half).cwiseMax(-1).cwiseMin(1);
  if (dimensions == 2) result[2] = 0;
  return result;
}

bool carries_density(const FlowProblem& p) {
  bool any = p.density != 0 || p.wave || p.density_grid;
  for (const auto& b : p.blobs) any |= b.density != 0;
  for (const auto& s : p.sources) any |= s.density_rate != 0;
  for (const auto& axis : p.sides)
    for (const auto& side : axis) any |= side.density != 0;
  return any;
}

bool carries_temperature(const FlowProblem& p) {
  bool any = p.temperature != 0 || p.temperature_grid;
  for (const auto& b : p.blobs) any |= b.temperature != 0;
  for (const auto& s : p.sources) any |= s.temperature_rate != 0;
  for (const auto& axis : p.sides)
    for (const auto& side : axis) any |= side.temperature != 0;
  return any;
}

Array region_coefficients(const FlowProblem& p, const ConfinedSpace& space, const ReferenceBox& box,
                          const scene::Region& region, const std::string& what) {
  Array c = space.scalar_from_function(
      [&](const Vec3& x) { return scene::contains(region, box.outside(x)) ? 1.0 : 0.0; }, 4 * space.n() + 32);
  if (!(c[0] > 0))
    throw Error(fmt::format("{}: the region of {} holds none of {} points along each axis, expected a larger one",
                            p.file, what, 4 * space.n() + 32));
  const TensorShape s = space.shape();
  const auto lanczos = [&](int k) {
    const double x = pi * k / space.n();
    return k == 0 ? 1 : std::sin(x) / x;
  };
  int at = 0;
  for (int i = 0; i < s[0]; ++i)
    for (int j = 0; j < s[1]; ++j)
      for (int k = 0; k < s[2]; ++k) c[at++] *= lanczos(i) * lanczos(j) * lanczos(k);
  return c;
}

}  // namespace airlight::legendre_fluids
