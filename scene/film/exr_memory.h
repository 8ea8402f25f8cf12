// An OpenEXR file encoded in memory, to be put into place in one go.
#pragma once
#include <OpenEXR/ImfIO.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace airlight::scene {

class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("film") {}
  void write(const char bytes[], int n) override {
    bytes_.resize(std::max(bytes_.size(), position_ + std::size_t(n)));
    std::memcpy(bytes_.data() + position_, bytes, std::size_t(n));
    position_ += std::size_t(n);
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

}  // namespace airlight::scene
