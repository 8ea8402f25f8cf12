// `airlight verify`: recomputes oracle vectors and compares.
#pragma once
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace airlight::experiments {

enum class VerifyProfile {
  quick,  // the budget of CI: a spread of the slab rows, the Monte Carlo scenes that fit
  paper,  // everything
};

// Whose numbers are compared: those of the processor's functions, or those of the shaders that draw pictures.
enum class VerifyOn { processor, device };

// Results for the vectors of one kind in one file.
struct VerifyKind {
  std::string file, kind;
  int vectors = 0;   // with at least one number compared
  int numbers = 0;   // compared
  int out = 0;       // beyond their tolerance
  int left_out = 0;  // numbers that the profile does not reach
  int not_yet = 0;   // vectors that no renderer computes; on the device, that no device code computes
  double worst_relative_error = std::numeric_limits<double>::quiet_NaN();  // NaN: all expected are 0
  double worst_share = 0;                                                  // largest |got - expected| / tolerance
  std::string worst;                                                       // the number with that share
  double seconds = 0;
};

// Reads every vector of the files, whatever their schema, and prints one line per compared number:
//   id, kind, what, expected, got, relative error, tolerance, ok or OUT
// then the counts of each file. Vectors of methods that are not built are listed as "not yet" and counted. With `kind`,
// only vectors of that kind. Everything is read before anything is computed. On the device, vectors that no device code computes are listed
// and counted, and Unavailable is thrown where there is no device.
//
// Returns 0 if all compared numbers are within tolerance, 1 if any is out or none was compared. Throws Error (exit code
// 2) naming file and entry for a file that cannot be parsed, an unknown format or kind, or a malformed entry; and if no
// vector has the wanted kind. `kinds` receives the figures per file and kind, in their order of appearance.
int verify(const std::vector<std::string>& files, const std::string& kind, VerifyProfile, std::ostream&,
           std::vector<VerifyKind>* kinds = nullptr, VerifyOn = VerifyOn::processor);

}  // namespace airlight::experiments
