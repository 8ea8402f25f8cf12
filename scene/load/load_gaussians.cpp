// A sum of Gaussians: written in the scene file, or as a table in a CSV file beside it.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "scene/error.h"
#include "scene/load/assets.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/printable.h"

namespace airlight::scene::load {
namespace {

constexpr std::size_t most_gaussians = std::size_t(1) << 20;  // every ray may have to look at each
constexpr std::string_view header = "center_x,center_y,center_z,width,amplitude";

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

[[noreturn]] void fail_at(const std::string& path, std::size_t line, std::size_t column, const std::string& message) {
  throw Error(fmt::format("{}:{}:{}: {}", path, line, column, message));
}

std::string shown(std::string_view text) { return printable(text, 40); }

Gaussian read_row(std::string_view row, const std::string& path, std::size_t line) {
  static constexpr const char* names[] = {"center_x", "center_y", "center_z", "width", "amplitude"};
  static constexpr Range ranges[] = {coordinate, coordinate, coordinate, length, either_sign(density_range)};
  std::array<double, 5> values{};
  std::size_t begin = 0;
  for (int i = 0; i < 5; ++i) {
    if (begin > row.size())
      fail_at(path, line, row.size() + 1, fmt::format("found {} values, expected 5: {}", i, header));
    const std::size_t end = std::min(row.find(',', begin), row.size());
    const std::string_view cell = trimmed(row.substr(begin, end - begin));
    const auto [stop, code] = std::from_chars(cell.data(), cell.data() + cell.size(), values[i]);
    const bool number = code == std::errc() && stop == cell.data() + cell.size();
    if (!number || !ranges[i].contains(values[i]))
      fail_at(path, line, begin + 1, fmt::format("{} = {}, expected {}", names[i], shown(cell), ranges[i].words()));
    begin = end + 1;
  }
  if (begin <= row.size()) fail_at(path, line, begin, fmt::format("found more than 5 values, expected {}", header));
  return {{values[0], values[1], values[2]}, values[3], values[4]};
}

std::vector<Gaussian> read_csv(const std::string& path) {
  const std::string content = read_whole_file(path);
  std::vector<Gaussian> gaussians;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view line = trimmed(std::string_view(content).substr(begin, end - begin));
    ++number;
    begin = end + 1;
    if (number == 1) {
      if (line != header) fail_at(path, 1, 1, fmt::format("found '{}', expected the header {}", shown(line), header));
    } else if (!line.empty() && line.front() != '#') {
      if (gaussians.size() == most_gaussians)
        fail_at(path, number, 1, fmt::format("found more than {} Gaussians, expected fewer", most_gaussians));
      gaussians.push_back(read_row(line, path, number));
    }
  }
  return gaussians;
}

Gaussian read_gaussian(TableReader reader) {
  reader.allow({"center", "width", "amplitude"});
  return {reader.vector("center"), reader.number("width", length),
          reader.number("amplitude", either_sign(density_range))};
}

}  // namespace

GaussianSum read_gaussian_sum(TableReader& reader, const std::string& folder) {
  reader.allow(medium_keys_and({"constant", "cutoff", "gaussians", "file"}));
  GaussianSum sum;
  sum.constant = reader.number("constant", density_range, 0);
  sum.cutoff = reader.number("cutoff", widths, infinity);
  if (reader.one_of({"gaussians", "file"}) == "file") {
    sum.gaussians = read_csv(find_asset(reader, "file", folder));
  } else {
    for (const TableReader& gaussian : reader.tables("gaussians")) sum.gaussians.push_back(read_gaussian(gaussian));
  }
  return sum;
}

}  // namespace airlight::scene::load
