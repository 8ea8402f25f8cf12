#include "gpu/texture_3d.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/base/error.h"

namespace airlight::gpu {

Texture3D::Texture3D(Context& context, const std::string& name, const std::array<int, 3>& size, Format format)
    : context_(context), name_(name), size_(size), format_(format) {
  const int most = context.limits().texture_size_3d;
  const auto dimensions = fmt::format("{} x {} x {}", size[0], size[1], size[2]);
  if (*std::min_element(size.begin(), size.end()) < 1)
    throw Error(fmt::format("gpu: texture '{}' of {} texels: expected 1 or more to a side", name, dimensions));
  if (*std::max_element(size.begin(), size.end()) > most)
    throw Unavailable(fmt::format("gpu: texture '{}' needs {} texels, {} offers at most {} to a side", name, dimensions,
                                  context.renderer(), most));
  const Use use(context);
  const Gl& gl = context.gl();
  context.check("what came before texture '" + name + "'");
  GLuint id = 0;
  gl.CreateTextures(GL_TEXTURE_3D, 1, &id);
  id_ = Handle(context, id, [](const Gl& gl, GLuint id) { gl.DeleteTextures(1, &id); });
  ++context.traffic().allocations;
  // NVIDIA's driver makes textures of any size, and fails when they are filled.
  const bool fits = context.limits().memory == 0 || bytes() <= context.limits().memory;
  if (fits) gl.TextureStorage3D(id_, 1, format == Format::r32f ? GL_R32F : GL_RGBA32F, size[0], size[1], size[2]);
  const GLenum error = gl.GetError();
  if (!fits || error == GL_OUT_OF_MEMORY) {
    context.forget_errors();  // the driver's message would repeat this error
    throw Unavailable(fmt::format("gpu: texture '{}' of {} texels needs {:.1f} MiB: {} is out of memory", name,
                                  dimensions, double(bytes()) / (1 << 20), context.renderer()));
  }
  context.check("making texture '" + name + "'");
  context.label(GL_TEXTURE, id_, name);
  gl.TextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

std::size_t Texture3D::bytes() const { return slice_values() * size_[2] * sizeof(float); }

void Texture3D::upload(const std::vector<float>& values) {
  if (values.size() * sizeof(float) != bytes())
    throw Error(fmt::format("gpu: texture '{}' holds {} bytes, {} were given", name_, bytes(), values.size() * 4));
  write(0, size_[2], values.data());
}

void Texture3D::upload(const std::function<void(int, std::vector<float>&)>& slice) {
  std::vector<float> values(slice_values());
  for (int z = 0; z < size_[2]; ++z) {
    slice(z, values);
    if (values.size() != slice_values())
      throw Error(fmt::format("gpu: texture '{}': {} values in a slice of {}", name_, values.size(), slice_values()));
    write(z, 1, values.data());
  }
}

void Texture3D::write(int z, int depth, const float* values) {
  const Use use(context_);
  context_.gl().TextureSubImage3D(id_, 0, 0, 0, z, size_[0], size_[1], depth,
                                  format_ == Format::r32f ? GL_RED : GL_RGBA, GL_FLOAT, values);
  context_.traffic().bytes_up += long(slice_values() * depth * sizeof(float));
  context_.check("filling texture '" + name_ + "'");
}

std::vector<float> Texture3D::download() const {
  std::vector<float> values(bytes() / sizeof(float));
  const Use use(context_);
  // Slice by slice: the size of a call's buffer is an int.
  for (int z = 0; z < size_[2]; ++z)
    context_.gl().GetTextureSubImage(id_, 0, 0, 0, z, size_[0], size_[1], 1, format_ == Format::r32f ? GL_RED : GL_RGBA,
                                     GL_FLOAT, GLsizei(slice_values() * sizeof(float)),
                                     values.data() + z * slice_values());
  context_.traffic().bytes_down += long(bytes());
  ++context_.traffic().syncs;
  context_.check("reading texture '" + name_ + "'");
  return values;
}

void Texture3D::bind(int unit) const { context_.gl().BindTextureUnit(GLuint(unit), id_); }

}  // namespace airlight::gpu
