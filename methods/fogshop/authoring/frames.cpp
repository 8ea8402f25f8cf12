#include "methods/fogshop/authoring/frames.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "methods/fogshop/authoring/gaussian_list.h"
#include "scene/error.h"
#include "scene/read_file.h"

namespace airlight::fogshop::authoring {
namespace {

constexpr std::string_view header = "frame,id,x,y,z,radius,density";
constexpr std::array names = {"frame", "id", "x", "y", "z", "radius", "density"};

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string shown(std::string_view text) {
  std::string line;
  for (const char c : text.substr(0, 40)) line += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? line + "..." : line;
}

const char* wrong(std::size_t column, double value) {
  if (column == 1 && (value != std::floor(value) || std::abs(value) > 0x1p53)) return "an integer";
  if (column == 5 && !(value > 0)) return "a number > 0";
  if (column == 6 && !(value >= 0)) return "a number >= 0";
  return nullptr;
}

std::array<double, 7> read_row(std::string_view row, const std::string& path, int line) {
  const auto fail = [&](std::size_t column, const std::string& what) {
    throw Error(fmt::format("{}:{}:{}: {}", path, line, column, what));
  };
  std::array<double, 7> values{};
  std::size_t begin = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (begin > row.size()) fail(row.size() + 1, fmt::format("found {} values, expected 7: {}", i, header));
    const std::size_t end = std::min(row.find(',', begin), row.size());
    const std::string_view cell = trimmed(row.substr(begin, end - begin));
    const auto [stop, code] = std::from_chars(cell.data(), cell.data() + cell.size(), values[i]);
    const bool number = code == std::errc() && stop == cell.data() + cell.size() && std::isfinite(values[i]);
    const char* expected = number ? wrong(i, values[i]) : "a finite number";
    if (expected) fail(begin + 1, fmt::format("{} = {}, expected {}", names[i], shown(cell), expected));
    begin = end + 1;
  }
  if (begin <= row.size()) fail(begin, fmt::format("found more than 7 values, expected {}", header));
  return values;
}

}  // namespace

Frames read_frames(const std::string& path) {
  const std::string content = scene::read_whole_file(path);
  Frames frames;
  std::size_t particles = 0;
  int number = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view line = trimmed(std::string_view(content).substr(begin, end - begin));
    begin = end + 1;
    if (++number == 1) {
      if (line != header)
        throw Error(fmt::format("{}:1:1: found '{}', expected the header {}", path, shown(line), header));
      continue;
    }
    if (line.empty() || line.front() == '#') continue;
    const auto v = read_row(line, path, number);
    const FrameParticle particle{{v[2], v[3], v[4]}, v[5], v[6]};
    if (!frames[v[0]].emplace((long long)(v[1]), particle).second)
      throw Error(fmt::format("{}:{}:1: id {} is twice in frame {}, expected once", path, number, v[1], v[0]));
    if (++particles > 10 * GaussianList::greatest)
      throw Error(fmt::format("{}:{}:1: more than {} particles", path, number, 10 * GaussianList::greatest));
  }
  if (frames.empty()) throw Error(fmt::format("{}: found no particle, expected at least one", path));
  return frames;
}

Frame interpolate(const Frames& frames, double frame) {
  const double first = frames.begin()->first, last = frames.rbegin()->first;
  if (!(frame >= first && frame <= last))
    throw Error(fmt::format("frame = {}, expected one from {} to {}", frame, first, last));
  const auto after = frames.upper_bound(frame);
  const auto before = std::prev(after);
  Frame out = before->second;
  if (after == frames.end()) return out;
  const double s = (frame - before->first) / (after->first - before->first);
  for (auto& [id, particle] : out) {
    const auto next = after->second.find(id);
    if (next == after->second.end()) continue;
    particle.position += s * (next->second.position - particle.position);
    particle.radius += s * (next->second.radius - particle.radius);
    particle.density += s * (next->second.density - particle.density);
  }
  return out;
}

}  // namespace airlight::fogshop::authoring
