// Parts of a flow's file.
#pragma once
#include "scene/flow/flow_problem.h"
#include "scene/load/ranges.h"
#include "scene/load/table_reader.h"

namespace airlight::scene::load {

inline constexpr Range speed = either_sign(or_zero({1e-12, 1e6}));         // [m/s]; also accelerations, turns
inline constexpr Range temperatures = either_sign(or_zero({1e-12, 1e6}));  // [K]

Vec3 speeds(const TableReader&, const std::string& key);
void read_start(TableReader, const std::string& folder, FlowProblem&);
// The next of [[density]].
void read_density(TableReader, const std::string& folder, FlowProblem&);
// The density that the key `of` names: 0 the first, and without the key.
int read_which(const TableReader&, const FlowProblem&);

}  // namespace airlight::scene::load
