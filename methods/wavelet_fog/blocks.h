// Bounds for blocks of 2^l x 2^l cells: whether a block is empty, and the error of the coarser grid. Rays pass empty
// blocks at once and read coarse grids where the error allows.
#pragma once
#include <vector>

#include "methods/wavelet_fog/levels.h"

namespace airlight::wavelet_fog {

class Blocks {
 public:
  // Blocks of the map and of its coarser grids. Errors are computed only if `errors` is set.
  Blocks(const Levels&, int most_level, bool errors);

  int most_level() const { return int(level_.size()) - 1; }
  // The level of the largest block around the cell in which there is nothing; -1 if there is something in the cell.
  int empty_level(int i, int j) const;
  // The coarsest level whose grid differs from the map by at most `most` in the whole block around the cell.
  int level_within(int i, int j, double most) const;

 private:
  struct Level {
    int lo[2], size[2];           // blocks
    std::vector<float> greatest;  // |coefficient| that reaches the block
    std::vector<float> error;     // of grid l, over the block: greatest |c - P^l c_l|
  };
  const Level& at(int level) const { return level_[level]; }
  static std::size_t index(const Level&, int level, int i, int j);
  std::vector<Level> level_;
};

// Integral of f h over t, which ends, with empty blocks passed at once; exact. Ends once the sum exceeds `enough`.
double skipped_depth(const Levels&, const Blocks&, const scene::HeightProfile&, const scene::MapLine&, Interval t,
                     double enough, Visits&);

// Like skipped_depth, but uses in each block the coarsest level with an error of at most `most` [per metre of t].
double bounded_depth(const Levels&, const Blocks&, const scene::HeightProfile&, const scene::MapLine&, Interval t,
                     double most, double enough, Visits&);

}  // namespace airlight::wavelet_fog
