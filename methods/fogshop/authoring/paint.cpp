#include "methods/fogshop/authoring/paint.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "methods/fogshop/authoring/draws.h"
#include "scene/base/error.h"

namespace airlight::fogshop::authoring {

std::vector<StrokePoint> resample(const std::vector<Point3>& stroke, double spacing) {
  std::vector<double> arc = {0};  // length up to each point
  for (std::size_t i = 0; i + 1 < stroke.size(); ++i) arc.push_back(arc.back() + (stroke[i + 1] - stroke[i]).norm());
  if (!std::isfinite(arc.back())) throw Error("stroke has no finite length");
  if (arc.back() == 0) return {{stroke.front(), Vec3::Zero()}};
  const double last = std::floor(arc.back() / spacing);
  if (!(last < double(GaussianList::greatest)))
    throw Error(fmt::format("stroke of {:g} m at a spacing of {:g} m has more than {} points", arc.back(), spacing,
                            GaussianList::greatest));
  std::vector<StrokePoint> points;
  std::size_t edge = 0;
  for (int j = 0; j <= int(last); ++j) {
    const double s = j * spacing;  // not a running sum, whose rounding would grow
    while (edge + 2 < stroke.size() && (s >= arc[edge + 1] || arc[edge + 1] == arc[edge])) ++edge;
    // Points that the pen set twice at the end have no direction of their own.
    while (edge > 0 && arc[edge + 1] == arc[edge]) --edge;
    const Vec3 tangent = (stroke[edge + 1] - stroke[edge]).normalized();
    points.push_back({stroke[edge] + (s - arc[edge]) * tangent, tangent});
  }
  return points;
}

std::vector<Id> paint(GaussianList& list, const Paint& op) {
  const auto points = resample(op.stroke, op.spacing.value_or(0.75 / op.brush.a));
  const double jitter = op.jitter.value_or(1 / op.brush.a);
  std::vector<Id> ids;
  for (std::size_t j = 0; j < points.size(); ++j) {
    Gaussian gaussian = op.brush;
    gaussian.b = points[j].position;
    const Vec3& tangent = points[j].tangent;
    if (jitter > 0 && !tangent.isZero(0)) {
      const Vec3 side = tangent.unitOrthogonal();
      const Eigen::Vector2d offset = jitter * Draws(op.seed, std::uint32_t(j)).disc();
      gaussian.b += offset[0] * side + offset[1] * tangent.cross(side);
    }
    ids.push_back(list.add(gaussian));
  }
  return ids;
}

}  // namespace airlight::fogshop::authoring
