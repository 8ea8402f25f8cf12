#include "reference/path_tracer/tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::path_tracer {
namespace {

void add(const Rgb& value, double* sums, int entry) {
  for (int c = 0; c < 3; ++c) sums[3 * entry + c] += value[c];
}

bool siblings(const TallyNode& left, const TallyNode& right) {
  return left.complete() && right.complete() && left.level == right.level && left.index % 2 == 0 &&
         right.index == left.index + 1;
}

// Sum, or maximum for the entry that is one; batches are left to the caller.
void combine(const TallyLayout& layout, const double* from, double* into) {
  const int greatest = 3 * layout.greatest(), batches = 3 * layout.batch(0);
  for (int i = 0; i < batches; ++i)
    into[i] = i >= greatest && i < greatest + 3 ? std::max(into[i], from[i]) : into[i] + from[i];
}

}  // namespace

bool add_sample(const TallyLayout& layout, const PathSample& sample, int batch, double* sums) {
  const Rgb total = sample.total();
  if (!((total * total).isFinite().all() && sample.truncated.isFinite().all())) return false;
  add(total, sums, layout.mean());
  add(total * total, sums, layout.square());
  for (int c = 0; c < 3; ++c) {
    double& greatest = sums[3 * layout.greatest() + c];
    greatest = std::max(greatest, total[c]);
  }
  add(total.min(0.0), sums, layout.negative());
  add(sample.truncated, sums, layout.truncated());
  add(sample.airlight, sums, layout.airlight());
  add(sample.surface, sums, layout.surface());
  for (int m = 0; m <= layout.orders + 1; ++m) add(sample.order[m], sums, layout.order(m));
  if (layout.order_squares)
    for (int m = 0; m <= layout.orders + 1; ++m) add(sample.order[m] * sample.order[m], sums, layout.order_square(m));
  add(total, sums, layout.batch(batch));
  return true;
}

TallyNode join(const TallyLayout& layout, const TallyNode& left, const TallyNode& right) {
  TallyNode joined{left.level + 1, left.index / 2, left.count + right.count, left.sums};
  const int stride = layout.doubles(), first = 3 * layout.batch(0);
  for (std::size_t pixel = 0; pixel < left.sums.size() / stride; ++pixel) {
    const double* l = &left.sums[pixel * stride];
    const double* r = &right.sums[pixel * stride];
    double* into = &joined.sums[pixel * stride];
    combine(layout, r, into);
    // Sixteenths of the joined range are pairs of sixteenths of its halves.
    for (int b = 0; b < batch_count / 2; ++b)
      for (int c = 0; c < 3; ++c) {
        const int from = first + 6 * b + c;
        into[first + 3 * b + c] = l[from] + l[from + 3];
        into[first + 3 * (b + batch_count / 2) + c] = r[from] + r[from + 3];
      }
  }
  return joined;
}

void insert(const TallyLayout& layout, std::vector<TallyNode>& nodes, TallyNode node) {
  auto place = std::upper_bound(nodes.begin(), nodes.end(), node.begin(),
                                [](std::uint64_t begin, const TallyNode& n) { return begin < n.begin(); });
  const auto refuse = [&](const TallyNode& other) {
    throw Error(fmt::format("samples {}..{} and {}..{} overlap, expected disjoint ranges", other.begin(), other.end(),
                            node.begin(), node.end()));
  };
  if (place != nodes.end() && place->begin() < node.end()) refuse(*place);
  if (place != nodes.begin() && std::prev(place)->end() > node.begin()) refuse(*std::prev(place));
  place = nodes.insert(place, std::move(node));
  for (;;) {
    if (place != nodes.begin() && siblings(*std::prev(place), *place)) {
      *std::prev(place) = join(layout, *std::prev(place), *place);
      place = std::prev(nodes.erase(place));
    } else if (std::next(place) != nodes.end() && siblings(*place, *std::next(place))) {
      *place = join(layout, *place, *std::next(place));
      place = std::prev(nodes.erase(std::next(place)));
    } else {
      return;
    }
  }
}

TallyNode fold(const TallyLayout& layout, const std::vector<TallyNode>& nodes) {
  if (nodes.empty()) return {};
  TallyNode total = nodes.front();
  const int stride = layout.doubles(), batches = 3 * layout.batch(0);
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    total.count += nodes[n].count;
    for (std::size_t pixel = 0; pixel < total.sums.size() / stride; ++pixel) {
      double* into = &total.sums[pixel * stride];
      const double* from = &nodes[n].sums[pixel * stride];
      combine(layout, from, into);
      for (int i = batches; i < stride; ++i) into[i] += from[i];
    }
  }
  return total;
}

std::vector<DyadicBlock> dyadic_cover(std::uint64_t begin, std::uint64_t end, int most_level) {
  if (begin % leaf_samples != 0)
    throw Error(fmt::format("samples {}..{}: {} is not a multiple of {}", begin, end, begin, leaf_samples));
  std::vector<DyadicBlock> blocks;
  while (begin < end) {
    int level = leaf_level;
    while (level < most_level && (begin & (std::uint64_t(1) << level)) == 0 &&
           begin + (std::uint64_t(2) << level) <= end)
      ++level;
    const std::uint64_t count = std::min(end - begin, std::uint64_t(1) << level);
    blocks.push_back({level, begin >> level, count});
    begin += count;
  }
  return blocks;
}

}  // namespace airlight::path_tracer
