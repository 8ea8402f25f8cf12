// Lines and words of a text format, with line numbers for messages.
#pragma once
#include <string>
#include <string_view>

namespace airlight::scene {

class TextLines {
 public:
  TextLines(std::string path, std::string_view text) : path_(std::move(path)), rest_(text) {}

  // Moves to the next line that holds anything but blanks and comments (from '#'); false at the end.
  bool next();
  // The next word of the line; empty at its end.
  std::string_view word();
  bool at_end() const;  // no more words in this line
  // The next word as a number. Throws if it is none, or not finite in single precision.
  double number(const char* what);
  std::string_view last_word() const { return last_; }  // that number() read
  // The next word as an integer in [least, greatest].
  long long integer(const char* what, long long least, long long greatest);

  static std::string shown(std::string_view word);  // fit for a message: short and printable
  [[noreturn]] void fail(const std::string& found_and_expected) const;
  std::string_view rest() const { return rest_; }  // what follows the line
  int line() const { return line_; }

 private:
  bool next_raw(std::string_view& line);  // the next line as it is

  std::string path_;
  std::string_view rest_;
  std::string_view words_, last_;
  int line_ = 0;
};

}  // namespace airlight::scene
