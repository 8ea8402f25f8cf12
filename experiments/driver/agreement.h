// Whether a run found what the committed table says: figure by figure, with no verdict on times.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

// A figure that the two tables have different.
struct Difference {
  std::string scene, method, setting, metric;
  double ours = 0, committed = 0;  // NaN: not defined there
};

struct Agreement {
  std::size_t figures = 0;                    // in both tables, without times
  std::vector<Difference> differ;             // of those that are exact
  std::size_t noisy = 0;                      // of the figures: at least one of the two has an interval
  std::vector<Difference> apart;              // of the noisy ones: the 95 % intervals do not touch
  std::size_t rows_here = 0, rows_there = 0;  // that only one table has
  std::size_t not_comparable = 0;             // rows of another device, or of one that is not here
  std::optional<Estimate> times;              // ours over committed: median, and from the least to the greatest tenth

  bool agrees() const;  // nothing differs, and no more noisy figures are apart than chance explains
};

// Rows are found by scene, method and setting. Two exact figures agree if they differ by at most 1e-3 of the greater, the
// third digit: rounding differs between processors, and iterations may take one step more. Or if both are below 1e-6: that is
// the rounding of single precision, which scripts/tighten does not take for a figure either; a gate on it still holds. Two
// noisy ones agree if their 95 % intervals touch. If they measure the same, that fails once in 180 times, but figures of one
// picture fail together: so up to 1 in 20, and one in any case, are chance. `is_speed`: a figure that depends on how fast the
// machine is; those and `seconds` are only put in proportion, where they are times.
using IsSpeed = std::function<bool(const Row&, const std::string& metric)>;
Agreement compare_tables(const std::vector<Row>& ours, const std::vector<Row>& committed, const IsSpeed&);

// "agrees with NAME: 144 of 144 figures; times 1.2 times as long (0.9 to 1.6)" or "DIFFERS from NAME: ...".
std::string text(const Agreement&, const std::string& name);

// The rows of a record (run.json), as compare_tables needs them; nothing where there is none. Throws Error.
std::optional<std::vector<Row>> recorded_rows(const std::filesystem::path& record);

// Compares a run with the table of the same name below `results`; nothing if there is no such table.
std::optional<Agreement> agreement_with(const std::filesystem::path& results, const Outcome&);

}  // namespace airlight::experiments
