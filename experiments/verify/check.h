// A check of a vector: a job that recomputes it and compares number by number.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "experiments/verify/entry.h"
#include "experiments/verify/verify.h"

namespace airlight::experiments::verification {

// One recomputed number. `tolerance` is what |got - expected| may be; its text says where it comes from.
struct Comparison {
  std::string what;  // which number of the vector; may be empty
  double expected = 0;
  double got = 0;
  double tolerance = 0;        // absolute
  std::string tolerance_text;  // "1e-10 relative", "4.5 se (se 1e-4)"
  bool ok() const;             // equal infinities are equal; NaN never is
};

// |got - expected| <= tolerance |expected| + floor.
Comparison relative(std::string what, double expected, double got, double tolerance, double floor = 1e-300);
Comparison absolute(std::string what, double expected, double got, double tolerance);
// Two values with standard errors: |got - expected| <= k sqrt(got_se^2 + expected_se^2) + accuracy.
Comparison statistical(std::string what, double expected, double expected_se, double got, double got_se, double k,
                       double accuracy = 0);
// A truth that is no number: 1 expected, 0 or 1 got.
Comparison truth(std::string what, bool got);

struct Outcome {
  void add(Comparison c) { comparisons.push_back(std::move(c)); }
  std::vector<Comparison> comparisons{};
  int left_out = 0;  // numbers that the profile does not reach
  std::string left_out_because{};
};

// Made by reading a vector completely; run later. Where there is no job, `not_here` says why. `on_device` computes the vector by the shaders
// that draw pictures, while the context of this process is in use; where there is none, `not_on_device` says why.
struct Check {
  std::string not_here{};
  std::function<Outcome(VerifyProfile)> job{};
  std::function<Outcome(VerifyProfile)> on_device{};
  std::string not_on_device = "no device code computes this";
};
// A check that the program does not implement.
inline Check not_yet(const std::string& what) { return {"not yet: " + what, nullptr}; }
// To the accuracy of the vector.
inline Check no_renderer() { return {"no renderer computes this", nullptr}; }

// Reads a vector; the value is the whole entry.
using Reader = std::function<Check(const Value&)>;

// The reader of a kind in a file of that family ("references", "fogshop", ...), or an empty one for an unknown kind.
Reader find_reader(const std::string& family, const std::string& kind);
std::vector<std::string> known_kinds(const std::string& family);
std::vector<std::string> known_kinds();  // of all families, each once

// The family from what the file says of itself; throws Error if nothing known.
std::string family_of(const Value& file);

}  // namespace airlight::experiments::verification
