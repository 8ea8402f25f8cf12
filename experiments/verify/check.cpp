#include "experiments/verify/check.h"

#include <fmt/format.h>

#include <cmath>

namespace airlight::experiments::verification {

bool Comparison::ok() const {
  if (std::isnan(expected) || std::isnan(got)) return false;
  if (expected == got) return true;
  return std::abs(got - expected) <= tolerance;
}

Comparison relative(std::string what, double expected, double got, double tolerance, double floor) {
  const std::string share = fmt::format("{:.0e} relative", tolerance), rest = fmt::format("{:.0e} absolute", floor);
  return {std::move(what), expected, got, tolerance * std::abs(expected) + floor,
          tolerance == 0    ? rest
          : floor <= 1e-300 ? share
                            : share + " + " + rest};
}

Comparison absolute(std::string what, double expected, double got, double tolerance) {
  return {std::move(what), expected, got, tolerance, fmt::format("{:.0e} absolute", tolerance)};
}

Comparison statistical(std::string what, double expected, double expected_se, double got, double got_se, double k,
                       double accuracy) {
  const double se = std::hypot(expected_se, got_se);
  return {std::move(what), expected, got, k * se + accuracy, fmt::format("{} se of {:.1e}", k, se)};
}

Comparison truth(std::string what, bool got) { return {std::move(what), 1, got ? 1.0 : 0.0, 0, "exact"}; }

}  // namespace airlight::experiments::verification
