#include "gpu/line_series.h"

#include "scene/math/legendre.h"

namespace airlight::gpu {

LineSeries line_series(int points) {
  LineSeries line;
  const int row = (points + 3) / 4 * 4;
  const auto add = [&](const Eigen::VectorXd& list) {
    for (int i = 0; i < row; ++i) line.values.push_back(i < list.size() ? float(list[i]) : 0);
  };
  const scene::LegendrePoints& rule = scene::legendre_points(points);
  add(rule.node);
  const Eigen::ArrayXd norm = (Eigen::ArrayXd::LinSpaced(points, 0, points - 1) + 0.5).sqrt();
  for (int q = 0; q < points; ++q) add(rule.analysis.col(q).array() * norm);
  line.definitions = {
      {"SERIES", std::to_string(points)}, {"RULE_NODES", "0"}, {"RULE_ANALYSIS", std::to_string(row / 4)}};
  return line;
}

}  // namespace airlight::gpu
