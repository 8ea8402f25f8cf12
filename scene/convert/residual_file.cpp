// The bytes of a residual, little-endian:
//   "airlight residual 1\n"
//   size 3 x int32, origin_index 3 x int32, clamp_border int32, threshold int32
//   rotation 9 x double by rows, voxel_size double, translation 3 x double, cutoff double, step double
//   key of the Gaussians, 32 characters
//   a bit for each brick of 8^3 samples, x fastest, the first one lowest: 1 where its levels follow
//   those bricks, 512 x int8 each, x fastest
//   checksum of all before, 32 characters
#include "scene/convert/residual_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "scene/base/atomic_file.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"

namespace airlight::scene {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view version = "airlight residual 1\n";
constexpr std::size_t key_length = 32, brick_bytes = 512;
constexpr double greatest_step = 1e20;    // the densities that scene files may hold
constexpr double most_samples = 1 << 28;  // as of grids in scene files: a gigabyte of floats

struct Fixed {  // no gaps
  std::int32_t size[3], origin[3], clamp_border, threshold;
  double rotation[9], voxel_size, translation[3], cutoff, step;
  char key[key_length];
};
static_assert(sizeof(Fixed) == 8 * 4 + 15 * 8 + key_length);

[[noreturn]] void refuse(const std::string& what) { throw Error("not a residual that can be read: " + what); }

bool hexadecimal(const char* key) {
  for (std::size_t i = 0; i < key_length; ++i)
    if (!std::strchr("0123456789abcdef", key[i]) || !key[i]) return false;
  return true;
}

// Checks the ranges of a header. An empty grid has size 0 on all axes.
void check(const Fixed& f) {
  double samples = 1;
  bool positive = true, none = true;
  for (const std::int32_t n : f.size) {
    samples *= n;
    positive = positive && n >= 1;
    none = none && n == 0;
  }
  if (!(positive || none) || samples > most_samples)
    refuse(fmt::format("{} x {} x {} samples, expected 1 or more on every axis and at most {}", f.size[0], f.size[1],
                       f.size[2], most_samples));
  bool finite = std::isfinite(f.voxel_size) && f.voxel_size > 0 && f.step >= 0 && f.step <= greatest_step;
  for (const double x : f.rotation) finite = finite && std::isfinite(x);
  for (const double x : f.translation) finite = finite && std::isfinite(x);
  for (const std::int32_t i : f.origin) finite = finite && i > -(1 << 30) && i < 1 << 30;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(f.rotation);
  if (!finite || !(f.cutoff > 0) || !(rotation * rotation.transpose()).isIdentity(1e-9) ||
      (f.clamp_border != 0 && f.clamp_border != 1) || f.threshold < 0 || f.threshold > 126 || !hexadecimal(f.key))
    refuse("its header has numbers out of range");
}

Fixed header_of(const Residual& r) {
  Fixed f{};
  const VoxelGrid& grid = r.layout;
  for (int a = 0; a < 3; ++a) {
    f.size[a] = grid.size[a];
    f.origin[a] = grid.origin_index[a];
    f.translation[a] = grid.translation[a];
    for (int b = 0; b < 3; ++b) f.rotation[3 * a + b] = grid.rotation(a, b);
  }
  f.clamp_border = grid.clamp_border;
  f.threshold = r.threshold;
  f.voxel_size = grid.voxel_size;
  f.cutoff = r.cutoff;
  f.step = r.step;
  if (r.gaussians_key.size() != key_length) refuse("the key of its Gaussians has another length");
  std::memcpy(f.key, r.gaussians_key.data(), key_length);
  check(f);
  return f;
}

std::size_t bricks_in(const Fixed& f) {
  std::size_t count = 1;
  for (const std::int32_t n : f.size) count *= (std::size_t(n) + 7) / 8;
  return count;
}

}  // namespace

std::string residual_bytes(const Residual& r) {
  const Fixed f = header_of(r);
  std::string bits((bricks_in(f) + 7) / 8, '\0');
  // Bricks come in the order of their numbers, so that the bits alone say which is which.
  for (std::size_t i = 0; i < r.bricks.index.size(); ++i)
    if (r.bricks.index[i] > 0) bits[i / 8] = char(bits[i / 8] | 1 << i % 8);
  std::string bytes(version);
  bytes.append(reinterpret_cast<const char*>(&f), sizeof f);
  bytes += bits;
  bytes.append(reinterpret_cast<const char*>(r.bricks.values.data()), r.bricks.values.size());
  return bytes + content_key(bytes);
}

Residual residual_from_bytes(const std::string& bytes) {
  if (bytes.compare(0, version.size(), version) != 0)
    refuse(fmt::format("it does not begin with \"{}\"", version.substr(0, version.size() - 1)));
  const std::size_t least = version.size() + sizeof(Fixed) + key_length;
  if (bytes.size() < least) refuse(fmt::format("{} bytes, expected {} or more", bytes.size(), least));
  const std::size_t end = bytes.size() - key_length;
  if (content_key(std::string_view(bytes).substr(0, end)) != std::string_view(bytes).substr(end))
    refuse("it is damaged or cut off: its checksum does not match");
  Fixed f;
  std::memcpy(&f, bytes.data() + version.size(), sizeof f);
  check(f);
  const std::size_t count = bricks_in(f), at = version.size() + sizeof f, bits = (count + 7) / 8;
  if (end - at < bits) refuse("it is shorter than its header says");
  Residual r;
  r.layout.size = {f.size[0], f.size[1], f.size[2]};
  r.layout.origin_index = {f.origin[0], f.origin[1], f.origin[2]};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) r.layout.rotation(a, b) = f.rotation[3 * a + b];
  r.layout.translation = {f.translation[0], f.translation[1], f.translation[2]};
  r.layout.voxel_size = f.voxel_size;
  r.layout.clamp_border = f.clamp_border != 0;
  r.cutoff = f.cutoff;
  r.step = f.step;
  r.threshold = f.threshold;
  r.gaussians_key.assign(f.key, key_length);
  r.bricks.size = r.layout.size;
  r.bricks.bricks = (r.layout.size.array() + 7) / 8;
  r.bricks.index.resize(count);
  for (std::size_t i = count; i < 8 * bits; ++i)
    if (bytes[at + i / 8] >> i % 8 & 1) refuse("it has bricks beyond its size");
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (bytes[at + i / 8] >> i % 8 & 1) r.bricks.index[i] = ++kept;
  const std::size_t expected = at + bits + brick_bytes * kept;
  if (end != expected) refuse(fmt::format("{} bytes, expected {}", bytes.size(), expected + key_length));
  r.bricks.values.resize(brick_bytes * kept);
  std::copy_n(bytes.data() + at + bits, r.bricks.values.size(), r.bricks.values.begin());
  for (const std::int8_t level : r.bricks.values)
    if (level == -128) refuse("it has a level of -128, expected -127 to 127");
  return r;
}

Residual read_residual(const std::string& path) {
  const std::string bytes = read_whole_file(path, std::size_t(most_samples) * 2);
  try {
    return residual_from_bytes(bytes);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: {}", path, e.what()));
  }
}

void write_residual(const std::string& path, const Residual& residual) {
  write_file_atomically(path, residual_bytes(residual));
}

}  // namespace airlight::scene
