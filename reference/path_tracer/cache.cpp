#include "reference/path_tracer/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <optional>

#include "reference/path_tracer/stopping.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"

namespace airlight::path_tracer {
namespace {

using Clock = std::chrono::steady_clock;

// Blocks of 64 samples from the first on, without one that is not whole.
bool in_whole_blocks(const Accumulation& a) {
  for (const auto& nodes : a.tiles)
    for (const TallyNode& node : nodes)
      if (!node.complete()) return false;
  return true;
}

bool within(const Accumulation& a, std::uint64_t samples) {
  for (const auto& nodes : a.tiles)
    if (!nodes.empty() && nodes.back().end() > samples) return false;
  return true;
}

// The samples in the file if they are of this picture and none lies beyond `samples`; a file that is no good is set
// aside.
std::optional<Accumulation> load(const Accumulation& fresh, const std::string& path, std::uint64_t samples,
                                 std::vector<std::string>& notes) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  std::string reason;
  try {
    Accumulation found = read_range_file(path);
    reason = difference(found.identity, fresh.identity);
    if (reason.empty() && (found.width != fresh.width || found.height != fresh.height || found.layout != fresh.layout))
      reason = "film size or layers differ";
    if (reason.empty() && !within(found, samples)) reason = fmt::format("there are samples beyond {}", samples);
    if (reason.empty()) return found;
    reason = fmt::format("{}: {}", path, reason);
  } catch (const Error& error) {
    reason = error.what();
  }
  std::error_code ignored;
  std::filesystem::rename(path, path + ".damaged", ignored);
  notes.push_back(fmt::format("{}; set aside as {}.damaged, rendered again", reason, path));
  return std::nullopt;
}

std::string picture_name(const Identity& id) {
  return content_key({id.scene, id.view, id.settings, std::to_string(id.seed), std::to_string(id.stream), id.build});
}

// Numbers of samples, fewer than `samples`, for which the folder has a file of this picture; the greatest first.
std::vector<std::uint64_t> fewer_samples(const std::string& folder, const Identity& id, std::uint64_t samples) {
  const std::string start = picture_name(id) + ".", end = ".samples";
  std::vector<std::uint64_t> counts;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (!name.starts_with(start) || !name.ends_with(end) || name.size() <= start.size() + end.size()) continue;
    const char *from = name.data() + start.size(), *to = name.data() + name.size() - end.size();
    std::uint64_t count = 0;
    const auto [stop, code] = std::from_chars(from, to, count);
    if (code == std::errc() && stop == to && count < samples) counts.push_back(count);
  }
  std::sort(counts.rbegin(), counts.rend());
  return counts;
}

// The first samples of this picture that the folder contains.
Accumulation start_from(const World& world, const scene::View& view, const std::string& folder,
                        std::vector<std::string>& notes) {
  Options options = world.options();
  Accumulation fresh = empty_accumulation(world, view);
  if (auto found = load(fresh, cache_file(folder, fresh.identity, options), options.samples, notes)) return *found;
  if (options.target_error > 0) return fresh;
  for (const std::uint64_t count : fewer_samples(folder, fresh.identity, options.samples)) {
    options.samples = count;
    auto found = load(fresh, cache_file(folder, fresh.identity, options), count, notes);
    if (found && in_whole_blocks(*found)) return *found;
  }
  return fresh;
}

}  // namespace

std::string cache_file(const std::string& folder, const Identity& id, const Options& options) {
  const std::string error = options.target_error > 0 ? fmt::format("error{}.", options.target_error) : "";
  return (std::filesystem::path(folder) / fmt::format("{}.{}{}.samples", picture_name(id), error, options.samples))
      .string();
}

CachedRendering render_cached(const World& world, const scene::View& view, const std::string& folder,
                              const scene::Execution& execution, double save_every) {
  scene::make_private_folder(folder);
  CachedRendering result;
  const Options& options = world.options();
  Accumulation samples = start_from(world, view, folder, result.notes);
  const std::string path = cache_file(folder, samples.identity, options);
  const bool adaptive = options.target_error > 0;
  result.found = samples.least_samples();

  // Each pass runs until it is time to save: stopping keeps what is done, and the next pass adds what is missing. Tiles
  // that stop by their error must see the same samples at each decision: their picture is made in one pass.
  const bool kept = adaptive && result.found > 0;
  while (!kept) {
    const auto start = Clock::now();
    const double already = double(samples.least_samples());
    std::atomic<bool> asked_to_stop{false};
    scene::Execution pass = execution;
    pass.progress = [&](double fraction) {
      if (execution.progress && !execution.progress(std::max(fraction, already / double(options.samples))))
        asked_to_stop = true;
      return !asked_to_stop && (adaptive || std::chrono::duration<double>(Clock::now() - start).count() < save_every);
    };
    const std::uint64_t before = samples.counters.paths;
    result.complete = render_to_target(world, view, pass, samples);
    if (samples.counters.paths != before && (result.complete || !adaptive)) {
      result.not_kept.reset();
      try {
        write_range_file(path, samples);
      } catch (const scene::CannotWrite& error) {  // a full disk does not take the picture
        result.not_kept = error;
      }
    }
    if (result.complete || asked_to_stop) break;
  }
  if (samples.least_samples() == 0) throw scene::Interrupted("interrupted before every pixel had a sample");
  result.film = to_film(world, view, samples);
  result.film.metadata["complete"] = result.complete ? "true" : "false";
  result.counters = samples.counters;
  result.seconds = samples.seconds;
  return result;
}

}  // namespace airlight::path_tracer
