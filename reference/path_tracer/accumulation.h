// Samples of a picture, in ranges that can be computed anywhere, kept in files and merged: the result has the same bits
// however the samples were split, as long as every split is a multiple of 64.
#pragma once
#include <string>
#include <vector>

#include "reference/path_tracer/counters.h"
#include "reference/path_tracer/identity.h"
#include "reference/path_tracer/path.h"
#include "reference/path_tracer/tally.h"

namespace airlight::path_tracer {

inline constexpr int tile_size = 8;  // pixels; a tile is what one thread works on, and what stops by its error

struct Accumulation {
  Identity identity;
  int width = 0;
  int height = 0;
  TallyLayout layout;
  std::vector<std::vector<TallyNode>> tiles;  // row by row; the nodes of each in order of samples
  Counters counters;
  double seconds = 0;  // wall clock that the samples took, all machines together

  int tiles_across() const { return (width + tile_size - 1) / tile_size; }
  int tiles_down() const { return (height + tile_size - 1) / tile_size; }
  // Samples of every pixel, at least.
  std::uint64_t least_samples() const;
};

Accumulation empty_accumulation(const World&, const scene::View&);

// Adds those samples of [begin, end) of every pixel (or of the tiles listed) that are not there yet. begin must be a
// multiple of 64. Stops early where progress returns false, and keeps what is done: returns false then. Throws Error
// for a sample that is not finite (with pixel and sample) and for a majorant that was exceeded (the samples are void).
bool render_range(const World&, const scene::View&, std::uint64_t begin, std::uint64_t end, const scene::Execution&,
                  Accumulation&, const std::vector<int>* tiles = nullptr);

// A range file: binary, checksummed, written atomically. Throws Error naming the file and what is wrong with it.
void write_range_file(const std::string& path, const Accumulation&);
Accumulation read_range_file(const std::string& path);

// Joins two sets of samples of one picture. Throws Error if they belong to different pictures or overlap.
void merge_into(Accumulation&, Accumulation other);
// The files together; also throws where samples are missing between them.
Accumulation merge_range_files(const std::vector<std::string>& paths);

// The picture with all its layers and metadata (spec/references.md, section 5). World and View are those of the
// samples. `se` is an upper end where next to no samples brought light (certainty.h); metadata "warning" is set where
// none did. Throws Error, with pixel and layer, for a value that single precision cannot hold.
scene::Film to_film(const World&, const scene::View&, const Accumulation&);

}  // namespace airlight::path_tracer
