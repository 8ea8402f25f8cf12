// Perfect spatial hash of a sparse residual: Lefebvre and Hoppe 2006, "Perfect spatial hashing", as Zhou et al. 2008, section 5.2, use it.
//
//   value(p) = H[(p + Phi[p mod r]) mod m],  per axis, H of m^3 slots, Phi of r^3 offsets, if p is one of the stored positions, else 0
//
// No two stored positions share a slot: two dependent reads, no search. Which positions are stored is told by tags or by a bit each.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace airlight::scene {

struct HashedVoxel {
  Eigen::Vector3i position;
  std::int8_t value = 0;  // not 0
};

struct HashOptions {
  // The first r from the number K of voxels, rounded up: cbrt(K/3) + 9, as Zhou et al. print it; cbrt(K)/3 + 9, as it can be read too;
  // cbrt(K/6), Lefebvre and Hoppe's.
  enum class Offsets { thirds, root_thirds, sixths } offsets = Offsets::thirds;
  std::uint32_t seed = 1;
};

struct PerfectHash {
  Eigen::Vector3i extent = Eigen::Vector3i::Zero();  // of the domain
  int m = 0, r = 0;                                  // 0 without voxels
  std::vector<std::uint32_t> offsets;                // r^3, x | y << 10 | z << 20, each below m; x fastest
  std::vector<std::int8_t> values;                   // m^3, 0 where free; x fastest
  std::vector<std::uint32_t> tags;                   // m^3: x + extent_x (y + extent_y z) of the position
  std::vector<std::uint64_t> domain;                 // a bit for each position, lowest first: is it stored
  std::size_t voxels = 0;                            // K
  int retries = 0;                                   // constructions that failed before this one
  int largest_bucket = 0;                            // positions that share an offset

  // The slot and the offset of a position inside the domain.
  std::size_t offset_slot(const Eigen::Vector3i& position) const;
  std::size_t slot(const Eigen::Vector3i& position) const;
  // The value at a position, 0 where none is stored and outside the domain; by its tag, or by its bit in the domain.
  int value_by_tag(const Eigen::Vector3i& position) const;
  int value_by_domain(const Eigen::Vector3i& position) const;

  // Size on a device. Offsets take 3 bytes, or 4 where m is above 256. With tags a slot is a word of value and tag if
  // the tag fits 24 bits, else 5 bytes; with domain bits it is a byte.
  std::size_t bytes_with_tags() const;
  std::size_t bytes_with_domain() const;
};

// Deterministic in the voxels, their order and the seed. Throws Error for a voxel outside the domain, one given twice, a value of 0, a
// domain of 2^32 positions or more, or K above 2^27.
PerfectHash perfect_hash(const Eigen::Vector3i& extent, const std::vector<HashedVoxel>&, const HashOptions& = {});

// The voxels of a frame, x fastest, whose level is not 0.
std::vector<HashedVoxel> hashed_voxels(const Eigen::Vector3i& size, const std::vector<std::int8_t>& levels);

// Whether the hash is what it says of these voxels: each has a slot of its own, and every position of the domain decodes to what is stored
// there, by tag and by domain bit. In one line what is wrong; empty if nothing.
std::string imperfection(const PerfectHash&, const std::vector<HashedVoxel>&);

}  // namespace airlight::scene
