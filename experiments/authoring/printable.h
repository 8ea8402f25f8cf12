// A text from outside as a part of one line of ours, an error message or a comment.
#pragma once
#include <string>

namespace airlight::experiments::authoring {

// What is not printable ASCII is replaced, and there are at most 200 characters. A comment of a TOML file may hold
// neither control characters nor broken UTF-8, both of which a file name can.
inline std::string printable(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text.size() > 200 ? text.substr(0, 197) + "..." : text;
}

}  // namespace airlight::experiments::authoring
