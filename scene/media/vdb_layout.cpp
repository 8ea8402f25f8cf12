#include "scene/media/vdb_layout.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace airlight::scene {
namespace {

constexpr std::string_view float_tree = "Tree_float_5_4_3", vector_tree = "Tree_vec3s_5_4_3";
constexpr std::string_view half_suffix = "_HalfFloat";

[[noreturn]] void damaged(std::size_t at, const std::string& what) {
  throw std::runtime_error(fmt::format("damaged at byte {}: {}", at, what));
}

class Walk {
 public:
  Walk(std::string_view file, std::size_t at) : file_(file), at_(at) {}
  std::size_t at() const { return at_; }

  const char* take(std::uint64_t bytes) {
    if (bytes > file_.size() - at_)
      throw std::runtime_error(fmt::format("truncated or damaged: byte {} asks for {} more, the file has {}", at_,
                                           bytes, file_.size() - at_));
    const char* p = file_.data() + at_;
    at_ += bytes;
    return p;
  }
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)), sizeof(T));
    return value;
  }
  std::string text() {
    const std::uint32_t size = number<std::uint32_t>();
    return std::string(take(size), size);
  }
  void metadata() {
    const std::uint32_t count = number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
      text();
      text();
      take(number<std::uint32_t>());
    }
  }

 private:
  std::string_view file_;
  std::size_t at_;
};

// Maps are stored with their derived quantities; a uniform scale, which is all that we take, is one of these.
std::size_t transform_bytes(const std::string& type, std::size_t at) {
  if (type == "UniformScaleMap" || type == "ScaleMap") return 120;
  if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap") return 144;
  if (type == "TranslationMap") return 24;
  if (type == "AffineMap" || type == "UnitaryMap") return 128;
  if (type == "NonlinearFrustumMap") throw std::runtime_error("its transform is a frustum, expected a uniform scale");
  damaged(at, "unknown kind of transform");
}

// The tree below the root: children of 32^3, 16^3 and 8^3 slots. First the topology of all nodes, then the samples of
// the leaves in the same order.
class TreeWalk {
 public:
  // `numbers` of a sample: 1 or 3.
  TreeWalk(Walk& walk, std::uint32_t compression, int numbers, bool half)
      : walk_(walk), compression_(compression), sample_(numbers * sizeof(float)), half_(half) {}

  void run() {
    if (walk_.number<std::int32_t>() != 1) damaged(walk_.at(), "expected one buffer per tree");
    walk_.take(sample_);  // background
    const std::uint32_t tiles = walk_.number<std::uint32_t>(), children = walk_.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < tiles; ++i) walk_.take(sizeof(Origin) + sample_ + 1);
    Origin last{};
    for (std::uint32_t i = 0; i < children; ++i) {
      const Origin origin = walk_.number<Origin>();
      // OpenVDB sorts them: twice the same, or another order, and samples would go to the wrong place.
      if (i > 0 && origin <= last) damaged(walk_.at(), "nodes out of order");
      last = origin;
      node<5>();
    }
    for (const char* mask : leaf_masks_) {
      if (std::memcmp(walk_.take(leaf_mask_bytes), mask, leaf_mask_bytes) != 0)
        damaged(walk_.at(), "two different masks of one block of voxels");
      values(mask, 8 * leaf_mask_bytes);
    }
  }

 private:
  using Origin = std::array<std::int32_t, 3>;
  static constexpr std::size_t leaf_mask_bytes = 64;

  static bool is_on(const char* mask, std::size_t slot) { return mask[slot / 8] >> (slot % 8) & 1; }
  static std::size_t count_on(const char* mask, std::size_t slots) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < slots / 8; ++i) count += std::popcount(static_cast<unsigned char>(mask[i]));
    return count;
  }

  template <int log2>
  void node() {
    constexpr std::size_t slots = std::size_t(1) << (3 * log2);
    const char* children = walk_.take(slots / 8);
    const char* active = walk_.take(slots / 8);
    values(active, slots);
    for (std::size_t i = 0; i < slots; ++i) {
      if (!is_on(children, i)) continue;
      if constexpr (log2 == 5)
        node<4>();
      else
        leaf_masks_.push_back(walk_.take(leaf_mask_bytes));
    }
  }

  void values(const char* active, std::size_t slots) {
    // How inactive slots are told: by up to two values, by a mask that selects between two, or all are stored (6).
    const std::int8_t kind = walk_.number<std::int8_t>();
    if (kind < 0 || kind > 6) damaged(walk_.at(), "unknown coding of inactive voxels");
    if (kind == 2 || kind == 4 || kind == 5) walk_.take(sample_);
    if (kind == 5) walk_.take(sample_);
    if (kind == 3 || kind == 4 || kind == 5) walk_.take(slots / 8);
    const bool active_only = compression_ & 2 && kind != 6;
    const std::size_t count = active_only ? count_on(active, slots) : slots;
    if (count > 0 || !half_) chunk(count * (half_ ? sample_ / 2 : sample_));
  }

  void chunk(std::uint64_t bytes) {
    if (!(compression_ & 5)) {
      walk_.take(bytes);
      return;
    }
    // Positive: the length of compressed data; else that of plain data negated.
    const std::int64_t stored = walk_.number<std::int64_t>();
    const std::size_t at = walk_.at();
    bool possible = -std::uint64_t(stored) == bytes;
    const char* data = walk_.take(stored > 0 ? stored : bytes * possible);
    if (stored > 0) possible = compression_ & 4 ? is_blosc(data, stored, bytes) : bytes > 0;
    if (!possible) damaged(at, fmt::format("a block of {} bytes for {}", stored, bytes));
  }

  // A Blosc block begins with 16 bytes that repeat both lengths. There are blocks of nothing but these.
  static bool is_blosc(const char* data, std::uint64_t stored, std::uint64_t bytes) {
    if (stored < 16) return false;
    std::uint32_t lengths[3];  // plain, of a part, compressed
    std::memcpy(lengths, data + 4, sizeof lengths);
    return lengths[0] == bytes && lengths[2] == stored;
  }

  Walk& walk_;
  std::uint32_t compression_;
  std::size_t sample_;  // bytes of one in full
  bool half_;
  std::vector<const char*> leaf_masks_;
};

}  // namespace

