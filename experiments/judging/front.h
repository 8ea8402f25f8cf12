// Curves of error against time: who is on the front, how much it dominates, and equal time or equal error between
// curves.
#pragma once
#include <optional>
#include <vector>

#include "experiments/judging/statistics.h"

namespace airlight::experiments {

// One measurement; time and error positive. Intervals collapse to the value where they are not known.
struct Point {
  Estimate time;
  Estimate error;
};

// Point p dominates q if it is no worse in both, interval-wise (upper end of p <= lower end of q) and better in one.
bool dominates(const Point& p, const Point& q);

// Indices of the points that no other dominates, in order of time.
std::vector<std::size_t> front(const std::vector<Point>&);

// Area between the front and the reference point (worst_time, worst_error) in natural logarithms of both; points beyond
// the reference point do not count. Plain values, without intervals.
double hypervolume(const std::vector<Point>&, double worst_time, double worst_error);

// Straight lines between neighbours in log error over log time, on the lower envelope of the curve (for each time the
// best error reached until then). Nothing outside the range that was measured: no extrapolation.
std::optional<double> error_at_time(const std::vector<Point>&, double time);
std::optional<double> time_at_error(const std::vector<Point>&, double error);

// How a method compares with a baseline over what both reach; no extrapolation.
struct Gain {
  double geometric_mean;
  double least;
  double greatest;
  double from;  // the errors, or times, that both reach
  double to;
};
// Time of `baseline` over time of `other`, at equal error.
std::optional<Gain> speed_up(const std::vector<Point>& baseline, const std::vector<Point>& other);
// Error of `baseline` over error of `other`, at equal time.
std::optional<Gain> error_ratio(const std::vector<Point>& baseline, const std::vector<Point>& other);

// Two curves without an error that both reach: even the fastest point of one has a smaller error than every point of
// the other. Errors may be 0, times not.
struct Apart {
  bool other_is_closer;       // else `baseline` is
  double error;               // of the closer curve's fastest point
  double least_error;         // of the other curve, at its closest point
  double fastest_to_closest;  // time of the first of these points over that of the second
  double slowest_to_fastest;  // greatest time of the closer curve over the least of the other
};
std::optional<Apart> apart_in_error(const std::vector<Point>& baseline, const std::vector<Point>& other);

// Time of `baseline` over time of `other`, the fastest points of both whose error is 0; nothing where one has none.
std::optional<double> speed_up_of_exact(const std::vector<Point>& baseline, const std::vector<Point>& other);

}  // namespace airlight::experiments
