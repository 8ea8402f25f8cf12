// Range files: a line of text that says what it is, the accumulation as little-endian words, and an XXH3 checksum over
// everything before it.
#include <fmt/format.h>
#include <xxhash.h>

#include <cstring>
#include <string_view>

#include "reference/path_tracer/accumulation.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"

namespace airlight::path_tracer {
namespace {

constexpr std::string_view magic = "airlight path tracer samples, format 1\n";

class Writer {
 public:
  explicit Writer(std::string_view start) : bytes(start) {}
  template <class T>
  void word(T value) {
    static_assert(sizeof(T) == 8);
    bytes.append(reinterpret_cast<const char*>(&value), 8);
  }
  void text(const std::string& s) {
    word(std::uint64_t(s.size()));
    bytes += s;
  }
  void words(const std::vector<double>& v) {
    word(std::uint64_t(v.size()));
    bytes.append(reinterpret_cast<const char*>(v.data()), 8 * v.size());
  }
  std::string bytes;
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}
  template <class T>
  T word() {
    static_assert(sizeof(T) == 8);
    need(8);
    T value;
    std::memcpy(&value, bytes_.data() + at_, 8);
    at_ += 8;
    return value;
  }
  std::string text() {
    const auto size = word<std::uint64_t>();
    need(size);
    std::string s(bytes_.substr(at_, size));
    at_ += size;
    return s;
  }
  std::vector<double> words() {
    const auto size = word<std::uint64_t>();
    need(size > bytes_.size() ? bytes_.size() : 8 * size);
    std::vector<double> v(size);
    if (size > 0) std::memcpy(v.data(), bytes_.data() + at_, 8 * size);  // data() of nothing may be null
    at_ += 8 * size;
    return v;
  }
  bool finished() const { return at_ == bytes_.size(); }
  [[noreturn]] void fail(const std::string& what) const { throw Error(fmt::format("{}: {}", path_, what)); }

 private:
  void need(std::uint64_t count) const {
    if (count > bytes_.size() - at_) fail("the sample file ends too early");
  }
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::string path_;
};

constexpr std::uint64_t Counters::*const counter_fields[] = {
    &Counters::paths,   &Counters::rays,        &Counters::lookups,     &Counters::collisions,
    &Counters::columns, &Counters::shadow_rays, &Counters::connections, &Counters::violations};

}  // namespace

void write_range_file(const std::string& path, const Accumulation& a) {
  Writer out(magic);
  for (const std::string& s : {a.identity.scene, a.identity.view, a.identity.settings, a.identity.build}) out.text(s);
  out.word(std::uint64_t(a.identity.seed));
  out.word(std::uint64_t(a.identity.stream));
  out.word(std::int64_t(a.width));
  out.word(std::int64_t(a.height));
  out.word(std::int64_t(a.layout.orders));
  out.word(std::int64_t(a.layout.order_squares));
  out.word(a.seconds);
  for (const auto field : counter_fields) out.word(a.counters.*field);
  for (const auto& nodes : a.tiles) {
    out.word(std::uint64_t(nodes.size()));
    for (const TallyNode& node : nodes) {
      out.word(std::int64_t(node.level));
      out.word(node.index);
      out.word(node.count);
      out.words(node.sums);
    }
  }
  out.word(std::uint64_t(XXH3_64bits(out.bytes.data(), out.bytes.size())));
  scene::write_file_atomically(path, out.bytes);
}

Accumulation read_range_file(const std::string& path) {
  const std::string bytes = scene::read_whole_file(path, std::size_t(1) << 40);
  if (bytes.size() < magic.size() + 8 || std::string_view(bytes).substr(0, magic.size()) != magic)
    throw Error(fmt::format("{}: not a file of path tracer samples", path));
  const std::string_view body(bytes.data(), bytes.size() - 8);
  std::uint64_t checksum;
  std::memcpy(&checksum, bytes.data() + body.size(), 8);
  if (checksum != XXH3_64bits(body.data(), body.size()))
    throw Error(fmt::format("{}: the checksum is wrong, the file is damaged", path));

  Reader in(body.substr(magic.size()), path);
  Accumulation a;
  for (std::string* s : {&a.identity.scene, &a.identity.view, &a.identity.settings, &a.identity.build}) *s = in.text();
  a.identity.seed = std::uint32_t(in.word<std::uint64_t>());
  a.identity.stream = std::uint32_t(in.word<std::uint64_t>());
  const auto width = in.word<std::int64_t>(), height = in.word<std::int64_t>();
  const auto orders = in.word<std::int64_t>(), squares = in.word<std::int64_t>();
  if (width < 1 || height < 1 || width > 1 << 24 || height > 1 << 24 || orders < 1 || orders > most_orders)
    in.fail("film size or layers out of range");
  a.width = int(width);
  a.height = int(height);
  a.layout = {int(orders), squares != 0};
  a.seconds = in.word<double>();
  for (const auto field : counter_fields) a.counters.*field = in.word<std::uint64_t>();
  // A tile takes 8 bytes at least: more of them than that cannot be true, and would only cost memory.
  const double tiles = double(a.tiles_across()) * a.tiles_down();
  if (tiles > double(bytes.size()) / 8) in.fail("the sample file ends too early");
  a.tiles.resize(std::size_t(tiles));
  for (int tile = 0; tile < int(a.tiles.size()); ++tile) {
    const int x0 = tile % a.tiles_across() * tile_size, y0 = tile / a.tiles_across() * tile_size;
    const std::size_t doubles = std::size_t(a.layout.doubles()) * (std::min(x0 + tile_size, a.width) - x0) *
                                (std::min(y0 + tile_size, a.height) - y0);
    const auto count = in.word<std::uint64_t>();
    for (std::uint64_t n = 0; n < count; ++n) {
      TallyNode node;
      node.level = int(in.word<std::int64_t>());
      node.index = in.word<std::uint64_t>();
      node.count = in.word<std::uint64_t>();
      node.sums = in.words();
      const bool fits = node.level >= leaf_level && node.level <= 50 && node.index >> (62 - node.level) == 0 &&
                        node.count >= 1 && node.count <= std::uint64_t(1) << node.level;
      if (node.sums.size() != doubles || !fits) in.fail("a block of samples is malformed");
      insert(a.layout, a.tiles[tile], std::move(node));
    }
  }
  if (!in.finished()) in.fail("there is something after the samples");
  return a;
}

}  // namespace airlight::path_tracer
