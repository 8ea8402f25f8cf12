// A storage buffer on the device: std430 arrays of plain values.
#pragma once
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/context.h"

namespace airlight::gpu {

class Buffer {
 public:
  // `name` is for messages. Holds zeros. Throws Error if the device's storage blocks are smaller, in one line that says
  // both sizes: there is no silent truncation, callers tile or refuse. Empty buffers hold 4 bytes.
  Buffer(Context&, const std::string& name, std::size_t bytes);
  template <class T>
  Buffer(Context& context, const std::string& name, const std::vector<T>& values)
      : Buffer(context, name, values.size() * sizeof(T)) {
    upload(values);
  }
  ~Buffer();
  Buffer(const Buffer&) = delete;

  std::size_t bytes() const { return bytes_; }
  void bind(int binding) const;
  void bind_as(GLenum target) const;  // GL_PIXEL_PACK_BUFFER and its like

  template <class T>
  void upload(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    write(values.data(), values.size() * sizeof(T));
  }
  template <class T>
  std::vector<T> download() const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(bytes_ / sizeof(T));
    read(values.data(), values.size() * sizeof(T));
    return values;
  }

 private:
  void write(const void*, std::size_t bytes);
  void read(void*, std::size_t bytes) const;

  Context* context_;
  std::string name_;
  std::size_t bytes_;
  GLuint id_ = 0;
};

}  // namespace airlight::gpu
