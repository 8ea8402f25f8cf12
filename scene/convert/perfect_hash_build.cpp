// How the offsets are found: greedily, the largest buckets of positions that share one first.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "scene/base/error.h"
#include "scene/convert/perfect_hash.h"
#include "scene/math/random.h"

namespace airlight::scene {
namespace {

using Eigen::Vector3i;

constexpr int random_tries = 64;  // of offsets, before all are tried
constexpr int most_m = 1023;      // offsets have ten bits
constexpr int most_r = 512;       // 2^27 offsets

std::size_t cube(int n) { return std::size_t(n) * n * n; }

// The least n with n^3 >= k.
int root(std::size_t k) {
  int n = int(std::ceil(std::cbrt(double(k))));
  while (n > 0 && cube(n - 1) >= k) --n;
  while (cube(n) < k) ++n;
  return n;
}

int first_r(std::size_t k, HashOptions::Offsets offsets) {
  switch (offsets) {
    case HashOptions::Offsets::thirds:
      return int(std::ceil(std::cbrt(double(k) / 3))) + 9;
    case HashOptions::Offsets::root_thirds:
      return int(std::ceil(std::cbrt(double(k)) / 3)) + 9;
    case HashOptions::Offsets::sixths:
      return int(std::ceil(std::cbrt(double(k) / 6)));
  }
  return 0;
}

// Two positions with the same (p mod m, p mod r) could never be told apart. Where m r covers the domain there are none (m and r being
// coprime); else the stored ones are looked at themselves, for one voxel in a large domain would ask for as many offsets as it has places.
bool tells_apart(const Vector3i& extent, const std::vector<HashedVoxel>& voxels, int m, int r) {
  if (std::int64_t(m) * r >= extent.maxCoeff()) return true;
  std::vector<std::uint64_t> keys;
  keys.reserve(voxels.size());
  for (const HashedVoxel& v : voxels) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
      key = (key * unsigned(m) + unsigned(v.position[axis] % m)) * unsigned(r) + unsigned(v.position[axis] % r);
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return std::adjacent_find(keys.begin(), keys.end()) == keys.end();
}

// With r = +-1 modulo m neighbouring buckets tread on each other's slots. For m = 1, 2, 3, 4 and 6 every coprime r is such a one.
bool suits(int m, int r) {
  if (std::gcd(m, r) != 1) return false;
  if (m <= 4 || m == 6) return true;
  return r % m != 1 && r % m != m - 1;
}

class Construction {
 public:
  Construction(const Vector3i& extent, const std::vector<HashedVoxel>& voxels, std::uint32_t seed)
      : extent_(extent), voxels_(voxels), seed_(seed) {}

  // Fills the offsets of a hash of this m and r; false where some bucket finds no place.
  bool place(PerfectHash& hash) {
    m_ = hash.m, r_ = hash.r;
    hash.offsets.assign(cube(r_), 0);
    placed_.assign(cube(r_), 0);
    taken_.assign(cube(m_), 0);
    sort_buckets();
    hash.largest_bucket = int(bucket(0).size);
    next_free_ = 0;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Bucket b = bucket(i);
      if (b.size == 1) {
        take_next_free(b);
      } else if (!find_offset(b, hash.offsets)) {
        return false;
      }
      for (std::size_t k = 0; k < b.size; ++k) taken_[slot(b.first[k], offset_)] = 1;
      hash.offsets[b.index] = std::uint32_t(offset_[0] | offset_[1] << 10 | offset_[2] << 20);
      placed_[b.index] = 1;
    }
    return true;
  }

 private:
  struct Bucket {
    std::size_t index, size;
    const std::uint32_t* first;  // numbers of its voxels
  };

  std::size_t bucket_of(const Vector3i& p) const {
    return p[0] % r_ + std::size_t(r_) * (p[1] % r_ + std::size_t(r_) * (p[2] % r_));
  }

  // By decreasing size, those of the same size by index.
  void sort_buckets() {
    begin_.assign(cube(r_) + 1, 0);
    for (const HashedVoxel& v : voxels_) ++begin_[bucket_of(v.position) + 1];
    order_.clear();
    for (std::size_t b = 0; b < cube(r_); ++b)
      if (begin_[b + 1] > 0) order_.push_back(std::uint32_t(b));
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return begin_[a + 1] > begin_[b + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    members_.resize(voxels_.size());
    std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < voxels_.size(); ++i) members_[at[bucket_of(voxels_[i].position)]++] = std::uint32_t(i);
  }
  Bucket bucket(std::size_t i) const {
    const std::size_t index = order_[i];
    return {index, begin_[index + 1] - begin_[index], members_.data() + begin_[index]};
  }

  std::size_t slot(std::uint32_t voxel, const Vector3i& offset) const {
    const Vector3i& p = voxels_[voxel].position;
    return (p[0] + offset[0]) % m_ +
           std::size_t(m_) * ((p[1] + offset[1]) % m_ + std::size_t(m_) * ((p[2] + offset[2]) % m_));
  }
  // Slots of one bucket differ whatever the offset: its positions are the same modulo r, so they differ modulo m.
  bool fits(const Bucket& b, const Vector3i& offset) {
    for (std::size_t k = 0; k < b.size; ++k)
      if (taken_[slot(b.first[k], offset)]) return false;
    offset_ = offset;
    return true;
  }

