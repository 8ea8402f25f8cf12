// The nodes of an adaptive volumetric shadow map (Salvi, Vidimce, Lauritzen, Lefohn 2010, section 4): a curve of
// transmittance as at most n straight lines' ends.
#pragma once
#include <algorithm>
#include <cmath>

#include "reference/light_map/options.h"
#include "scene/math/types.h"

namespace airlight::light_map {

struct Node {
  double depth;
  double transmittance;
};

class Nodes {
 public:
  // `most`: 2 to most_nodes.
  explicit Nodes(int most) : most_(most) {}

  bool empty() const { return count_ == 0; }
  int count() const { return count_; }
  const Node& operator[](int i) const { return nodes_[i]; }

  // Appends a node behind all others. If there are more than `most`, removes the inner node whose removal changes the
  // area least, the first of several.
  void add(const Node& node) {
    nodes_[count_] = node;
    areas_[count_] = infinity;  // an end never goes
    ++count_;
    measure(count_ - 2);
    if (count_ <= most_) return;
    const auto least = std::min_element(areas_, areas_ + count_) - areas_;
    std::copy(nodes_ + least + 1, nodes_ + count_, nodes_ + least);
    std::copy(areas_ + least + 1, areas_ + count_, areas_ + least);
    --count_;
    measure(int(least) - 1);
    measure(int(least));
  }

 private:
  // Twice the area between the curve with node i and the curve without it.
  void measure(int i) {
    if (i < 1 || i > count_ - 2) return;
    const Node &a = nodes_[i - 1], &b = nodes_[i], &c = nodes_[i + 1];
    areas_[i] = std::abs((c.depth - a.depth) * (b.transmittance - a.transmittance) -
                         (b.depth - a.depth) * (c.transmittance - a.transmittance));
  }

  int most_, count_ = 0;
  Node nodes_[most_nodes + 1];
  double areas_[most_nodes + 1];
};

}  // namespace airlight::light_map
