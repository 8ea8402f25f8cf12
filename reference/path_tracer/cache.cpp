#include "reference/path_tracer/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <functional>
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

struct KeptSamples {
  std::uint64_t begin = 0, end = 0;
  bool range = false;  // a file of keep_range
  std::string path;
};

// "4096" or "0..64"; nothing for other texts.
std::optional<KeptSamples> kept_samples(const std::string& text) {
  const auto number = [](const std::string& part, std::uint64_t& value) {
    const auto [stop, code] = std::from_chars(part.data(), part.data() + part.size(), value);
    return code == std::errc() && stop == part.data() + part.size();
  };
  KeptSamples kept;
  const std::size_t dots = text.find("..");
  kept.range = dots != std::string::npos;
  if (kept.range && !number(text.substr(0, dots), kept.begin)) return std::nullopt;
  if (!number(kept.range ? text.substr(dots + 2) : text, kept.end)) return std::nullopt;
  return kept;
}

// Files with other samples of this picture than `wanted` of them from the first on: first those from the first on, the
// greatest first; then ranges in their order.
std::vector<KeptSamples> other_files(const std::string& folder, const Identity& id, std::uint64_t wanted) {
  const std::string start = picture_name(id) + ".", end = ".samples";
  std::vector<KeptSamples> files;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (!name.starts_with(start) || !name.ends_with(end) || name.size() <= start.size() + end.size()) continue;
    auto kept = kept_samples(name.substr(start.size(), name.size() - start.size() - end.size()));
    if (!kept || kept->end > wanted || (!kept->range && kept->end == wanted)) continue;
    kept->path = file.path().string();
    files.push_back(*kept);
  }
  std::sort(files.begin(), files.end(), [](const KeptSamples& a, const KeptSamples& b) {
    if (a.range != b.range) return b.range;
    return a.range ? a.begin < b.begin : a.end > b.end;
  });
  return files;
}

// The samples of this picture that the folder contains; `ranges`: the files of ranges that there are.
Accumulation start_from(const World& world, const scene::View& view, const std::string& folder,
                        std::vector<std::string>& notes, std::vector<std::string>& ranges) {
  const Options& options = world.options();
  Accumulation fresh = empty_accumulation(world, view);
  if (auto found = load(fresh, cache_file(folder, fresh.identity, options), options.samples, notes)) return *found;
  if (options.target_error > 0) return fresh;
  Accumulation samples = fresh;
  std::uint64_t covered = 0;
  for (const KeptSamples& file : other_files(folder, fresh.identity, options.samples)) {
    if (file.range) ranges.push_back(file.path);
    if (file.begin < covered || (!file.range && covered > 0)) continue;
    auto found = load(fresh, file.path, file.end, notes);
    if (!found || (file.end < options.samples && !in_whole_blocks(*found))) continue;
    merge_into(samples, std::move(*found));
    covered = file.end;
  }
  return samples;
}

// Renders in passes: each runs until it is time to save, and the next adds what is missing. `render` returns false where its progress
// stopped it; `save` hears whether all is there. Returns whether all `wanted` samples of each pixel are.
bool render_and_save(const Accumulation& samples, std::uint64_t wanted, const scene::Execution& execution,
                     double save_every, const std::function<bool(const scene::Execution&)>& render,
                     const std::function<void(bool)>& save) {
  for (;;) {
    const auto start = Clock::now();
    const double already = double(samples.least_samples());
    std::atomic<bool> asked_to_stop{false};
    scene::Execution pass = execution;
    pass.progress = [&](double fraction) {
      if (execution.progress && !execution.progress(std::max(fraction, already / double(wanted)))) asked_to_stop = true;
      return !asked_to_stop && std::chrono::duration<double>(Clock::now() - start).count() < save_every;
    };
    const bool whole = render(pass);
    save(whole);
    if (whole || asked_to_stop) return whole;
  }
}

}  // namespace

std::string cache_file(const std::string& folder, const Identity& id, const Options& options) {
  const std::string error = options.target_error > 0 ? fmt::format("error{}.", options.target_error) : "";
  return (std::filesystem::path(folder) / fmt::format("{}.{}{}.samples", picture_name(id), error, options.samples))
      .string();
}

std::string samples_folder(const scene::ContentStore& store) { return (store.folder() / "samples").string(); }

std::string range_file(const std::string& folder, const Identity& id, std::uint64_t begin, std::uint64_t end) {
  return (std::filesystem::path(folder) / fmt::format("{}.{}..{}.samples", picture_name(id), begin, end)).string();
}

bool keep_range(const World& world, const scene::View& view, const std::string& folder, std::uint64_t begin,
                std::uint64_t end, const scene::Execution& execution, double save_every) {
  const Options& options = world.options();
  if (options.target_error > 0) throw Error("path_tracer: a picture with a target error has no ranges of samples");
  if (begin >= end || end > options.samples || begin % leaf_samples != 0 ||
      (end % leaf_samples != 0 && end != options.samples))
    throw Error(fmt::format("path_tracer: found the range {}..{} of samples, expected multiples of {} within 0..{}",
                            begin, end, leaf_samples, options.samples));
  scene::make_private_folder(folder);
  const Accumulation fresh = empty_accumulation(world, view);
  const std::string path = range_file(folder, fresh.identity, begin, end);
  std::vector<std::string> notes;
  Accumulation samples = load(fresh, path, end, notes).value_or(fresh);
  if (execution.store)
    for (const std::string& note : notes) execution.store->say(note);
  return render_and_save(
      samples, end - begin, execution, save_every,
      [&](const scene::Execution& pass) { return render_range(world, view, begin, end, pass, samples); },
      [&](bool) { write_range_file(path, samples); });
}

CachedRendering render_cached(const World& world, const scene::View& view, const std::string& folder,
                              const scene::Execution& execution, double save_every) {
  scene::make_private_folder(folder);
  CachedRendering result;
  const Options& options = world.options();
  std::vector<std::string> ranges;
  Accumulation samples = start_from(world, view, folder, result.notes, ranges);
  const std::string path = cache_file(folder, samples.identity, options);
  result.found = samples.least_samples();

  // Tiles that stop by their error must see the same samples at each decision: their picture is made in one pass.
  const bool adaptive = options.target_error > 0;
  std::uint64_t written = ranges.empty() ? samples.counters.paths : 0;  // what ranges have is written together
  const auto save = [&](bool whole) {
    if (samples.counters.paths == written || (adaptive && !whole)) return;
    result.not_kept.reset();
    try {
      write_range_file(path, samples);
      written = samples.counters.paths;
    } catch (const scene::CannotWrite& error) {  // a full disk does not take the picture
      result.not_kept = error;
    }
  };
  if (!adaptive || result.found == 0)
    result.complete = render_and_save(
        samples, options.samples, execution, adaptive ? infinity : save_every,
        [&](const scene::Execution& pass) { return render_to_target(world, view, pass, samples); }, save);
  if (samples.least_samples() == 0) throw scene::Interrupted("interrupted before every pixel had a sample");
  if (result.complete && !result.not_kept)
    for (const std::string& range : ranges) {  // the file of all samples has them now
      std::error_code ignored;
      std::filesystem::remove(range, ignored);
    }
  result.film = to_film(world, view, samples);
  result.film.metadata["complete"] = result.complete ? "true" : "false";
  result.counters = samples.counters;
  result.seconds = samples.seconds;
  return result;
}

}  // namespace airlight::path_tracer
