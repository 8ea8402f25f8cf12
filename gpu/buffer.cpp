#include "gpu/buffer.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/error.h"

namespace airlight::gpu {

Buffer::Buffer(Context& context, const std::string& name, std::size_t bytes)
    : context_(&context), name_(name), bytes_(bytes) {
  const Limits& limits = context.limits();
  if (bytes > limits.storage_block)
    throw Unavailable(fmt::format("gpu: buffer '{}' needs {:.1f} MiB, {} offers at most {:.1f} MiB", name,
                                  double(bytes) / (1 << 20), context.renderer(),
                                  double(limits.storage_block) / (1 << 20)));
  const Use use(context);
  const Gl& gl = context.gl();
  gl.CreateBuffers(1, &id_);
  gl.NamedBufferStorage(id_, GLsizeiptr(std::max<std::size_t>(4, bytes)), nullptr, GL_DYNAMIC_STORAGE_BIT);
  context.check("making buffer '" + name + "'");
  gl.ClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

Buffer::~Buffer() {
  const Use use(*context_);
  context_->gl().DeleteBuffers(1, &id_);
}

void Buffer::bind(int binding) const { context_->gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(binding), id_); }

void Buffer::bind_as(GLenum target) const { context_->gl().BindBuffer(target, id_); }

void Buffer::write(const void* data, std::size_t bytes) {
  if (bytes > bytes_) throw Error(fmt::format("gpu: buffer '{}' holds {} bytes, {} were given", name_, bytes_, bytes));
  if (bytes == 0) return;
  const Use use(*context_);
  context_->gl().NamedBufferSubData(id_, 0, GLsizeiptr(bytes), data);
  context_->check("filling buffer '" + name_ + "'");
}

void Buffer::read(void* data, std::size_t bytes) const {
  if (bytes == 0) return;
  const Use use(*context_);
  context_->gl().GetNamedBufferSubData(id_, 0, GLsizeiptr(bytes), data);
  context_->check("reading buffer '" + name_ + "'");
}

}  // namespace airlight::gpu
