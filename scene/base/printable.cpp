#include "scene/base/printable.h"

#include <algorithm>
#include <cstdint>

namespace airlight::scene {
namespace {

struct Character {
  std::size_t bytes;
  std::uint32_t code;
};

// The character that the text begins with; code 0 for a byte that begins none.
Character first(std::string_view text) {
  const auto byte = [&](std::size_t i) { return std::uint32_t(static_cast<unsigned char>(text[i])); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {1, lead};
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return {1, 0};
  std::uint32_t code = lead & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {1, 0};
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  return code < least[length] || code > 0x10ffff || surrogate ? Character{1, 0} : Character{length, code};
}

bool is_plain(std::uint32_t code) {
  if (code < 0x20 || (code >= 0x7f && code < 0xa0)) return false;
  const auto within = [&](std::uint32_t lo, std::uint32_t hi) { return code >= lo && code <= hi; };
  // Separators of lines and paragraphs; marks of direction, which would show a message in another order.
  return !within(0x200e, 0x200f) && !within(0x2028, 0x202e) && !within(0x2066, 0x2069) && code != 0x61c;
}

}  // namespace

std::string printable(std::string_view text, std::size_t most) {
  const bool cut = text.size() > most;
  const std::size_t room = cut ? most - std::min<std::size_t>(most, 3) : most;
  std::string line;
  while (!text.empty()) {
    const Character c = first(text);
    const bool plain = is_plain(c.code);
    if (line.size() + (plain ? c.bytes : 1) > room) break;
    const bool blank = c.code == '\n' || c.code == '\r' || c.code == '\t';
    line += plain ? text.substr(0, c.bytes) : blank ? " " : "?";
    text.remove_prefix(c.bytes);
  }
  return cut ? line + "..." : line;
}

}  // namespace airlight::scene
