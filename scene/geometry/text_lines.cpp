#include "scene/geometry/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "scene/base/error.h"
#include "scene/base/printable.h"

namespace airlight::scene {
namespace {

constexpr std::string_view plain_blanks = " \t\r\v\f", blanks_of_continued = " \t\r\v\f\\\n";

// The length of the first line, without its end.
std::size_t line_length(std::string_view text) { return std::min(text.find('\n'), text.size()); }

bool goes_on(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line.ends_with('\\') && line.find('#') == std::string_view::npos;
}

}  // namespace

std::string TextLines::shown(std::string_view word) { return printable(word, 40); }

bool TextLines::next_raw(std::string_view& line) {
  if (rest_.empty()) return false;
  std::size_t begin = 0, end = line_length(rest_);
  for (++line_; continued_ && end < rest_.size() && goes_on(rest_.substr(begin, end - begin)); ++line_) {
    begin = end + 1;
    end = begin + line_length(rest_.substr(begin));
  }
  line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  return true;
}

bool TextLines::next() {
  std::string_view line;
  while (next_raw(line)) {
    words_ = line.substr(0, line.find('#'));
    if (words_.find_first_not_of(blanks()) != std::string_view::npos) return true;
  }
  return false;
}

std::string_view TextLines::word() {
  const std::size_t begin = words_.find_first_not_of(blanks());
  if (begin == std::string_view::npos) return words_ = {};
  words_.remove_prefix(begin);
  const std::string_view found = words_.substr(0, words_.find_first_of(blanks()));
  words_.remove_prefix(found.size());
  return found;
}

std::string_view TextLines::blanks() const { return continued_ ? blanks_of_continued : plain_blanks; }

bool TextLines::at_end() const { return words_.find_first_not_of(blanks()) == std::string_view::npos; }

double TextLines::number(const char* what) {
  const std::string_view found = word();
  if (found.empty()) fail(fmt::format("found the end of the line, expected {}", what));
  const std::string_view digits = found[0] == '+' ? found.substr(1) : found;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
    fail(fmt::format("found '{}', expected {}", shown(found), what));
  // Out of the range of double: too small is as good as zero, too large is not.
  if (error == std::errc::result_out_of_range && digits.find("e-") == digits.npos && digits.find("E-") == digits.npos)
    value = std::numeric_limits<double>::infinity();
  if (!(std::abs(value) <= std::numeric_limits<float>::max()))
    fail(fmt::format("found '{}', expected {} that is finite in single precision", shown(found), what));
  return value;
}

long long TextLines::integer(const char* what, long long least, long long greatest) {
  const std::string_view found = word();
  if (found.empty()) fail(fmt::format("found the end of the line, expected {}", what));
  long long value = 0;
  const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (error != std::errc() || end != found.data() + found.size() || value < least || value > greatest)
    fail(fmt::format("found '{}', expected {} from {} to {}", shown(found), what, least, greatest));
  return value;
}

void TextLines::fail(const std::string& found_and_expected) const {
  throw Error(fmt::format("{}:{}: {}", path_, line_, found_and_expected));
}

}  // namespace airlight::scene
