// Every failure that a user can cause or meet, as one exception type with the exit code of the command line.
#pragma once
#include <stdexcept>
#include <string>

namespace airlight {

// Bad input or usage: one line that names file, line and column where there are any, what was found and what was
// expected. Exit code 2.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& line, int exit_code = 2) : std::runtime_error(line), exit_code_(exit_code) {}
  int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

// Missing hardware, driver or library. Exit code 3.
class Unavailable : public Error {
 public:
  explicit Unavailable(const std::string& line) : Error(line, 3) {}
};

// No device to compute on: none is there, or none of those is the one asked for. A device that is there and refuses a
// task is Unavailable only.
class NoDevice : public Unavailable {
 public:
  using Unavailable::Unavailable;
};

}  // namespace airlight
