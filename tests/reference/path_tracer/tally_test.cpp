// Sums do not depend on how the samples were split.
#include "reference/path_tracer/tally.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "scene/base/error.h"
#include "scene/math/random.h"

namespace tally_test {

using namespace airlight;
using namespace airlight::path_tracer;

namespace {

const TallyLayout layout{3, true};

// Numbers of very different size, so that any other order of additions shows in the last bits.
PathSample sample_number(std::uint64_t number) {
  PathSample sample(layout.orders);
  for (int m = 0; m <= layout.orders + 1; ++m) {
    const RandomBlock block = SampleRandom(1, 1, 0, number).block(m, Purpose::camera);
    sample.add(m, 0, Rgb(block.coarse(0), std::exp(20 * block.coarse(1)), -std::exp(-20 * block.coarse(2))));
  }
  return sample;
}

// Leaf by leaf, one pixel.
std::vector<TallyNode> sums_of(std::uint64_t begin, std::uint64_t end) {
  std::vector<TallyNode> nodes;
  for (; begin < end; begin += leaf_samples) {
    TallyNode node{leaf_level, begin >> leaf_level, std::min(leaf_samples, end - begin), {}};
    node.sums.assign(layout.doubles(), 0.0);
    for (std::uint64_t i = 0; i < node.count; ++i)
      REQUIRE(add_sample(layout, sample_number(begin + i), int(i * batch_count / node.count), node.sums.data()));
    insert(layout, nodes, std::move(node));
  }
  return nodes;
}

}  // namespace

TEST_CASE("ranges merged in any order give the same bits", "[path_tracer]") {
  const std::uint64_t end = 64 * 23;
  const std::vector<TallyNode> whole = sums_of(0, end);
  CHECK(whole.size() == 4);  // 23 = 16 + 4 + 2 + 1
  const TallyNode expected = fold(layout, whole);
  std::mt19937 shuffle(5);
  for (int attempt = 0; attempt < 50; ++attempt) {
    std::vector<std::uint64_t> cuts = {0, 64 * (1 + shuffle() % 7), 64 * (8 + shuffle() % 7), 64 * (15 + shuffle() % 7),
                                       end};
    std::vector<std::vector<TallyNode>> parts;
    for (std::size_t i = 1; i < cuts.size(); ++i) parts.push_back(sums_of(cuts[i - 1], cuts[i]));
    std::shuffle(parts.begin(), parts.end(), shuffle);
    std::vector<TallyNode> merged;
    for (auto& part : parts)
      for (auto& node : part) insert(layout, merged, node);
    CHECK(merged.size() == whole.size());
    CHECK(fold(layout, merged).sums == expected.sums);
  }
}

TEST_CASE("sixteen batches hold equal shares of the samples, also across joins", "[path_tracer]") {
  for (const std::uint64_t n : {std::uint64_t(16), std::uint64_t(64), std::uint64_t(1024), std::uint64_t(64 * 12)}) {
    const TallyNode node = fold(layout, sums_of(0, n));
    double total = 0;
    for (int b = 0; b < batch_count; ++b) total += node.sums[3 * layout.batch(b)];
    CHECK(total == Approx(node.sums[3 * layout.mean()]).epsilon(1e-13));
    // The first of a power of two is the sum of its first sixteenth.
    if ((n & (n - 1)) == 0) {
      double first = 0;
      for (std::uint64_t i = 0; i < n / 16; ++i) first += sample_number(i).total()[0];
      CHECK(node.sums[3 * layout.batch(0)] == Approx(first).epsilon(1e-13));
    }
  }
}

TEST_CASE("overlapping ranges are refused", "[path_tracer]") {
  std::vector<TallyNode> nodes = sums_of(0, 128);
  auto again = sums_of(64, 192);
  CHECK_THROWS_AS(insert(layout, nodes, again.front()), Error);
}

TEST_CASE("dyadic blocks cover a range exactly, with at most 2 log2(n) of them", "[path_tracer]") {
  for (const auto& [begin, end] : {std::pair<std::uint64_t, std::uint64_t>{0, 1},
                                   {0, 64},
                                   {64, 64 * 1000 + 17},
                                   {64 * 3, 64 * 4},
                                   {64 * 7, (std::uint64_t(1) << 40) + 64}}) {
    std::uint64_t at = begin;
    const auto blocks = dyadic_cover(begin, end);
    for (const DyadicBlock& block : blocks) {
      CHECK(block.index << block.level == at);
      at += block.count;
    }
    CHECK(at == end);
    CHECK(blocks.size() <= 2 * 41);
  }
  CHECK_THROWS_AS(dyadic_cover(32, 64), Error);
}

TEST_CASE("a sample that is not finite is noticed", "[path_tracer]") {
  std::vector<double> sums(layout.doubles(), 0.0);
  PathSample sample(layout.orders);
  sample.add(1, 0, Rgb(1, std::nan(""), 1));
  CHECK_FALSE(add_sample(layout, sample, 0, sums.data()));
}

}  // namespace tally_test
