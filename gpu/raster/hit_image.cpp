#include "gpu/raster/hit_image.h"

#include <fmt/format.h>

#include "scene/base/error.h"

namespace airlight::gpu {

HitImage::HitImage(Context& context, int width, int height) : context_(context), width_(width), height_(height) {
  const int most = context.limits().texture_size;
  if (width > most || height > most)
    throw Unavailable(fmt::format("gpu: an image of {} x {} pixels, {} offers at most {} to a side", width, height,
                                  context.renderer(), most));
  const Use use(context);
  const Gl& gl = context.gl();
  const GLenum formats[3] = {GL_R32F, GL_R32UI, GL_DEPTH_COMPONENT32F};
  const GLenum attachments[3] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_DEPTH_ATTACHMENT};
  GLuint id = 0;
  gl.CreateFramebuffers(1, &id);
  framebuffer_ = Handle(context, id, [](const Gl& gl, GLuint id) { gl.DeleteFramebuffers(1, &id); });
  for (int i = 0; i < 3; ++i) {
    gl.CreateTextures(GL_TEXTURE_2D, 1, &id);
    textures_[i] = Handle(context, id, [](const Gl& gl, GLuint id) { gl.DeleteTextures(1, &id); });
    gl.TextureStorage2D(textures_[i], 1, formats[i], width, height);
    gl.NamedFramebufferTexture(framebuffer_, attachments[i], textures_[i], 0);
  }
  gl.NamedFramebufferDrawBuffers(framebuffer_, 2, attachments);
  context.traffic().allocations += 4;
  const GLenum status = gl.CheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER);
  context.check("making a framebuffer");
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw Error(fmt::format("gpu: {} refuses a framebuffer of 32-bit floats and integers (status {:#x})",
                            context.renderer(), status));
}

void HitImage::begin() const {
  const Gl& gl = context_.gl();
  const GLfloat nothing[4] = {far_away, 0, 0, 0}, farthest[1] = {1};
  // Unsigned, with the bits of -1: of signed integers below 0 an NVIDIA GPU (driver 580) gave back 2^31 - 1.
  const GLuint none[4] = {~0U, ~0U, ~0U, ~0U};
  gl.ClearNamedFramebufferfv(framebuffer_, GL_COLOR, 0, nothing);
  gl.ClearNamedFramebufferuiv(framebuffer_, GL_COLOR, 1, none);
  gl.ClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, farthest);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl.Viewport(0, 0, width_, height_);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);  // of equal distances the first drawn stays
}

void HitImage::end() const {
  context_.gl().BindFramebuffer(GL_FRAMEBUFFER, 0);
  context_.check_closely("a raster pass");
}

void HitImage::copy(int attachment, GLenum format, GLenum type, const Buffer& buffer, std::size_t offset) const {
  const Gl& gl = context_.gl();
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl.NamedFramebufferReadBuffer(framebuffer_, GL_COLOR_ATTACHMENT0 + GLenum(attachment));
  buffer.bind_as(GL_PIXEL_PACK_BUFFER);
  gl.ReadPixels(0, 0, width_, height_, format, type, reinterpret_cast<void*>(offset));  // into the buffer
  gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  context_.check_closely("copying a raster pass");
}

void HitImage::copy_distances(const Buffer& buffer, std::size_t offset) const {
  copy(0, GL_RED, GL_FLOAT, buffer, offset);
}
void HitImage::copy_primitives(const Buffer& buffer, std::size_t offset) const {
  copy(1, GL_RED_INTEGER, GL_UNSIGNED_INT, buffer, offset);
}

}  // namespace airlight::gpu
