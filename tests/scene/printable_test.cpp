// Text from outside stays on one line and is shown as it is written.
#include "scene/base/printable.h"

#include <catch2/catch.hpp>

namespace printable_test {

using airlight::scene::printable;

TEST_CASE("text from outside becomes printable", "[printable]") {
  CHECK(printable("plain text, 'quoted' \"too\"") == "plain text, 'quoted' \"too\"");
  CHECK(printable("a\nb\r\tc\x1b[31m\x7f") == "a b  c?[31m?");
  CHECK(printable(std::string("a\0b", 3)) == "a?b");
  CHECK(printable("fum\xc3\xa9"
                  "e \xf0\x9f\x8c\xab") ==
        "fum\xc3\xa9"
        "e \xf0\x9f\x8c\xab");
  // U+0085 next line, U+2028 line separator, U+202E right to left: one character each.
  CHECK(printable("a\xc2\x85"
                  "b\xe2\x80\xa8"
                  "c\xe2\x80\xae"
                  "d") == "a?b?c?d");
  // Not UTF-8: a lone continuation, an overlong slash, a surrogate, beyond U+10FFFF, a character cut short. A byte
  // each.
  CHECK(printable("\x80") == "?");
  CHECK(printable("\xc0\xaf") == "??");
  CHECK(printable("\xed\xa0\x80") == "???");
  CHECK(printable("\xf4\x90\x80\x80") == "????");
  CHECK(printable("ab\xe2\x82") == "ab??");
}

TEST_CASE("text from outside is cut between characters", "[printable]") {
  CHECK(printable("abcdef", 6) == "abcdef");
  CHECK(printable("abcdefg", 6) == "abc...");
  CHECK(printable("ab\xc3\xa9"
                  "defg",
                  6) == "ab...");  // the third byte would halve it
  CHECK(printable("ab\xc3\xa9"
                  "defgh",
                  7) == "ab\xc3\xa9...");
  CHECK(printable(std::string(1000, 'x'), 60).size() == 60);
}

}  // namespace printable_test
