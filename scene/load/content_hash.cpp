#include "scene/load/content_hash.h"

#include <fmt/format.h>

#include <bit>
#include <stdexcept>

namespace airlight::scene::load {

static_assert(std::endian::native == std::endian::little, "hashes are of little-endian values");

ContentHash::ContentHash() : state_(XXH3_createState(), XXH3_freeState) {
  if (!state_ || XXH3_128bits_reset(state_.get()) != XXH_OK) throw std::bad_alloc();
}

void ContentHash::bytes(const void* data, std::size_t count) {
  if (count > 0) XXH3_128bits_update(state_.get(), data, count);
}

void ContentHash::tag(const std::string& word) {
  add(std::int64_t(word.size()));
  bytes(word.data(), word.size());
}

void ContentHash::add(double value) {
  const double canonical = value == 0 ? 0.0 : value;
  bytes(&canonical, sizeof canonical);
}

void ContentHash::add(std::int64_t value) { bytes(&value, sizeof value); }

void ContentHash::add(const Vec3& v) {
  for (int i = 0; i < 3; ++i) add(v[i]);
}

void ContentHash::add(const Rgb& c) {
  for (int i = 0; i < 3; ++i) add(c[i]);
}

void ContentHash::add(const Mat3& m) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) add(m(i, j));
}

void ContentHash::add(const Box& box) {
  add(box.lo);
  add(box.hi);
}

void ContentHash::add(const std::vector<float>& values) {
  add(std::int64_t(values.size()));
  bytes(values.data(), values.size() * sizeof(float));
}

void ContentHash::add(const std::vector<double>& values) {
  add(std::int64_t(values.size()));
  for (const double value : values) add(value);
}

std::string ContentHash::digits() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace airlight::scene::load
