#include "experiments/say.h"

#include <fmt/format.h>

#include "experiments/progress.h"
#include "scene/printable.h"

namespace airlight::experiments {

void say(const std::string& line) {
  constexpr std::size_t most = 1000, end = 300;
  std::string text = scene::printable(line);
  // What was found comes first and what was expected last; between two characters of UTF-8.
  if (text.size() > most) text = scene::printable(text, most - end) + scene::printable(text.substr(text.size() - end));
  const ProgressHidden hidden;
  fmt::print(stderr, "airlight: {}\n", text);
}

}  // namespace airlight::experiments
