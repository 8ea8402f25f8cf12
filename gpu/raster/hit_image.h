// The framebuffer of a raster pass: distance and primitive of every pixel, a float depth buffer.
#pragma once
#include "gpu/buffer.h"

namespace airlight::gpu {

inline constexpr float far_away = 1e37f;  // [m] as the shaders: nothing is hit

class HitImage {
 public:
  // Throws Unavailable if the device's textures are smaller, Error if it has no such framebuffer.
  HitImage(Context&, int width, int height);
  HitImage(const HitImage&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }

  // Binds it to draw into, everything at "nothing is hit": far_away, primitive -1.
  void begin() const;
  void end() const;

  // Copies of the attachments in storage buffers, from byte `offset` on; row 0 first, x fastest.
  void copy_distances(const Buffer&, std::size_t offset) const;   // 1 float [m]
  void copy_primitives(const Buffer&, std::size_t offset) const;  // 1 int

 private:
  void copy(int attachment, GLenum format, GLenum type, const Buffer&, std::size_t offset) const;

  Context& context_;
  int width_, height_;
  Handle textures_[3], framebuffer_;
};

}  // namespace airlight::gpu
