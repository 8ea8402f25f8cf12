#include "experiments/application/say.h"

#include <fmt/format.h>

#include <cstdio>

#include "experiments/application/progress.h"
#include "scene/base/printable.h"

namespace airlight::experiments {

void say(const std::string& line) {
  constexpr std::size_t most = 1000, end = 300;
  std::string text = scene::printable(line);
  // The beginning (the value found) and the end (the value expected) are kept. The text is cut between
  // characters of UTF-8.
  if (text.size() > most) text = scene::printable(text, most - end) + scene::printable(text.substr(text.size() - end));
  const ProgressHidden hidden;
  // Not fmt::print, which throws: where the line cannot be written, the exit code must still be told.
  std::fputs(fmt::format("airlight: {}\n", text).c_str(), stderr);
}

}  // namespace airlight::experiments
