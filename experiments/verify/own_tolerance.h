// Vectors that state their tolerance: |got - expected| <= atol + rtol |expected|.
#pragma once
#include <fmt/format.h>

#include "experiments/verify/check.h"

namespace airlight::experiments::verification {

struct OwnTolerance {
  double relative, absolute;
};
inline OwnTolerance tolerance_of(const Value& v) { return {v["rtol"].number_in(0, 1), v["atol"].number_in(0, 1)}; }

inline Comparison compare(std::string what, double expected, double got, OwnTolerance t) {
  return relative(std::move(what), expected, got, t.relative, t.absolute);
}

// Number by number. One more or fewer than expected is a number out.
inline void compare_all(Outcome& out, const std::string& what, const std::vector<double>& expected,
                        const std::vector<double>& got, OwnTolerance t) {
  if (got.size() != expected.size()) out.add(truth(what + ": as many numbers", false));
  for (std::size_t i = 0; i < std::min(got.size(), expected.size()); ++i)
    out.add(compare(fmt::format("{} {}", what, i), expected[i], got[i], t));
}

}  // namespace airlight::experiments::verification
