#include "gpu/ray_marcher/rounds.h"

#include <algorithm>

#include "gpu/ray_marcher/interface.h"
#include "scene/renderer.h"

namespace airlight::gpu::ray_marcher {
namespace {

constexpr int software_budget = 3000, hardware_budget = 100000;  // iterations of loops, about
constexpr int software_tiles = 64, hardware_tiles = 4096;        // of a dispatch between two looks at `progress`

}  // namespace

void Rounds::begin(bool looks, const std::function<bool(double)>& progress) {
  looks_ = looks || known_ == 0 || progress;
  progress_ = progress;
  bands_.clear();
}

void Rounds::run(Program& p, FrameBuffers& buffers, int tiles) {
  Buffer& rounds = buffers.get(name_of(bands_.size()), 4 * (12 + 3 * std::size_t(tiles)));
  p.set("tile_count", tiles);
  p.set("budget", budget > 0 ? budget : context_.software() ? software_budget : hardware_budget);
  const int at_once = progress_ ? (context_.software() ? software_tiles : hardware_tiles) : tiles;
  int taken = 1;
  for (int first = 0; first < tiles; first += at_once) {
    rounds.clear();
    rounds.bind(at::rounds);
    p.set("first_tile", first);
    const int count = std::min(at_once, tiles - first);
    for (int round = 0; looks_ || round < 2 * known_; ++round) {
      p.set("round_", round);
      if (round == 0)
        p.dispatch(count * tile, tile);
      else
        p.dispatch_indirect(rounds, 12 * (round & 3));
      taken = std::max(taken, round + 1);
      if (progress_ && !progress_(double(first) / tiles)) throw scene::Interrupted("interrupted");
      if (looks_ && rounds.download<int>()[3 * ((round + 1) & 3)] == 0) break;
    }
  }
  if (looks_) known_ = std::max(known_, taken);
  bands_.push_back({&rounds, taken & 3});
}

void Rounds::note(Download& download) const {
  for (std::size_t i = 0; i < bands_.size(); ++i) download.add_values(name_of(i), *bands_[i].buffer, 48);
}

bool Rounds::unfinished(const Download& download) const {
  for (std::size_t i = 0; i < bands_.size(); ++i) {
    const std::vector<int> groups = download.values<int>(name_of(i));
    if (!groups.empty() && groups[3 * bands_[i].last] != 0) return true;
  }
  return false;
}

}  // namespace airlight::gpu::ray_marcher
