// The framebuffer of a raster pass: distance and normal, surface and primitive of every pixel, a float depth buffer.
#pragma once
#include "gpu/buffer.h"
#include "gpu/raster/first_hits.h"  // far_away

namespace airlight::gpu {

class HitImage {
 public:
  // Throws Unavailable if the device's textures are smaller, Error if it has no such framebuffer.
  HitImage(Context&, int width, int height);
  ~HitImage();
  HitImage(const HitImage&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }

  // Binds it to draw into, everything at "nothing is hit": far_away, normal 0, surface and primitive -1.
  void begin() const;
  void end() const;

  // Copies of the attachments in storage buffers, from byte `offset` on; row 0 first, x fastest.
  void read_hits(const Buffer&) const;                           // 4 floats: distance [m], normal
  void read_distances(const Buffer&, std::size_t offset) const;  // 1 float
  void read_surfaces(const Buffer&) const;                       // 1 int: index, -1 nothing, -2 a light's ball
  void read_primitives(const Buffer&, std::size_t offset) const;

 private:
  void read(int attachment, GLenum format, GLenum type, std::size_t bytes, const Buffer&, std::size_t offset) const;

  Context& context_;
  int width_, height_;
  GLuint framebuffer_ = 0, textures_[4] = {0, 0, 0, 0};
};

}  // namespace airlight::gpu
