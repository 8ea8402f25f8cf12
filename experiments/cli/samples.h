// Ranges of samples of the path tracer: computed apart, merged to the same bits.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "scene/renderer.h"

namespace airlight::experiments::cli {

struct SampleRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  bool explicit_range = false;  // "A..B" rather than "N"
};

// "N" or "A..B", A a multiple of 64 (samples are summed in such blocks); nothing for an empty text. Throws Error.
std::optional<SampleRange> sample_range(const std::string& text);

// Renders the range, writes its samples to `samples_file`, and returns the film of it. Stopped early it keeps what is
// done; throws Interrupted if there is nothing.
scene::Film render_samples(const std::shared_ptr<const scene::Scene>&, const scene::Settings&, const SampleRange&,
                           const scene::Execution&, const std::string& samples_file);

// Renders with the path tracer and shows the picture so far after 64, 128, 256, ... samples. The result has the bits that the renderer makes
// in one go.
scene::Film render_in_passes(const std::shared_ptr<const scene::Scene>&, const scene::Settings&,
                             const scene::Execution&, const std::function<void(const scene::Film&)>& show);

}  // namespace airlight::experiments::cli
