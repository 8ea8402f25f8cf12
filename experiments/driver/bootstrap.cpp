#include "experiments/driver/bootstrap.h"

#include <algorithm>
#include <map>
#include <random>

#include "experiments/judging/statistics.h"

namespace airlight::experiments {
namespace {

constexpr int draws = 1000;
constexpr std::size_t least_times = 5;

class Draw {
 public:
  explicit Draw(std::mt19937_64& random) : random_(random) {}

  std::vector<Point> points(const Curve& curve, const std::string& metric) {
    std::vector<Point> points;
    for (const Row* row : curve) {
      const double time = median_time(*row), error = drawn_error(*quantity(*row, metric));
      points.push_back({{time, time, time}, {error, error, error}});
    }
    return points;
  }

 private:
  double uniform() { return double(random_() >> 11) * 0x1p-53; }

  // In [0, 1): rows with as many runs take the same rounds.
  double round_of(const std::string& group, std::size_t k) {
    std::vector<double>& rounds = rounds_[group];
    while (rounds.size() <= k) rounds.push_back(uniform());
    return rounds[k];
  }

  double median_time(const Row& row) {
    std::vector<double> times;
    for (std::size_t k = 0; k < row.times.size(); ++k)
      times.push_back(row.times[std::size_t(round_of(row.group, k) * double(row.times.size()))]);
    return median(times);
  }

  double drawn_error(const Estimate& e) {
    if (!(e.low < e.high)) return e.value;
    const double z = normal_quantile(std::clamp(uniform(), 1e-12, 1 - 1e-12)) / normal_quantile(0.975);
    return std::max(e.value + z * (z < 0 ? e.value - e.low : e.high - e.value), 1e-3 * e.value);
  }

  std::mt19937_64& random_;
  std::map<std::string, std::vector<double>> rounds_;
};

}  // namespace

std::optional<Estimate> bootstrap(const Curve& baseline, const Curve& other, const std::string& metric,
                                  const Figure& figure) {
  std::vector<Point> measured[2];
  for (const Curve* curve : {&baseline, &other})
    for (const Row* row : *curve) {
      if (row->times.size() < least_times) return std::nullopt;
      measured[curve == &other].push_back({row->seconds, *quantity(*row, metric)});
    }
  const auto value = figure(measured[0], measured[1]);
  if (!value) return std::nullopt;
  std::mt19937_64 random(1);
  std::vector<double> found;
  for (int i = 0; i < draws; ++i) {
    Draw draw(random);
    const auto first = draw.points(baseline, metric), second = draw.points(other, metric);
    if (const auto x = figure(first, second)) found.push_back(*x);
  }
  if (found.size() < 0.9 * draws) return std::nullopt;
  std::sort(found.begin(), found.end());
  const auto at = [&](double p) { return found[std::size_t(p * double(found.size() - 1))]; };
  return Estimate{*value, at(0.025), at(0.975)};
}

}  // namespace airlight::experiments
