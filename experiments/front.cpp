#include "experiments/front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace airlight::experiments {
namespace {

std::vector<std::size_t> by_time(const std::vector<Point>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Point &p = points[a], &q = points[b];
    return p.time.value != q.time.value ? p.time.value < q.time.value : p.error.value < q.error.value;
  });
  return order;
}

struct LogPoint {
  double time;
  double error;
};

// The curve in logarithms: in order of time, only points that improve on all faster ones.
std::vector<LogPoint> envelope(const std::vector<Point>& points) {
  std::vector<LogPoint> curve;
  for (const std::size_t i : by_time(points)) {
    const Point& p = points[i];
    if (!(p.time.value > 0) || !(p.error.value > 0)) continue;
    if (curve.empty() || std::log(p.error.value) < curve.back().error)
      curve.push_back({std::log(p.time.value), std::log(p.error.value)});
  }
  return curve;
}

double between(double x, double x0, double x1, double y0, double y1) {
  return x1 == x0 ? y0 : y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

std::optional<double> log_time_at(const std::vector<LogPoint>& curve, double error) {
  if (curve.empty() || error > curve.front().error || error < curve.back().error) return std::nullopt;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i)
    if (error >= curve[i + 1].error)
      return between(error, curve[i].error, curve[i + 1].error, curve[i].time, curve[i + 1].time);
  return curve.back().time;
}

}  // namespace

bool dominates(const Point& p, const Point& q) {
  const bool no_worse = p.time.high <= q.time.low && p.error.high <= q.error.low;
  return no_worse && (p.time.high < q.time.low || p.error.high < q.error.low);
}

std::vector<std::size_t> front(const std::vector<Point>& points) {
  std::vector<std::size_t> kept;
  for (const std::size_t i : by_time(points)) {
    const bool beaten =
        std::any_of(points.begin(), points.end(), [&](const Point& other) { return dominates(other, points[i]); });
    if (!beaten) kept.push_back(i);
  }
  return kept;
}

double hypervolume(const std::vector<Point>& points, double worst_time, double worst_error) {
  const double end = std::log(worst_time), top = std::log(worst_error);
  double area = 0;
  const auto curve = envelope(points);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double until = i + 1 < curve.size() ? std::min(end, curve[i + 1].time) : end;
    if (curve[i].time < until && curve[i].error < top) area += (until - curve[i].time) * (top - curve[i].error);
  }
  return area;
}

std::optional<double> error_at_time(const std::vector<Point>& points, double time) {
  const auto curve = envelope(points);
  const double x = std::log(time);
  if (curve.empty() || x < curve.front().time || x > curve.back().time) return std::nullopt;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i)
    if (x <= curve[i + 1].time)
      return std::exp(between(x, curve[i].time, curve[i + 1].time, curve[i].error, curve[i + 1].error));
  return std::exp(curve.back().error);
}

std::optional<double> time_at_error(const std::vector<Point>& points, double error) {
  const auto time = log_time_at(envelope(points), std::log(error));
  return time ? std::optional(std::exp(*time)) : std::nullopt;
}

std::optional<SpeedUp> speed_up(const std::vector<Point>& baseline, const std::vector<Point>& other) {
  const auto a = envelope(baseline), b = envelope(other);
  if (a.empty() || b.empty()) return std::nullopt;
  const double high = std::min(a.front().error, b.front().error);
  const double low = std::max(a.back().error, b.back().error);
  if (low > high) return std::nullopt;
  // The ratio is piecewise linear in logarithms: 65 equal steps resolve every knot well enough for a mean.
  const int steps = low < high ? 64 : 0;
  double sum = 0, least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (int i = 0; i <= steps; ++i) {
    const double error = i == steps ? low : high + (low - high) * i / std::max(steps, 1);
    const double ratio = *log_time_at(a, error) - *log_time_at(b, error);
    sum += ratio;
    least = std::min(least, ratio);
    greatest = std::max(greatest, ratio);
  }
  return SpeedUp{std::exp(sum / (steps + 1)), std::exp(least), std::exp(greatest), std::exp(low), std::exp(high)};
}

}  // namespace airlight::experiments
