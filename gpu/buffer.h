// A storage buffer on the device: std430 arrays of plain values.
#pragma once
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/context.h"

namespace airlight::gpu {

enum class Contents { zeros, undefined };

// The variable AIRLIGHT_GPU_POISON is set: buffers of undefined contents hold NaN (and -1), at the start of every frame
// again, so that a test sees who reads what nobody wrote.
bool poisoned();

class Buffer {
 public:
  // `name` is for messages and debuggers. Zeros are written by the device. Throws Unavailable if the device's storage
  // blocks are smaller, in one line that says both sizes (there is no silent truncation, callers tile or refuse), or if
  // it has no room. Empty buffers hold 4 bytes.
  Buffer(Context&, const std::string& name, std::size_t bytes, Contents = Contents::zeros);
  template <class T>
  Buffer(Context& context, const std::string& name, const std::vector<T>& values)
      : Buffer(context, name, values.size() * sizeof(T), Contents::undefined) {
    upload(values);
  }
  Buffer(const Buffer&) = delete;

  std::size_t bytes() const { return bytes_; }
  void bind(int binding) const;
  void bind_as(GLenum target) const;               // GL_PIXEL_PACK_BUFFER and its like
  void bind_as(GLenum target, int binding) const;  // GL_UNIFORM_BUFFER

  // Zeros, by the device.
  void clear();
  void poison();

  template <class T>
  void upload(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    write(values.data(), values.size() * sizeof(T));
  }
  // Waits for the device. In a frame use Download (gpu/frame.h).
  template <class T>
  std::vector<T> download() const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(bytes_ / sizeof(T));
    read(values.data(), values.size() * sizeof(T));
    return values;
  }
  // The first `bytes` to byte `offset` of a GL buffer, by the device. Throws Error if there are fewer.
  void copy_to(GLuint buffer, std::size_t offset, std::size_t bytes) const;

 private:
  void write(const void*, std::size_t bytes);
  void read(void*, std::size_t bytes) const;
  void fill(GLuint word);

  Context* context_;
  std::string name_;
  std::size_t bytes_;
  Handle id_;
  bool filled_ = false;  // by the device, and nothing was uploaded since
};

// For buffers that live from frame to frame: makes room for so many bytes where `buffer` is null or smaller, with half as much to spare if it
// was too small, so that what grows from frame to frame seldom allocates. True if the contents are lost (undefined).
bool reserve(std::unique_ptr<Buffer>& buffer, Context&, const std::string& name, std::size_t bytes);
template <class T>
void refill(std::unique_ptr<Buffer>& buffer, Context& context, const std::string& name, const std::vector<T>& values) {
  reserve(buffer, context, name, values.size() * sizeof(T));
  buffer->upload(values);
}

}  // namespace airlight::gpu
