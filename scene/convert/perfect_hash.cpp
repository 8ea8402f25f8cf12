#include "scene/convert/perfect_hash.h"

#include <fmt/format.h>

#include "scene/base/error.h"

namespace airlight::scene {
namespace {

using Eigen::Vector3i;

std::size_t linear(const Vector3i& p, int x, int y) { return p[0] + std::size_t(x) * (p[1] + std::size_t(y) * p[2]); }
bool inside(const PerfectHash& h, const Vector3i& p) {
  return h.m > 0 && (p.array() >= 0).all() && (p.array() < h.extent.array()).all();
}

}  // namespace

std::size_t PerfectHash::offset_slot(const Vector3i& p) const { return linear({p[0] % r, p[1] % r, p[2] % r}, r, r); }

std::size_t PerfectHash::slot(const Vector3i& p) const {
  const std::uint32_t o = offsets[offset_slot(p)];
  return linear({int((p[0] + (o & 1023)) % m), int((p[1] + (o >> 10 & 1023)) % m), int((p[2] + (o >> 20)) % m)}, m, m);
}

int PerfectHash::value_by_tag(const Vector3i& p) const {
  if (!inside(*this, p)) return 0;
  const std::size_t at = slot(p);
  return tags[at] == linear(p, extent[0], extent[1]) ? values[at] : 0;  // a free slot has the value 0
}

int PerfectHash::value_by_domain(const Vector3i& p) const {
  if (!inside(*this, p)) return 0;
  const std::size_t bit = linear(p, extent[0], extent[1]);
  return domain[bit / 64] >> bit % 64 & 1 ? values[slot(p)] : 0;
}

std::size_t PerfectHash::bytes_with_tags() const {
  const std::size_t positions = std::size_t(extent[0]) * extent[1] * extent[2];
  return (m <= 256 ? 3 : 4) * offsets.size() + (positions <= std::size_t(1) << 24 ? 4 : 5) * values.size();
}

std::size_t PerfectHash::bytes_with_domain() const {
  const std::size_t positions = m > 0 ? std::size_t(extent[0]) * extent[1] * extent[2] : 0;
  return (m <= 256 ? 3 : 4) * offsets.size() + values.size() + (positions + 7) / 8;
}

std::vector<HashedVoxel> hashed_voxels(const Vector3i& size, const std::vector<std::int8_t>& levels) {
  std::vector<HashedVoxel> voxels;
  std::size_t i = 0;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x, ++i)
        if (levels[i] != 0) voxels.push_back({{x, y, z}, levels[i]});
  return voxels;
}

std::string imperfection(const PerfectHash& hash, const std::vector<HashedVoxel>& voxels) {
  if (hash.voxels != voxels.size()) return fmt::format("{} voxels, expected {}", hash.voxels, voxels.size());
  const Vector3i e = hash.extent;
  std::vector<std::int8_t> expected(std::size_t(e[0]) * e[1] * e[2], 0);
  std::vector<bool> taken(hash.values.size());
  for (const HashedVoxel& v : voxels) {
    expected[linear(v.position, e[0], e[1])] = v.value;
    const std::size_t slot = hash.slot(v.position);
    if (taken[slot]) return fmt::format("slot {} is taken twice", slot);
    taken[slot] = true;
  }
  std::size_t i = 0;
  for (int z = 0; z < e[2]; ++z)
    for (int y = 0; y < e[1]; ++y)
      for (int x = 0; x < e[0]; ++x, ++i) {
        const Vector3i p(x, y, z);
        const int by_tag = hash.value_by_tag(p), by_domain = hash.value_by_domain(p);
        if (by_tag != expected[i] || by_domain != expected[i])
          return fmt::format("({}, {}, {}) decodes to {} by its tag, {} by its bit, expected {}", x, y, z, by_tag,
                             by_domain, expected[i]);
      }
  return {};
}

}  // namespace airlight::scene