  bool find_offset(const Bucket& b, const std::vector<std::uint32_t>& offsets) {
    // First try the offsets of the neighbouring buckets: voxels that lie together are then read together.
    const int r = r_;
    const Vector3i at(int(b.index % r), int(b.index / r % r), int(b.index / r / r));
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Vector3i beside = at;
        beside[axis] = (at[axis] + step + r) % r;
        const std::size_t i = beside[0] + std::size_t(r) * (beside[1] + std::size_t(r) * beside[2]);
        const std::uint32_t o = offsets[i];
        if (placed_[i] && fits(b, {int(o & 1023), int(o >> 10 & 1023), int(o >> 20)})) return true;
      }
    const auto random = [&](std::uint32_t i) {
      const PhiloxCounter w =
          philox4x32_10({i, std::uint32_t(b.index), std::uint32_t(m_), std::uint32_t(r_)}, {seed_, 0});
      return Vector3i(int(w[0] % m_), int(w[1] % m_), int(w[2] % m_));
    };
    for (std::uint32_t i = 0; i < random_tries; ++i)
      if (fits(b, random(i))) return true;
    Vector3i offset = random(random_tries);
    for (std::size_t i = 0; i < cube(m_); ++i) {
      if (fits(b, offset)) return true;
      for (int axis = 0; axis < 3; ++axis) {
        if (++offset[axis] < m_) break;
        offset[axis] = 0;
      }
    }
    return false;
  }

  // There is one: m^3 >= K.
  void take_next_free(const Bucket& b) {
    while (taken_[next_free_]) ++next_free_;
    const Vector3i& p = voxels_[b.first[0]].position;
    const int m = m_;
    const Vector3i free(int(next_free_ % m), int(next_free_ / m % m), int(next_free_ / m / m));
    for (int axis = 0; axis < 3; ++axis) offset_[axis] = ((free[axis] - p[axis]) % m + m) % m;
  }

  Vector3i extent_;
  const std::vector<HashedVoxel>& voxels_;
  std::uint32_t seed_;
  int m_ = 0, r_ = 0;
  std::vector<std::uint32_t> begin_, order_, members_;
  std::vector<std::uint8_t> taken_, placed_;
  std::size_t next_free_ = 0;
  Vector3i offset_ = Vector3i::Zero();
};

// The bits of the domain; throws for what is no set of voxels in it.
std::vector<std::uint64_t> domain_of(const Vector3i& extent, const std::vector<HashedVoxel>& voxels) {
  std::vector<std::uint64_t> domain((std::size_t(extent[0]) * extent[1] * extent[2] + 63) / 64, 0);
  for (const HashedVoxel& v : voxels) {
    const Vector3i& p = v.position;
    const std::string where = fmt::format("voxel ({}, {}, {})", p[0], p[1], p[2]);
    if ((p.array() < 0).any() || (p.array() >= extent.array()).any())
      throw Error(fmt::format("{} outside the domain of {} x {} x {}", where, extent[0], extent[1], extent[2]));
    if (v.value == 0) throw Error(where + " has the value 0, expected another");
    const std::size_t bit = p[0] + std::size_t(extent[0]) * (p[1] + std::size_t(extent[1]) * p[2]);
    if (domain[bit / 64] >> bit % 64 & 1) throw Error(where + " is given twice");
    domain[bit / 64] |= std::uint64_t(1) << bit % 64;
  }
  return domain;
}

}  // namespace

PerfectHash perfect_hash(const Vector3i& extent, const std::vector<HashedVoxel>& voxels, const HashOptions& options) {
  if ((extent.array() < 0).any() || double(extent[0]) * extent[1] * extent[2] >= 0x1p32)
    throw Error(
        fmt::format("a domain of {} x {} x {} positions, expected fewer than 2^32", extent[0], extent[1], extent[2]));
  if (voxels.size() > std::size_t(1) << 27) throw Error(fmt::format("{} voxels, expected 2^27 at most", voxels.size()));
  PerfectHash hash;
  hash.extent = extent;
  hash.voxels = voxels.size();
  if (voxels.empty()) return hash;
  hash.domain = domain_of(extent, voxels);
  hash.m = root(voxels.size());
  hash.r = first_r(voxels.size(), options.offsets);
  Construction construction(extent, voxels, options.seed);
  for (;;) {
    // Along a line no r will do that is not far larger than m: then both rise.
    while (hash.m <= most_m && (!suits(hash.m, hash.r) || !tells_apart(extent, voxels, hash.m, hash.r)))
      ++(hash.r < std::min(most_r, 4 * hash.m + 64) ? hash.r : hash.m);
    if (hash.m > most_m)
      throw Error(fmt::format("no perfect hash of {} voxels with {}^3 slots", voxels.size(), most_m));
    if (construction.place(hash)) break;
    ++hash.r;
    if (++hash.retries % 8 == 0) ++hash.m;
  }
  hash.values.assign(cube(hash.m), 0);
  hash.tags.assign(cube(hash.m), 0);
  for (const HashedVoxel& v : voxels) {
    const std::size_t at = hash.slot(v.position);
    hash.values[at] = v.value;
    hash.tags[at] = std::uint32_t(v.position[0] +
                                  std::size_t(extent[0]) * (v.position[1] + std::size_t(extent[1]) * v.position[2]));
  }
  return hash;
}

}  // namespace airlight::scene
