#include "scene/load/csv_table.h"

#include <fmt/format.h>

#include <charconv>

#include "scene/base/byte_order_mark.h"
#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"

namespace airlight::scene::load {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string shown(std::string_view text) { return printable(text, 40); }

}  // namespace

CsvTable::CsvTable(const std::string& path, std::string_view header, std::string_view other)
    : path_(path), content_(read_whole_file(path)), header_(header) {
  begin_ = content_.size() - without_mark(content_).size();
  const bool found = next();
  const std::string_view first = found ? row_ : std::string_view();
  if (!other.empty() && first == other) header_ = other;
  if (first != header_) fail_at(0, fmt::format("found '{}', expected the header {}", shown(first), header));
}

bool CsvTable::next() {
  while (begin_ < content_.size()) {
    const std::size_t end = std::min(content_.find('\n', begin_), content_.size());
    row_ = trimmed(std::string_view(content_).substr(begin_, end - begin_));
    begin_ = end + 1;
    ++line_;
    if (!row_.empty() && row_.front() != '#') return true;
  }
  return false;
}

std::vector<double> CsvTable::values(const std::vector<Range>& ranges) const {
  const std::vector<std::string_view> names = split(header_), parts = split(row_);
  std::vector<double> values(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (i >= parts.size())
      fail_at(row_.size(), fmt::format("found {} values, expected {}: {}", i, ranges.size(), header_));
    std::string_view cell = trimmed(parts[i]);
    if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
    const auto [stop, code] = std::from_chars(cell.data(), cell.data() + cell.size(), values[i]);
    const bool number = code == std::errc() && stop == cell.data() + cell.size();
    if (!number || !ranges[i].contains(values[i]))
      fail(i, fmt::format("{} = {}, expected {}", names[i], shown(cell), ranges[i].words()));
  }
  if (parts.size() > ranges.size())
    fail_at(std::size_t(parts[ranges.size()].data() - row_.data()) - 1,
            fmt::format("found more than {} values, expected {}", ranges.size(), header_));
  return values;
}

void CsvTable::fail(std::size_t value, const std::string& message) const {
  fail_at(std::size_t(split(row_)[value].data() - row_.data()), message);
}

void CsvTable::fail_at(std::size_t column, const std::string& message) const {
  throw Error(fmt::format("{}:{}:{}: {}", path_, line_, column + 1, message));
}

}  // namespace airlight::scene::load
