// Sums over samples, kept per dyadic block so that any split of the samples gives the same bits.
//
// Node (level, index) covers samples [index 2^level, (index + 1) 2^level). The leaves (level 6, 64 samples) are summed
// in sample order; two siblings join as left + right. Whatever ranges are computed where, joining siblings leads to the
// same nodes, and the final fold runs over the remaining nodes in index order.
#pragma once
#include <cstdint>
#include <vector>

#include "reference/path_tracer/path_sample.h"

namespace airlight::path_tracer {

inline constexpr int leaf_level = 6;
inline constexpr std::uint64_t leaf_samples = 64;
inline constexpr int batch_count = 16;

// Where what lies among the doubles of one pixel; each entry is three of them, one per channel.
struct TallyLayout {
  int orders = 4;  // K
  bool order_squares = false;

  int mean() const { return 0; }
  int square() const { return 1; }    // of the total, for its variance
  int greatest() const { return 2; }  // the largest sample: joined by maximum, not by sum
  int negative() const { return 3; }  // sum of the negative totals
  int truncated() const { return 4; }
  int airlight() const { return 5; }
  int surface() const { return 6; }
  int order(int m) const { return 7 + m; }  // m = 0 .. K, K + 1 is the rest
  int order_square(int m) const { return 9 + orders + m; }
  int batch(int b) const { return order_square(0) + (order_squares ? orders + 2 : 0) + b; }
  int entries() const { return batch(batch_count); }
  int doubles() const { return 3 * entries(); }
  bool operator==(const TallyLayout&) const = default;
};

// Sums of a set of pixels (those of a tile, or one ray).
struct TallyNode {
  int level = leaf_level;
  std::uint64_t index = 0;
  std::uint64_t count = 0;   // samples: 2^level, or fewer in a leaf that ends the range
  std::vector<double> sums;  // doubles() per pixel

  std::uint64_t begin() const { return index << level; }
  std::uint64_t end() const { return begin() + count; }
  bool complete() const { return count == std::uint64_t(1) << level; }
};

// Adds one sample to the sums of one pixel; `batch` is the sixteenth of the node it falls into. Returns false if it
// holds a NaN or an infinity, or its square is one.
bool add_sample(const TallyLayout&, const PathSample&, int batch, double* sums);

// left + right: siblings, both complete.
TallyNode join(const TallyLayout&, const TallyNode& left, const TallyNode& right);

// Inserts a node into a list in index order and joins siblings as far as they go. Throws Error if it overlaps.
void insert(const TallyLayout&, std::vector<TallyNode>& nodes, TallyNode node);

// All nodes of a list folded in index order; count is their total. Empty list: empty sums.
TallyNode fold(const TallyLayout&, const std::vector<TallyNode>& nodes);

// [begin, end) as the dyadic blocks that cover it, largest first where they fit, none above `most_level`. begin must be
// a multiple of 64; the last one may be a part of a leaf.
struct DyadicBlock {
  int level;
  std::uint64_t index;
  std::uint64_t count;
};
std::vector<DyadicBlock> dyadic_cover(std::uint64_t begin, std::uint64_t end, int most_level = 60);

}  // namespace airlight::path_tracer
