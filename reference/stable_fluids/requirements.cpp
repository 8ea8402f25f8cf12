#include "reference/stable_fluids/requirements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/base/limits.h"

namespace airlight::stable_fluids {
namespace {

// Whether a sample of a field on the faces of an axis, or at centres, lies in the region.
bool has_sample(const scene::Region& region, const Lattice& l, int axis) {
  const Box part = intersect(scene::bounding_box(region), {l.low, l.low + l.h * Vec3(l.n[0], l.n[1], l.n[2])});
  if (part.empty()) return false;
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = std::max(0, int((part.lo[a] - l.low[a]) / l.h) - 1);
    last[a] = std::min(l.n[a] - (a != axis), int((part.hi[a] - l.low[a]) / l.h) + 1);
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) {
        const Vec3 cells(i + (axis == 0 ? 0 : 0.5), j + (axis == 1 ? 0 : 0.5), k + (axis == 2 ? 0 : 0.5));
        if (scene::contains(region, l.low + l.h * cells)) return true;
      }
  return false;
}

bool has_face(const scene::Region& region, const Lattice& l) {
  for (int a = 0; a < l.dimensions; ++a)
    if (has_sample(region, l, a)) return true;
  return false;
}

[[noreturn]] void without_effect(const char* what, std::size_t which, const Lattice& l) {
  throw Error(fmt::format("{} {}: its region holds no sample of cells of {:.4g} m, expected a larger one or more cells",
                          what, which, l.h));
}

}  // namespace

void require_samples(const scene::FlowProblem& problem, const Lattice& l) {
  for (std::size_t i = 0; i < problem.sources.size(); ++i) {
    const scene::Source& s = problem.sources[i];
    const bool carried = s.density || s.temperature || s.density_rate != 0 || s.temperature_rate != 0;
    if ((carried && !has_sample(s.region, l, at_centers)) || (s.velocity && !has_face(s.region, l)))
      without_effect("source", i, l);
  }
  for (std::size_t i = 0; i < problem.pushes.size(); ++i)
    if (!has_face(problem.pushes[i].region, l)) without_effect("force", i, l);
}

void require_memory(const Lattice& l, std::size_t bytes_of_number) {
  // Measured: 130 bytes a cell, of a plume of 96^3 cells in double precision and of the frame that is written.
  const double bytes = 5 * l.dimensions * double(bytes_of_number) * double(count_of(l.n));
  scene::require_memory(bytes, fmt::format("{} x {} x {} cells", l.n[0], l.n[1], l.n[2]));
}

}  // namespace airlight::stable_fluids
