// XXH3 (128 bits) over values, not over memory: the same numbers give the same hash whatever they were written as.
#pragma once
#include <xxhash.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene::load {

class ContentHash {
 public:
  ContentHash();

  // A word that says what follows, so that values cannot be taken for those of another part.
  void tag(const std::string& word);
  void add(double);  // -0 as 0
  void add(std::int64_t);
  void add(int value) { add(std::int64_t(value)); }
  void add(const Vec3&);
  void add(const Rgb&);
  void add(const Mat3&);
  void add(const Box&);
  // Its length, then its values.
  void add(const std::vector<float>&);
  void add(const std::vector<double>&);
  template <class... Values>
  void all(const Values&... values) {
    (add(values), ...);
  }

  std::string digits() const;  // 32 hex digits

 private:
  void bytes(const void* data, std::size_t count);
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

}  // namespace airlight::scene::load
