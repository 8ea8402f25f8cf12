// Residuals of a sequence in hashes of 27 frames each, tiled 3 x 3 x 3 into one domain. Zhou et al. 2008, section 5.2.
#pragma once
#include <vector>

#include "scene/convert/perfect_hash.h"

namespace airlight::scene {

struct HashedSequence {
  static constexpr int frames_per_table = 27;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();  // of a frame
  int frames = 0;
  std::vector<PerfectHash> tables;  // each of 3 size; the last may have tiles without voxels

  // Where frame `frame` of its table begins in the domain; x fastest.
  static Eigen::Vector3i tile(const Eigen::Vector3i& size, int frame);
  // 0 outside the frame.
  int value(int frame, const Eigen::Vector3i& position) const;
};

// Levels of the frames, each of size.prod(), x fastest. Throws Error as perfect_hash.
HashedSequence hashed_sequence(const Eigen::Vector3i& size, const std::vector<std::vector<std::int8_t>>& frames,
                               const HashOptions& = {});

}  // namespace airlight::scene
