// A single value of a TOML file: where it stands, how it was written, which numbers are allowed.
#pragma once
#include <toml++/toml.h>

#include <string>

#include "scene/math/types.h"

namespace airlight::scene::load {

// "file:line:column", or "override medium.0.sigma_t = 3 of file" for a value that came from an override.
std::string location(const toml::source_region&);

// A value as the user wrote it, on one line and cut to 60 characters.
std::string written(const toml::node&);

// The numbers that a key takes.
struct Range {
  double least = -infinity;
  double greatest = infinity;
  bool open_least = false;     // least itself is out
  bool open_greatest = false;  // greatest itself is out
  bool infinite = false;       // inf is in
  bool zero = false;           // so is 0, whatever least is
  bool signs = false;          // of either sign: what is said of the size
  bool contains(double) const;
  std::string words() const;  // "a number >= 0", "0 or a number in [1e-30, 1e+30]", ...
};
inline constexpr Range any_number{};
inline constexpr Range not_negative{0, infinity};
inline constexpr Range positive{0, infinity, true};
inline constexpr Range share{0, 1};  // 0 to 1 inclusive
constexpr Range or_zero(Range range) { return range.zero = true, range; }
constexpr Range either_sign(Range range) { return range.signs = true, range; }

}  // namespace airlight::scene::load
