// Grids of numbers over a map in one buffer of the device, and filters between them: Mallat's
// decomposition in single precision (methods/wavelet_fog/decomposition.h). Passes are recorded once and
// run again whenever the first grid changes.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/wavelet_fog/interface.h"
#include "methods/wavelet_fog/decomposition.h"

namespace airlight::gpu::wavelet_fog {

using airlight::wavelet_fog::Taps;

class Grids {
 public:
  explicit Grids(Context& context) : context_(context) {}

  // A grid of zeros with a rim of zeros on every side; its number. Grid 0 is the one that is written from here.
  int add(const scene::IndexRange&, int rim = 0);
  // Adds a grid in memory that is shared with other grids since the last reuse_scratch: contents undefined.
  int scratch(const scene::IndexRange&);
  void reuse_scratch() { scratch_used_ = 0; }
  const scene::IndexRange& range(int grid) const { return ranges_[grid]; }
  const GridData& data(int grid) const { return data_[grid]; }

  // The passes run over grids in the order of these calls.
  // Downsampling along u, then along v, over the range of coarse_range.
  void down(int from, const Taps& along_u, const Taps& along_v, int to);
  // Upsampling: to = sum if `added` is -1, else added + sign sum. `to` may equal `added`.
  void up(int from, const Taps& along_u, const Taps& along_v, int to, int added = -1, double sign = 1);
  // Sets values below 0 to 0 and restores the sum.
  void clamp(int from, int to);
  // Records another program that runs over all of grid `to`: `set` gives it its uniforms. The caller of run binds what
  // it needs beyond values and grids.
  void pass(Program&, std::function<void(Program&)> set, const scene::IndexRange& invocations);

  // After the last of these: the buffers. Throws Unavailable where the device's are smaller.
  void allocate();
  // Values of grid 0, u fastest.
  void upload(const std::vector<double>&);
  // All passes.
  void run() const;

  void bind() const;
  // For tests: waits.
  std::vector<double> download(int grid) const;

 private:
  struct Pass {
    Program* program;
    std::function<void(Program&)> set;
    int columns, rows;
  };
  int place(const scene::IndexRange&, int rim, bool scratch);
  void filter(bool up, int from, int axis, const Taps&, int to, int added, double sign);

  Context& context_;
  std::vector<scene::IndexRange> ranges_;
  std::vector<GridData> data_;
  std::vector<bool> in_scratch_;
  std::size_t kept_ = 0, scratch_used_ = 0, scratch_ = 0;  // values
  std::vector<Pass> passes_;
  std::unique_ptr<Buffer> table_, values_;
};

}  // namespace airlight::gpu::wavelet_fog
