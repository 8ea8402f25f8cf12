// Common parts of vectors of flows: tables by rows, a square box.
#pragma once
#include <fmt/format.h>

#include <cmath>

#include "experiments/verify/readers.h"
#include "reference/stable_fluids/advection.h"
#include "scene/base/error.h"

namespace airlight::experiments::verification {

inline scene::FlowProblem flat_problem(double size, scene::Side::Kind sides) {
  scene::FlowProblem problem;
  problem.dimensions = 2;
  problem.box = {Point3::Zero(), Point3(size, size, 0)};
  for (auto& axis : problem.sides)
    for (scene::Side& side : axis) side.kind = sides;
  return problem;
}

// A row of a table: its numbers, and the scheme that its first column may name.
struct Row {
  std::string scheme;
  std::vector<double> numbers;  // of the other columns
  // Cells, or steps: more take minutes.
  int whole(std::size_t i, int most = 4096) const {
    if (!(numbers[i] >= 1 && numbers[i] <= most && numbers[i] == std::floor(numbers[i])))
      throw Error(fmt::format("a row has {}, expected a whole number from 1 to {}", numbers[i], most));
    return int(numbers[i]);
  }
  stable_fluids::Scheme advection() const {
    return scheme == "mc" ? stable_fluids::Scheme::maccormack : stable_fluids::Scheme::semi_lagrangian;
  }
};

inline std::vector<Row> read_rows(const Value& rows, bool schemes, std::size_t columns) {
  std::vector<Row> all(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (schemes) all[i].scheme = rows[i][0].text();
    if (schemes && all[i].scheme != "sl" && all[i].scheme != "mc") rows[i][0].complain("sl or mc");
    for (std::size_t k = schemes ? 1 : 0; k < rows[i].size(); ++k) all[i].numbers.push_back(rows[i][k].number());
    if (all[i].numbers.size() != columns) rows[i].complain(fmt::format("{} numbers", columns));
  }
  return all;
}

}  // namespace airlight::experiments::verification
