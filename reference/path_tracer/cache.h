// References kept on disk: one range file per picture and number of samples, named by the content of scene, view,
// settings, seed and build, and by that number.
//
// A picture never depends on what the folder holds: its samples are exactly those asked for, and its bits, and its
// counters, those of a render in one go. Where there are fewer samples already (whole blocks of 64), only the missing
// ones are computed; those of a file that holds more are joined to larger sums and cannot be told apart again, so it is
// not used. What is done is written every few seconds, atomically, so that a process killed at any moment loses those
// seconds and nothing else. A picture with a target error stops by what it has computed: it is written when it is
// whole.
//
// Several computers may share the samples of a picture: each keeps a range of them in a file of its own (keep_range), and a
// render through the folder starts from all ranges that are there.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reference/path_tracer/accumulation.h"
#include "scene/base/atomic_file.h"
#include "scene/base/content_store.h"

namespace airlight::path_tracer {

struct CachedRendering {
  scene::Film film;                // as to_film; metadata "complete" is "false" after an interruption
  Counters counters;               // of all samples, also those that were there
  double seconds = 0;              // wall clock that all the samples took
  std::uint64_t found = 0;         // samples of every pixel that were there already, in ranges or from the first on
  std::vector<std::string> notes;  // a damaged file that was set aside, one line each
  bool complete = true;
  std::optional<scene::CannotWrite> not_kept;  // why the folder does not have these samples
};

// Where the samples of a picture are kept, for so many samples and that target error.
std::string cache_file(const std::string& folder, const Identity&, const Options&);

// Where the samples of all pictures lie in a store.
std::string samples_folder(const scene::ContentStore&);

// Where one computer keeps its samples [begin, end) of a picture.
std::string range_file(const std::string& folder, const Identity&, std::uint64_t begin, std::uint64_t end);

// Renders the samples [begin, end) of every pixel into the folder, and goes on where a file of this range ends. Returns false where progress
// stopped it: what is done is kept. Throws Error for a range that is not of whole blocks of 64 samples within
// options().samples, or a picture with a target error; CannotWrite where the samples cannot be kept.
bool keep_range(const World&, const scene::View&, const std::string& folder, std::uint64_t begin, std::uint64_t end,
                const scene::Execution&, double save_every = 10);

// Renders options().samples per pixel, or to its target error, through the folder (created if needed). Where progress
// returns false it keeps and writes what is done; throws Interrupted if there is a pixel without any. A file that
// cannot be read is renamed to *.damaged, noted and not used. A file that cannot be written takes nothing from the
// picture: `not_kept` says why. Throws CannotWrite where the folder cannot be made. `save_every` is in seconds.
CachedRendering render_cached(const World&, const scene::View&, const std::string& folder, const scene::Execution&,
                              double save_every = 10);

}  // namespace airlight::path_tracer
