// The state of a flow as bytes, and back: what it is of stands first and must agree, a checksum stands at the end.
#pragma once
#include <Eigen/Core>
#include <string>

#include "scene/base/content_key.h"
#include "scene/base/error.h"

namespace airlight::scene {

class StateWriter {
 public:
  // `bytes` is the expected size of the state: memory is reserved for it, so that nothing is copied as the text grows.
  explicit StateWriter(const std::string& shape, std::size_t bytes = 0) {
    bytes_.reserve(shape.size() + bytes + 1024);  // and what a file begins and ends with
    bytes_ += shape;
    bytes_ += '\n';
  }
  void number(double value) { append(&value, sizeof value); }
  // Writes the values without their count, which the reader must know.
  template <class Numbers>
  void values(const Numbers& v) {
    append(v.data(), std::size_t(v.size()) * sizeof(*v.data()));
  }
  // Writes the count, then the values.
  void array(const Eigen::VectorXd& a) {
    number(double(a.size()));
    values(a);
  }
  std::string done() {
    bytes_ += content_key(bytes_);
    return std::move(bytes_);
  }

 private:
  void append(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }
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
  double number() {
    double value;
    take(&value, sizeof value);
    return value;
  }
  template <class Numbers>
  void values(Numbers& v) {
    take(v.data(), std::size_t(v.size()) * sizeof(*v.data()));
  }
  Eigen::VectorXd array() {
    const double size = number();
    if (!(size >= 0 && size * sizeof(double) <= double(end_ - at_))) throw Error("the state is shorter than expected");
    Eigen::VectorXd a{Eigen::Index(size)};
    values(a);
    return a;
  }
  void done() const {
    if (at_ != end_) throw Error("the state is longer than expected");
  }

 private:
  void take(void* to, std::size_t size) {
    if (end_ - at_ < size) throw Error("the state is shorter than expected");
    bytes_.copy(static_cast<char*>(to), size, at_);
    at_ += size;
  }
  const std::string& bytes_;
  std::size_t at_, end_;
};

}  // namespace airlight::scene
