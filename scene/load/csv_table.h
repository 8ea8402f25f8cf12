// A table of numbers in a CSV file that a scene names: a header line, then one row a line; empty lines and lines that begin with # are
// passed over. Every mistake is told with its place: "g.csv:4:3: center_y = zero, expected a number".
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "scene/load/values.h"

namespace airlight::scene::load {

class CsvTable {
 public:
  // Throws Error unless the first line is `header`: the columns' names, commas between them; or, where one is given, `other`.
  CsvTable(const std::string& path, std::string_view header, std::string_view other = {});
  CsvTable(const CsvTable&) = delete;  // holds views of its own text
  CsvTable& operator=(const CsvTable&) = delete;

  std::string_view header() const { return header_; }  // the one that the file has
  bool next();                                         // to the next row; false after the last one
  // All values of this row, each in its range; as many as the header names. Throws Error.
  std::vector<double> values(const std::vector<Range>&) const;
  // "file:line:column: message", the column that of a value of this row, the first one being 0.
  [[noreturn]] void fail(std::size_t value, const std::string& message) const;

 private:
  [[noreturn]] void fail_at(std::size_t column, const std::string& message) const;  // from 0

  std::string path_, content_;
  std::string_view header_, row_;
  std::size_t begin_ = 0, line_ = 0;
};

}  // namespace airlight::scene::load
