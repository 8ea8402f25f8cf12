// A three-dimensional texture on the device: one or four 32-bit floats a texel, read by texelFetch alone.
//
// Shaders interpolate by hand in single precision. The hardware's trilinear filter has weights of 8 fractional bits:
// steps of 1/256 of the difference between two voxels, a relative error of 2e-3 where the parity with the processor
// asks for 1e-4. So textures have no filter, no border and no mipmaps; what they offer is storage in blocks, caches of
// their own, and sizes beyond those of a storage buffer.
#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "gpu/context.h"

namespace airlight::gpu {

class Texture3D {
 public:
  enum class Format { r32f, rgba32f };

  // `name` is for messages; `size` in texels, x fastest, >= 1 each. The contents are undefined. Throws Unavailable in
  // one line if a side passes GL_MAX_3D_TEXTURE_SIZE or the device has no room.
  Texture3D(Context&, const std::string& name, const std::array<int, 3>& size, Format = Format::r32f);
  Texture3D(const Texture3D&) = delete;

  const std::array<int, 3>& size() const { return size_; }
  std::size_t bytes() const;  // of the texels, what a driver adds left out

  // All texels, x fastest. Throws Error if their number is another.
  void upload(const std::vector<float>&);
  // Uploads slice after slice along z, so that the host holds only one: `slice(z, values)` fills a slice.
  void upload(const std::function<void(int z, std::vector<float>& values)>& slice);
  std::vector<float> download() const;

  // To a texture unit of a sampler3D.
  void bind(int unit) const;

 private:
  int channels() const { return format_ == Format::r32f ? 1 : 4; }
  std::size_t slice_values() const { return std::size_t(size_[0]) * size_[1] * channels(); }
  void write(int z, int depth, const float*);

  Context& context_;
  std::string name_;
  std::array<int, 3> size_;
  Format format_;
  Handle id_;
};

}  // namespace airlight::gpu
