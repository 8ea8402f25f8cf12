// Lines and words of a text format, with line numbers for messages.
#pragma once
#include <string>
#include <string_view>

#include "scene/base/byte_order_mark.h"

namespace airlight::scene {

class TextLines {
 public:
  // A byte order mark at the beginning of the text is passed over. `continued`: a line that ends with a backslash, and is
  // no comment, goes on in the next.
  TextLines(std::string path, std::string_view text, bool continued = false)
      : path_(std::move(path)), rest_(without_mark(text)), continued_(continued) {}

  // Moves to the next line that holds anything but blanks and comments (from '#'); false at the end.
  bool next();
  // The next word of the line; empty at its end.
  std::string_view word();
  bool at_end() const;  // no more words in this line
  // The next word as a number. Throws if it is none, or not finite in single precision.
  double number(const char* what);
  // The next word as an integer in [least, greatest].
  long long integer(const char* what, long long least, long long greatest);

  static std::string shown(std::string_view word);  // fit for a message: short and printable
  [[noreturn]] void fail(const std::string& found_and_expected) const;
  std::string_view rest() const { return rest_; }  // what follows the line
  int line() const { return line_; }

 private:
  std::string_view blanks() const;
  bool next_raw(std::string_view& line);  // the next line as it is, with those that it goes on in

  std::string path_;
  std::string_view rest_;
  std::string_view words_;
  bool continued_;
  int line_ = 0;
};

}  // namespace airlight::scene
