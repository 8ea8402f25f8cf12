// Intervals of what is read off several timed rows together, by drawing their runs and errors again (bootstrap).
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "experiments/driver/row.h"
#include "experiments/judging/front.h"

namespace airlight::experiments {

using Curve = std::vector<const Row*>;  // rows with a time and the metric
using Figure =
    std::function<std::optional<double>(const std::vector<Point>& baseline, const std::vector<Point>& other)>;

// 95 % interval of the figure: 1000 draws with a fixed seed, of which each takes rounds with replacement, the same ones
// for all rows that were timed together (what slowed the machine in a round slowed them alike), the median of each
// row's times in them, and errors from a normal distribution with their intervals, each row's on its own. Nothing where
// a row has fewer than five runs, or where a tenth of the draws has no such figure.
std::optional<Estimate> bootstrap(const Curve& baseline, const Curve& other, const std::string& metric, const Figure&);

}  // namespace airlight::experiments
