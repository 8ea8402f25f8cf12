// Dispatches of a compute shader that does a limited amount of work for every tile of an image, until all are done.
//
// llvmpipe ends all loops of eight invocations together after 65535 iterations, silently; on a GPU what counts is that a
// dispatch does not last. So an invocation stops by itself, and which tiles go on the device writes down as the groups of
// the next dispatch (rounds.glsl): the host looks at nothing in a warm frame. How many rounds there are it learns once, by
// looking, and then takes twice as many; those that find nothing to do have no groups.
#pragma once
#include <functional>

#include "gpu/frame.h"
#include "gpu/program.h"

namespace airlight::gpu::ray_marcher {

class Rounds {
 public:
  static constexpr int tile = 8;  // pixels, to both sides: a work group
  // Iterations of loops that a pixel does in a dispatch, about; 0: as suits the device. Tests set it, to have rounds on any device.
  static inline int budget = 0;

  Rounds(Context& context, std::string name) : context_(context), name_(std::move(name)) {}

  // Begins a frame. With `looks`, or if no frame was looked at yet, the host checks every round. With `progress`,
  // dispatches take about a tenth of a second.
  void begin(bool looks, const std::function<bool(double done)>& progress);
  // All tiles of an image, or of a band of it; its buffers are bound, binding 13 is this one's. Throws scene::Interrupted
  // if asked to stop.
  void run(Program&, FrameBuffers&, int tiles);
  // Asks for what says whether all was done, and reads it after Frame::finish.
  void note(Download&) const;
  bool unfinished(const Download&) const;

 private:
  std::string name_of(std::size_t band) const { return "rounds, " + name_ + " " + std::to_string(band); }

  Context& context_;
  std::string name_;
  bool looks_ = true;
  std::function<bool(double)> progress_;
  int known_ = 0;  // rounds that a frame took; 0: not known
  struct Band {
    const Buffer* buffer;
    int last;  // slot of the round after the last one
  };
  std::vector<Band> bands_;  // of this frame
};

}  // namespace airlight::gpu::ray_marcher
