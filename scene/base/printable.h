// Text from outside (a file's content or name, an argument, a library's message) as a part of one line of ours.
#pragma once
#include <string>
#include <string_view>

namespace airlight::scene {

// Valid UTF-8 stays; tabs and line breaks become blanks; every other control character, mark that turns the direction
// of writing, and byte that is not UTF-8 becomes '?'. More than `most` bytes are cut, between two characters, and end
// with "...".
std::string printable(std::string_view text, std::size_t most = std::string_view::npos);

}  // namespace airlight::scene
