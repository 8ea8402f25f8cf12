// Results that compare several rows: the front, and speed-ups at equal error and error ratios at equal time.
#pragma once
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

using TextTable = std::vector<std::vector<std::string>>;  // the header first

// For each row: no other row of its scene beats it in both time and the first metric, beyond the intervals.
std::vector<bool> on_front(const Outcome&);

// A line for each [[speed_up]] and scene: ratios of time over the errors that both reach, after how many renders a
// longer preparation is repaid (in the middle of those errors), ratios of error over the times that both reach; both
// with the interval that the runs and errors leave them (bootstrap.h).
TextTable equal_error_and_time(const Outcome&);

// The first of those ratios of one scene, a geometric mean with its interval where that is known: at equal error the method is
// so many times faster than the baseline. Where they reach no common error but both reach 0: the ratio of time there.
std::optional<Estimate> speed_up_at_equal_error(const Outcome&, const SpeedUpCase&, const std::string& scene);

// Where even the method's fastest row has a smaller error than the baseline's closest: time of the latter over time of the
// former. At any error that the baseline reaches the method is at least so many times faster.
std::optional<double> least_speed_up(const Outcome&, const SpeedUpCase&, const std::string& scene);

// Orders of convergence of flows, for each scene, method and error of at least two rows at rising numeric settings: the
// order p with which the error falls as setting^-p from each row to the next. Only a header if there are none.
TextTable orders(const Outcome&);

// A line where processors were not free for more than a tenth of the threads' time in some row's timed runs; else
// empty.
inline constexpr double much_waiting = 0.1;
std::string load_warning(const Outcome&);

std::string duration(double seconds);  // "12.3 ms"
std::string time_text(const Row&);     // "12.3 ms [12.1 ms, 12.6 ms]"; empty where nothing was timed

}  // namespace airlight::experiments
