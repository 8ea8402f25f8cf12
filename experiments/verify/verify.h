// `airlight verify`: recomputes oracle vectors and compares.
#pragma once
#include <ostream>
#include <string>
#include <vector>

namespace airlight::experiments {

enum class VerifyProfile {
  quick,  // the budget of CI: a spread of the slab rows, the Monte Carlo scenes that fit
  paper,  // everything
};

// Reads every vector of the files, whatever their schema, and prints one line per compared number:
//   id, kind, what, expected, got, relative error, tolerance, ok or OUT
// then the counts. Kinds of methods that are not built are listed as "not yet" and counted. With `kind`, only vectors
// of that kind. Everything is read before anything is computed.
//
// Returns 0 if all compared numbers are within tolerance, 1 if any is out. Throws Error (exit code 2) naming file and
// entry for a file that cannot be parsed, an unknown format or kind, or a malformed entry; and if no vector has the
// wanted kind.
int verify(const std::vector<std::string>& files, const std::string& kind, VerifyProfile, std::ostream&);

}  // namespace airlight::experiments
