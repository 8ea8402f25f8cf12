// The state of a flow as bytes, and back: what it is of stands first and must agree.
#pragma once
#include <string>
#include <string_view>

#include "methods/legendre_fluids/confined_space.h"
#include "scene/content_key.h"
#include "scene/error.h"

namespace airlight::legendre_fluids {

// Arrays with their lengths, and a checksum at the end.
class StateWriter {
 public:
  explicit StateWriter(const std::string& shape) : bytes_(shape + "\n") {}
  void array(const Array& a) {
    const double size = double(a.size());
    append(&size, 1);
    append(a.data(), std::size_t(a.size()));
  }
  std::string done() { return bytes_ + content_key(bytes_); }

 private:
  void append(const double* from, std::size_t count) {
    bytes_.append(reinterpret_cast<const char*>(from), count * sizeof(double));
  }
  std::string bytes_;
};

// Throws Error where the bytes are of another flow, too few, too many or damaged.
class StateReader {
 public:
  StateReader(const std::string& bytes, const std::string& shape) : bytes_(bytes), at_(shape.size() + 1) {
    if (bytes.compare(0, at_, shape + "\n") != 0)
      throw Error("the state is of \"" + bytes.substr(0, bytes.find('\n')).substr(0, 120) + "\", expected \"" + shape +
                  "\"");
    end_ = bytes.size() - std::min(bytes.size() - at_, content_key(std::string_view()).size());
    if (content_key(std::string_view(bytes).substr(0, end_)) != bytes.substr(end_))
      throw Error("the state is damaged: its checksum does not match");
  }
  Array array() {
    double size;
    take(&size, 1);
    if (!(size >= 0 && size * sizeof(double) <= double(end_ - at_))) throw Error("the state is shorter than expected");
    Array a{Eigen::Index(size)};
    take(a.data(), std::size_t(a.size()));
    return a;
  }
  void done() const {
    if (at_ != end_) throw Error("the state is longer than expected");
  }

 private:
  void take(double* to, std::size_t count) {
    if (end_ - at_ < count * sizeof(double)) throw Error("the state is shorter than expected");
    bytes_.copy(reinterpret_cast<char*>(to), count * sizeof(double), at_);
    at_ += count * sizeof(double);
  }
  const std::string& bytes_;
  std::size_t at_, end_;
};

}  // namespace airlight::legendre_fluids