bool is_of_type(const VdbEntry& entry, std::string_view type) {
  return entry.type == type || entry.type == std::string(type) + std::string(half_suffix);
}

namespace {

std::size_t end_of_grid(std::string_view file, const VdbEntry& entry) {
  Walk walk(file, entry.begin);
  const std::uint32_t compression = walk.number<std::uint32_t>();
  walk.metadata();
  const std::string transform = walk.text();
  walk.take(transform_bytes(transform, walk.at()));
  if (!entry.parent.empty()) return walk.at();
  const bool vectors = is_of_type(entry, vector_tree);
  TreeWalk(walk, compression, vectors ? 3 : 1, entry.type.ends_with(half_suffix)).run();
  return walk.at();
}

}  // namespace

std::vector<VdbEntry> vdb_grids(std::string_view file) {
  Walk walk(file, 0);
  if (file.size() < 8 || walk.number<std::int64_t>() != 0x56444220) throw std::runtime_error("not an OpenVDB file");
  const std::uint32_t version = walk.number<std::uint32_t>();
  if (version < 222 || version > 224)
    throw std::runtime_error(fmt::format("OpenVDB format version {}, expected 222 to 224", version));
  walk.take(8);  // library version
  const bool has_offsets = walk.number<char>() != 0;
  walk.take(36);  // identifier
  walk.metadata();
  const std::int32_t count = walk.number<std::int32_t>();
  if (count < 0) damaged(walk.at(), "a negative number of grids");

  std::vector<VdbEntry> entries;
  for (std::int32_t i = 0; i < count; ++i) {
    VdbEntry entry;
    entry.descriptor = walk.at();
    entry.unique_name = walk.text();
    entry.name = entry.unique_name.substr(0, entry.unique_name.find('\x1e'));
    entry.type = walk.text();
    entry.parent = walk.text();
    const std::int64_t begin = walk.number<std::int64_t>(), blocks = walk.number<std::int64_t>();
    const std::int64_t end = walk.number<std::int64_t>();
    if (has_offsets) {
      if (end > std::int64_t(file.size()))
        throw std::runtime_error(
            fmt::format("truncated: grid '{}' ends at byte {}, the file at {}", entry.name, end, file.size()));
      const bool has_blocks = entry.parent.empty();  // else OpenVDB leaves their offset at zero
      if (begin != std::int64_t(walk.at()) || end < begin || (has_blocks && (blocks < begin || end < blocks)))
        damaged(walk.at(), fmt::format("the offsets of grid '{}' are out of order", entry.name));
      entry.begin = begin;
      entry.end = end;
    } else {
      if (!(is_of_type(entry, float_tree) || is_of_type(entry, vector_tree)))
        throw std::runtime_error(fmt::format(
            "without offsets, and its grid '{}' of type {} hides where the next begins", entry.name, entry.type));
      entry.begin = walk.at();
      entry.end = end_of_grid(file, entry);
    }
    walk.take(entry.end - walk.at());
    entries.push_back(entry);
  }
  return entries;
}

void check_grid(std::string_view file, const VdbEntry& entry) {
  const std::size_t end = end_of_grid(file, entry);
  if (end != entry.end) damaged(end, fmt::format("grid '{}' ends here, expected at {}", entry.name, entry.end));
}

}  // namespace airlight::scene
