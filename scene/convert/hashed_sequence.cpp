#include "scene/convert/hashed_sequence.h"

#include <algorithm>

namespace airlight::scene {

using Eigen::Vector3i;

Vector3i HashedSequence::tile(const Vector3i& size, int frame) {
  const int i = frame % frames_per_table;
  return Vector3i(i % 3, i / 3 % 3, i / 9).cwiseProduct(size);
}

int HashedSequence::value(int frame, const Vector3i& p) const {
  if ((p.array() < 0).any() || (p.array() >= size.array()).any()) return 0;
  return tables[std::size_t(frame / frames_per_table)].value_by_tag(tile(size, frame) + p);
}

HashedSequence hashed_sequence(const Vector3i& size, const std::vector<std::vector<std::int8_t>>& frames,
                               const HashOptions& options) {
  HashedSequence result;
  result.size = size;
  result.frames = int(frames.size());
  for (int first = 0; first < result.frames; first += HashedSequence::frames_per_table) {
    std::vector<HashedVoxel> voxels;
    const int end = std::min(result.frames, first + HashedSequence::frames_per_table);
    for (int frame = first; frame < end; ++frame)
      for (HashedVoxel voxel : hashed_voxels(size, frames[std::size_t(frame)])) {
        voxel.position += HashedSequence::tile(size, frame);
        voxels.push_back(voxel);
      }
    result.tables.push_back(perfect_hash(3 * size, voxels, options));
  }
  return result;
}

}  // namespace airlight::scene
