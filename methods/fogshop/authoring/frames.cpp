#include "methods/fogshop/authoring/frames.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "methods/fogshop/authoring/gaussian_list.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"
#include "scene/load/parts.h"

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

void require_within(double frame, double first, double last) {
  if (!(frame >= first && frame <= last))
    throw Error(fmt::format("frame = {}, expected one from {} to {}", frame, first, last));
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

Frames read_frames_around(const std::string& path, double frame) {
  namespace fs = std::filesystem;
  const std::string name = fs::path(path).filename().string();
  const std::size_t first = name.find('#'), last = name.rfind('#');
  if (first == std::string::npos || name.find_first_not_of('#', first) <= last)
    throw Error(path + ": expected the digits of the frame in one place of the file's name, as in smoke_####.csv");
  const std::string head = name.substr(0, first), tail = name.substr(last + 1);
  const std::size_t least_digits = last + 1 - first;
  const fs::path folder = fs::path(path).parent_path();
  std::map<double, std::string> files;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, code)) {
    const std::string file = entry.path().filename().string();
    if (file.size() < head.size() + least_digits + tail.size() || !file.starts_with(head) || !file.ends_with(tail))
      continue;
    const std::string digits = file.substr(head.size(), file.size() - head.size() - tail.size());
    int number = 0;
    const auto [stop, wrong] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (wrong == std::errc() && digits == fmt::format("{:0{}}", number, least_digits)) files[number] = file;
  }
  if (files.empty()) throw Error(path + ": there is no file of this name, expected a number in the place of #");
  require_within(frame, files.begin()->first, files.rbegin()->first);

  Frames frames;
  const auto before = std::prev(files.upper_bound(frame)), end = std::next(before, before->first == frame ? 1 : 2);
  for (auto of = before; of != end; ++of) {
    const std::string table = (folder / of->second).string();
    std::vector<int> ids;
    const std::vector<scene::Gaussian> gaussians = scene::load::read_gaussians_csv(table, &ids);
    if (ids.size() != gaussians.size())
      throw Error(table + ":1:1: found no ids, expected a first column of them, as airlight fit writes it");
    Frame& particles = frames[of->first];
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const scene::Gaussian& g = gaussians[i];
      if (!(g.amplitude >= 0))
        throw Error(fmt::format("{}: id {}: amplitude = {}, expected a number >= 0", table, ids[i], g.amplitude));
      if (!particles.emplace(ids[i], FrameParticle{g.center, g.width, g.amplitude}).second)
        throw Error(fmt::format("{}: id {} is twice in the table, expected once", table, ids[i]));
    }
  }
  return frames;
}

Frame interpolate(const Frames& frames, double frame) {
  require_within(frame, frames.begin()->first, frames.rbegin()->first);
  const auto after = frames.upper_bound(frame);
  const auto before = std::prev(after);
  Frame out = before->second;
  if (after == frames.end()) return out;
  const double s = (frame - before->first) / (after->first - before->first);
  for (auto& [id, particle] : out) {
    const auto next = after->second.find(id);
    if (next == after->second.end()) {
      particle.density *= 1 - s;
      continue;
    }
    particle.position += s * (next->second.position - particle.position);
    particle.radius += s * (next->second.radius - particle.radius);
    particle.density += s * (next->second.density - particle.density);
  }
  for (const auto& [id, particle] : after->second)
    if (const auto [place, born] = out.emplace(id, particle); born) place->second.density *= s;
  return out;
}

}  // namespace airlight::fogshop::authoring
