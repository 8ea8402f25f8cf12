#include "experiments/judging/front.h"

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

// A piecewise linear function of x, x rising.
struct Knot {
  double x;
  double y;
};

std::vector<Knot> error_over_time(const std::vector<Point>& points) {
  std::vector<Knot> knots;
  for (const LogPoint& p : envelope(points)) knots.push_back({p.time, p.error});
  return knots;
}

std::vector<Knot> time_over_error(const std::vector<Point>& points) {
  std::vector<Knot> knots;
  for (const LogPoint& p : envelope(points)) knots.insert(knots.begin(), {p.error, p.time});
  return knots;
}

std::optional<double> at(const std::vector<Knot>& knots, double x) {
  if (knots.empty() || x < knots.front().x || x > knots.back().x) return std::nullopt;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    if (x <= knots[i + 1].x)
      return knots[i].y + (knots[i + 1].y - knots[i].y) * (x - knots[i].x) / (knots[i + 1].x - knots[i].x);
  return knots.back().y;
}

std::optional<Gain> gain(const std::vector<Knot>& baseline, const std::vector<Knot>& other) {
  if (baseline.empty() || other.empty()) return std::nullopt;
  const double from = std::max(baseline.front().x, other.front().x), to = std::min(baseline.back().x, other.back().x);
  if (from > to) return std::nullopt;
  // The ratio is piecewise linear in logarithms: 65 equal steps resolve every knot well enough for a mean.
  const int steps = from < to ? 64 : 0;
  double sum = 0, least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (int i = 0; i <= steps; ++i) {
    const double x = i == steps ? to : from + (to - from) * i / steps;
    const double ratio = *at(baseline, x) - *at(other, x);
    sum += ratio;
    least = std::min(least, ratio);
    greatest = std::max(greatest, ratio);
  }
  return Gain{std::exp(sum / (steps + 1)), std::exp(least), std::exp(greatest), std::exp(from), std::exp(to)};
}

const Point& fastest(const std::vector<Point>& points) { return points[by_time(points).front()]; }
const Point& slowest(const std::vector<Point>& points) { return points[by_time(points).back()]; }

// The fastest of the points with the least error.
const Point& closest(const std::vector<Point>& points) {
  return *std::min_element(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.error.value != b.error.value ? a.error.value < b.error.value : a.time.value < b.time.value;
  });
}

std::optional<double> exponential(std::optional<double> x) { return x ? std::optional(std::exp(*x)) : x; }

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
  return exponential(at(error_over_time(points), std::log(time)));
}

std::optional<double> time_at_error(const std::vector<Point>& points, double error) {
  return exponential(at(time_over_error(points), std::log(error)));
}

std::optional<Gain> speed_up(const std::vector<Point>& baseline, const std::vector<Point>& other) {
  return gain(time_over_error(baseline), time_over_error(other));
}

std::optional<Gain> error_ratio(const std::vector<Point>& baseline, const std::vector<Point>& other) {
  return gain(error_over_time(baseline), error_over_time(other));
}

std::optional<Apart> apart_in_error(const std::vector<Point>& baseline, const std::vector<Point>& other) {
  if (baseline.empty() || other.empty()) return std::nullopt;
  for (const bool other_is_closer : {true, false}) {
    const auto &close = other_is_closer ? other : baseline, &far = other_is_closer ? baseline : other;
    const Point &first = fastest(close), &best = closest(far);
    if (first.error.value < best.error.value)
      return Apart{other_is_closer, first.error.value, best.error.value, first.time.value / best.time.value,
                   slowest(close).time.value / fastest(far).time.value};
  }
  return std::nullopt;
}

std::optional<double> speed_up_of_exact(const std::vector<Point>& baseline, const std::vector<Point>& other) {
  if (baseline.empty() || other.empty()) return std::nullopt;
  const Point &a = closest(baseline), &b = closest(other);
  if (a.error.value != 0 || b.error.value != 0) return std::nullopt;
  return a.time.value / b.time.value;
}

}  // namespace airlight::experiments
