// Texts with something else in them, and what the Error of an action says.
#pragma once
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>

#include "scene/base/error.h"

namespace airlight::test {

// `text` with `by` in the place of the first `what`, which is there.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("no '" + what + "'");
  return text.replace(at, what.size(), by);
}

// `otherwise` where the action throws no Error. An Error of bad input is one line, and ends a program with code 2.
template <class Action>
std::string message_of(const Action& action, const std::string& otherwise = "") {
  try {
    action();
  } catch (const Error& e) {
    CHECK(e.exit_code() == 2);
    CHECK(std::string(e.what()).find('\n') == std::string::npos);
    return e.what();
  }
  return otherwise;
}

}  // namespace airlight::test
