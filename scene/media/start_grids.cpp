#include "scene/media/start_grids.h"

#include <algorithm>
#include <cmath>

namespace airlight::scene {

double start_value(const VoxelGrid& grid, const Point3& x) {
  const Point3 at = world_to_sample(grid, x);
  int low[3];
  double share[3];
  for (int a = 0; a < 3; ++a) {
    if (!(at[a] >= -0.5 - 1e-6 && at[a] <= grid.size[a] - 0.5 + 1e-6)) return 0;
    const double nearest = std::round(at[a]);
    const double place = std::clamp(std::abs(at[a] - nearest) < 1e-6 ? nearest : at[a], 0.0, grid.size[a] - 1.0);
    low[a] = int(place);
    share[a] = place - low[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int at_corner[3];
    for (int a = 0; a < 3; ++a) {
      const int after = corner >> a & 1;
      weight *= after ? share[a] : 1 - share[a];
      at_corner[a] = low[a] + after;
    }
    if (weight != 0) sum += weight * double(grid.at(at_corner[0], at_corner[1], at_corner[2]));
  }
  return sum;
}

}  // namespace airlight::scene
