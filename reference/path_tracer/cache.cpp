#include "reference/path_tracer/cache.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <atomic>
#include <chrono>
#include <filesystem>

#include "reference/path_tracer/refusals.h"
#include "reference/path_tracer/stopping.h"
#include "scene/error.h"

namespace airlight::path_tracer {
namespace {

using Clock = std::chrono::steady_clock;

// The samples in the file, or none; a file that is no good is set aside.
Accumulation load(const World& world, const scene::View& view, const std::string& path,
                  std::vector<std::string>& notes) {
  Accumulation fresh = empty_accumulation(world, view);
  if (!std::filesystem::exists(path)) return fresh;
  std::string reason;
  try {
    Accumulation found = read_range_file(path);
    reason = difference(found.identity, fresh.identity);
    if (reason.empty() && found.width == fresh.width && found.height == fresh.height && found.layout == fresh.layout)
      return found;
  } catch (const Error& error) {
    reason = error.what();
  }
  std::error_code ignored;
  std::filesystem::rename(path, path + ".damaged", ignored);
  notes.push_back(fmt::format("{}; set aside as {}.damaged, rendered again", reason, path));
  return fresh;
}

}  // namespace

std::string cache_file(const std::string& folder, const Identity& id) {
  const std::string text =
      fmt::format("{}\n{}\n{}\n{}\n{}\n{}", id.scene, id.view, id.settings, id.seed, id.stream, id.build);
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return (std::filesystem::path(folder) / fmt::format("{:016x}{:016x}.samples", hash.high64, hash.low64)).string();
}

CachedRendering render_cached(const World& world, const scene::View& view, const std::string& folder,
                              const scene::Execution& execution, double save_every) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) throw Error(fmt::format("{}: cannot be created: {}", folder, code.message()));

  CachedRendering result;
  const std::string path = cache_file(folder, empty_accumulation(world, view).identity);
  Accumulation samples = load(world, view, path, result.notes);
  result.found = samples.least_samples();

  // Each pass runs until it is time to save: stopping keeps what is done, and the next pass adds what is missing.
  for (;;) {
    const auto start = Clock::now();
    const double already = double(samples.least_samples());
    std::atomic<bool> asked_to_stop{false};
    scene::Execution pass = execution;
    pass.progress = [&](double fraction) {
      if (execution.progress && !execution.progress(std::max(fraction, already / double(world.options().samples))))
        asked_to_stop = true;
      return !asked_to_stop && std::chrono::duration<double>(Clock::now() - start).count() < save_every;
    };
    const std::uint64_t before = samples.counters.paths;
    result.complete = render_to_target(world, view, pass, samples);
    if (samples.counters.paths != before) write_range_file(path, samples);
    if (result.complete || asked_to_stop) break;
  }
  if (samples.least_samples() == 0) throw scene::Interrupted("interrupted before every pixel had a sample");
  result.film = to_film(world, view, samples);
  result.film.metadata["complete"] = result.complete ? "true" : "false";
  result.counters = samples.counters;
  result.seconds = samples.seconds;
  return result;
}

CachedRendering render_cached(std::shared_ptr<const scene::Scene> scene, const scene::Settings& settings,
                              const scene::View& view, const std::string& folder, const scene::Execution& execution) {
  const Options options = parse_options(settings);
  if (const auto reasons = refusals(*scene, options); !reasons.empty())
    throw Error(fmt::format("path_tracer: {}", reasons.front()));
  return render_cached(World(std::move(scene), options), view, folder, execution);
}

}  // namespace airlight::path_tracer
