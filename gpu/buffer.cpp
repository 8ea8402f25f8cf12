#include "gpu/buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "scene/base/error.h"

namespace airlight::gpu {

bool poisoned() {
  static const bool set = [] {
    const char* variable = std::getenv("AIRLIGHT_GPU_POISON");
    return variable && *variable;
  }();
  return set;
}

Buffer::Buffer(Context& context, const std::string& name, std::size_t bytes, Contents contents)
    : context_(&context), name_(name), bytes_(bytes) {
  const Limits& limits = context.limits();
  if (bytes > limits.storage_block)
    throw Unavailable(fmt::format("gpu: buffer '{}' needs {:.1f} MiB, {} offers at most {:.1f} MiB", name,
                                  double(bytes) / (1 << 20), context.renderer(),
                                  double(limits.storage_block) / (1 << 20)));
  const Use use(context);
  const Gl& gl = context.gl();
  GLuint id = 0;
  gl.CreateBuffers(1, &id);
  id_ = Handle(context, id, [](const Gl& gl, GLuint id) { gl.DeleteBuffers(1, &id); });
  gl.NamedBufferStorage(id_, GLsizeiptr(std::max<std::size_t>(4, bytes)), nullptr, GL_DYNAMIC_STORAGE_BIT);
  ++context.traffic().allocations;
  context.check("making buffer '" + name + "'");
  context.label(GL_BUFFER, id_, name);
  if (contents == Contents::zeros) clear();
  if (contents == Contents::undefined && poisoned()) poison();
}

void Buffer::bind(int binding) const { bind_as(GL_SHADER_STORAGE_BUFFER, binding); }

void Buffer::bind_as(GLenum target) const { context_->gl().BindBuffer(target, id_); }

void Buffer::bind_as(GLenum target, int binding) const { context_->gl().BindBufferBase(target, GLuint(binding), id_); }

void Buffer::clear() { fill(0); }

void Buffer::poison() { fill(~0u); }

void Buffer::fill(GLuint word) {
  const Use use(*context_);
  context_->gl().ClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
  filled_ = true;
}

void Buffer::write(const void* data, std::size_t bytes) {
  if (bytes > bytes_) throw Error(fmt::format("gpu: buffer '{}' holds {} bytes, {} were given", name_, bytes_, bytes));
  if (bytes == 0) return;
  const Use use(*context_);
  // NVIDIA's driver (580) lets a fill overwrite an upload of 64 KiB or more that comes after it; no barrier of OpenGL prevents that.
  if (filled_ && bytes >= 65536) context_->wait();
  filled_ = false;
  context_->gl().NamedBufferSubData(id_, 0, GLsizeiptr(bytes), data);
  context_->traffic().bytes_up += long(bytes);
  context_->check("filling buffer '" + name_ + "'");
}

void Buffer::read(void* data, std::size_t bytes) const {
  if (bytes == 0) return;
  const Use use(*context_);
  const Gl& gl = context_->gl();
  if (filled_) {
    // NVIDIA's driver (580) gives what a fill left, whatever shaders wrote since, also after glFinish. A copy is right.
    GLuint id = 0;
    gl.CreateBuffers(1, &id);
    const Handle copy(*context_, id, [](const Gl& gl, GLuint id) { gl.DeleteBuffers(1, &id); });
    gl.NamedBufferStorage(copy, GLsizeiptr(bytes), nullptr, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
    gl.CopyNamedBufferSubData(id_, copy, 0, 0, GLsizeiptr(bytes));
    context_->check("copying buffer '" + name_ + "'");
    std::memcpy(data, gl.MapNamedBufferRange(copy, 0, GLsizeiptr(bytes), GL_MAP_READ_BIT), bytes);
  } else {
    gl.GetNamedBufferSubData(id_, 0, GLsizeiptr(bytes), data);
  }
  context_->traffic().bytes_down += long(bytes);
  ++context_->traffic().syncs;
  context_->check("reading buffer '" + name_ + "'");
}

void Buffer::copy_to(GLuint buffer, std::size_t offset, std::size_t bytes) const {
  if (bytes > bytes_) throw Error(fmt::format("gpu: buffer '{}' holds {} bytes, not {}", name_, bytes_, bytes));
  const Use use(*context_);
  context_->gl().CopyNamedBufferSubData(id_, buffer, 0, GLintptr(offset), GLsizeiptr(bytes));
}

bool reserve(std::unique_ptr<Buffer>& buffer, Context& context, const std::string& name, std::size_t bytes) {
  if (buffer && buffer->bytes() >= bytes) return false;
  const std::size_t spare = buffer ? bytes / 8 * 4 : 0;  // whole words, for fills
  buffer.reset();
  buffer = std::make_unique<Buffer>(
      context, name, std::max(bytes, std::min(bytes + spare, context.limits().storage_block)), Contents::undefined);
  return true;
}

}  // namespace airlight::gpu
