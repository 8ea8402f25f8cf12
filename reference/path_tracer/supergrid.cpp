#include "reference/path_tracer/supergrid.h"

#include <cmath>

namespace airlight::path_tracer {

float round_up(double x) {
  const float f = float(x);
  return double(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

Box Supergrid::widened_cell(int i, int j, int k) const {
  const Box all = box();
  const Vec3 slack = 1e-12 * (all.lo.cwiseAbs().cwiseMax(all.hi.cwiseAbs()));
  const Point3 corner = lo + cell.cwiseProduct(Vec3(i, j, k));
  return {corner - slack, corner + cell + slack};
}

Supergrid make_supergrid(const Box& box, const Eigen::Vector3i& cells, double scale,
                         const std::function<double(const Box&)>& bound) {
  Supergrid grid;
  grid.lo = box.lo;
  grid.size = cells;
  grid.cell = box.size().cwiseQuotient(cells.cast<double>());
  grid.majorants.resize(std::size_t(cells[0]) * cells[1] * cells[2]);
  std::size_t index = 0;
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) grid.majorants[index++] = round_up(scale * bound(grid.widened_cell(i, j, k)));
  return grid;
}

}  // namespace airlight::path_tracer
