// One medium on the device: its map, what is made of it there, and the optical depths of rays. The twin of
// methods/wavelet_fog/leveled_fog.h.
#pragma once
#include <memory>
#include <vector>

#include "gpu/frame.h"
#include "gpu/wavelet_fog/grids.h"
#include "methods/wavelet_fog/options.h"

namespace airlight::gpu::wavelet_fog {

// Bytes of the block of fog.glsl: media, then the knots of all.
std::vector<char> bytes_of(const std::vector<FogData>&, const std::vector<double>& knots);
// NAME_POINTS, _NODES and _WEIGHTS of a Gauss rule on [0, 1].
void add_rule(Definitions&, const std::string& prefix, int points);

class FogOnDevice {
 public:
  // The medium is a fogmap, `number` tells it from others of the frame. Throws Unavailable where the device has no room for its
  // map. `light_rays`: dim will be called.
  FogOnDevice(Context&, const scene::Medium&, const airlight::wavelet_fog::Options&, int number, bool light_rays);

  // The next frame's medium, where grids keep their sizes: then `become` may follow. Coefficients go up only where they are others;
  // what is made of them is made again on the device, by refresh().
  bool fits(const scene::Medium&) const;
  void become(const scene::Medium&);
  bool stale() const { return stale_; }
  void refresh();

  // Fills the table of variant polar; must precede add_depths. `counts`: cells are counted.
  void fill_table(const scene::View&, FrameBuffers&, const Buffer& counters, bool counts);
  // Adds the depths of a view's rays to `depths` (4 floats a pixel; starts from 0 if `first`), up to
  // `distances` [m] unless null.
  void add_depths(const scene::View&, const Buffer* distances, const Buffer& depths, const Buffer& counters, bool first,
                  bool counts);
  // Light of a lamp that surfaces reflect, dimmed by this medium on its way to them. The program must
  // know the lamp before.
  Program& light_rays() { return *light_rays_; }
  void dim(const scene::View&, const Buffer& lit);

  // For other programs over the same map: what they are compiled with, and the buffers.
  Definitions definitions() const;
  void bind() const;
  const scene::Medium& medium() const { return medium_; }
  const FogData& data() const { return data_; }
  const std::vector<double>& knots() const { return knots_; }
  const GridData& grid(int number) const { return grids_.data(number); }
  std::size_t words() const { return emptiness_->bytes() / 4; }  // of empty cells

 private:
  void add_grids();
  void add_wavelets(Definitions&) const;
  void add_table(Definitions&);
  void add_bands(const std::vector<int>& grids);
  void add_blocks(bool errors);
  void add_errors(const std::vector<scene::IndexRange>& blocks);
  int add_levels(const std::vector<scene::IndexRange>& blocks, std::size_t first);
  Program& blocks_program(const char* stage);
  void find_greatest(int from, int less, int to);
  void gather_greatest(int from, int to);
  void write(const scene::Medium&);  // settings and profile

  Context& context_;
  airlight::wavelet_fog::Options options_;
  scene::Medium medium_;
  int number_;
  Grids grids_;
  FogData data_{};
  std::vector<double> knots_;  // heights and factors, alternating
  std::unique_ptr<Buffer> fog_, emptiness_, path_table_;
  Program *camera_rays_ = nullptr, *light_rays_ = nullptr, *table_steps_ = nullptr,
          *table_sums_ = nullptr;  // null: not needed
  struct Table {
    int angles = 0, first = 0, steps = 0;
    double span = 0, spacing = 0, middle = 0;  // [rad]
  } table_;
  const Buffer* table_buffer_ = nullptr;
  int parts_ = 1;  // of a ray, a dispatch each: where the driver ends loops (gpu/README.md) long ones are divided
  bool stale_ = true;
};

}  // namespace airlight::gpu::wavelet_fog
