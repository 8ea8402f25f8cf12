#include "experiments/application/fit_sequence.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "experiments/application/build_info.h"
#include "experiments/application/folder_lock.h"
#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "scene/base/atomic_file.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"
#include "scene/base/file_ending.h"
#include "scene/base/read_file.h"
#include "scene/convert/residual_file.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/scene.h"

namespace airlight::experiments {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using scene::GaussianFit;
using scene::VoxelGrid;

constexpr std::size_t most_bytes = std::size_t(1) << 34;

VoxelGrid grid_of_medium(const std::string& file, const std::string& choice) {
  const scene::Scene scene = scene::load_scene(file);
  std::size_t number = scene.media.size();
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    if (!scene.media[i].name.empty() && scene.media[i].name == choice) number = i;
  if (number == scene.media.size()) {
    const auto [stop, code] = std::from_chars(choice.data(), choice.data() + choice.size(), number);
    if (code != std::errc() || stop != choice.data() + choice.size() || number >= scene.media.size())
      throw Error(fmt::format("{}: --medium {}: expected the name of one of {} media, or its number from 0", file,
                              choice, scene.media.size()));
  }
  const auto* grid = std::get_if<scene::GridPointer>(&scene.media[number].field);
  if (!grid)
    throw Error(fmt::format("{}: {} is {}, expected a grid", file, scene::label(scene.media, number),
                            scene::field_name(scene.media[number].field)));
  return **grid;
}

VoxelGrid read_frame(const FitSequence& s, const std::string& file) {
  return scene::file_ending(file) == ".toml" ? grid_of_medium(file, s.medium) : scene::read_vdb(file, s.grid);
}

// Key of the grid that a frame was made from; the name of its file does not count.
std::string content_of(const VoxelGrid& grid) {
  const auto bytes = [](const auto* data, std::size_t count) {
    return std::string(reinterpret_cast<const char*>(data), count * sizeof *data);
  };
  return content_key({bytes(grid.size.data(), 3), bytes(grid.origin_index.data(), 3), bytes(grid.rotation.data(), 9),
                      bytes(&grid.voxel_size, 1), bytes(grid.translation.data(), 3),
                      bytes(grid.values.data(), grid.values.size())});
}

// Refuses densities that would give amplitudes or a residual that no scene may have.
void check_densities(const FitSequence& s, const std::string& file, const VoxelGrid& grid) {
  const float greatest = grid.values.empty() ? 0 : *std::max_element(grid.values.begin(), grid.values.end());
  const scene::load::Range& range = scene::load::density_range;
  const scene::load::Range wanted = scene::load::or_zero({range.least / s.options.amplitudes.lo, range.greatest});
  if (!wanted.contains(greatest))
    throw Error(fmt::format("{}: found a greatest density of {}, expected {}", file, greatest, wanted.words()));
}

struct Frame {
  std::string file, name, content;
};

// Facts about all frames, collected before the first is fitted.
struct Survey {
  std::vector<Frame> frames;
  double unit = 0;
};
Survey survey(const FitSequence& s) {
  Survey found;
  std::set<std::string> names;
  Eigen::Array3d lo = Eigen::Array3d::Constant(infinity), hi = -lo;
  double voxel = 0, widest = 0;
  bool one_lattice = true;
  for (const std::string& file : s.files) {
    const std::string name = fs::path(file).stem().string();
    if (name == "record" || !names.insert(name).second)
      throw Error(
          fmt::format("{}: its results would be called {}.csv, as others' are; expected another name", file, name));
    const VoxelGrid grid = read_frame(s, file);
    check_densities(s, file, grid);
    found.frames.push_back({file, name, content_of(grid)});
    if (grid.values.empty()) continue;
    one_lattice &= voxel == 0 || std::abs(grid.voxel_size - voxel) <= 1e-9 * voxel;
    voxel = grid.voxel_size;
    lo = lo.min(grid.origin_index.cast<double>().array());
    hi = hi.max((grid.origin_index + grid.size).cast<double>().array());
    widest = std::max(widest, scene::fit_unit(grid));
  }
  found.unit = s.options.unit > 0         ? s.options.unit
               : one_lattice && voxel > 0 ? voxel * std::cbrt((hi - lo).prod())
                                          : widest;
  return found;
}

std::string key_of(const FitSequence& s, double unit) {
  const scene::FitOptions& o = s.options;
  return content_key({source_id(),
                      fmt::format("{} {} {} {} {} {} {}", o.gaussians, unit, o.widths.lo, o.widths.hi, o.amplitudes.lo,
                                  o.amplitudes.hi, int(o.method)),
                      fmt::format("{} {} {} {} {} {} {}", o.rounds, o.iterations, o.tolerance, int(o.teleport),
                                  o.polish, o.later_rounds, o.later_tolerance),
                      fmt::format("{} {} {} {} {}", o.deleted, o.inserted, o.allowed, o.resent, s.threshold)});
}

json as_json(const FittedFrame& f, const Frame& of) {
  return {{"file", of.file},
          {"content", of.content},
          {"name", f.name},
          {"gaussians", f.gaussians},
          {"squared_ratio", f.errors.squared_ratio},
          {"relative_l2", f.errors.relative_l2},
          {"rms", f.errors.rms},
          {"rms_filled", f.errors.rms_filled},
          {"max", f.errors.max},
          {"max_filled", f.errors.max_filled},
          {"residual_bytes", f.residual_bytes},
          {"evaluations", f.evaluations},
          {"iterations", f.iterations},
          {"teleported", f.teleported},
          {"deleted", f.deleted},
          {"inserted", f.inserted},
          {"seconds", f.seconds}};
}

FittedFrame frame_from(const json& j) {
  FittedFrame f;
  f.name = j.at("name");
  f.gaussians = j.at("gaussians");
  f.errors = {j.at("squared_ratio"), j.at("relative_l2"), j.at("rms"),
              j.at("rms_filled"),    j.at("max"),         j.at("max_filled")};
  f.residual_bytes = j.at("residual_bytes");
  f.evaluations = j.at("evaluations");
  f.iterations = j.at("iterations");
  f.teleported = j.at("teleported");
  f.deleted = j.at("deleted");
  f.inserted = j.at("inserted");
  f.seconds = j.at("seconds");
  return f;
}

// The checksum of a record: it covers everything but itself.
std::string checksum_of(json record) {
  record.erase("checksum");
  return content_key(record.dump());
}

// The folder with what is done in it.
class Folder {
 public:
  Folder(const FitSequence& s, const Survey& all) : s_(s), all_(all), key_(key_of(s, all.unit)) {
    std::error_code code;
    fs::create_directories(s.folder, code);
    if (code) throw Error(fmt::format("{}: {}", s.folder.string(), code.message()));
    record_ = {{"airlight", version()},   {"commit", commit()}, {"key", key_},  {"unit", all.unit},
               {"frames", json::array()}, {"first_ratio", 0.0}, {"next_id", 0}, {"last_filled", -1}};
  }

  // The frames that are there; into `previous`, the last of them that is not empty.
  std::vector<FittedFrame> resume(GaussianFit& previous) {
    if (!fs::exists(at("record.json"))) return {};
    if (!s_.begin_anew) return frames_there(previous);
    try {
      return frames_there(previous);
    } catch (const Error&) {
      previous = {};
      fs::remove(at("record.json"));
      return {};
    }
  }

  void keep(const Frame& of, const VoxelGrid& grid, const GaussianFit& fit, FittedFrame& frame) {
    const std::string csv = at(frame.name + ".csv"), residual = at(frame.name + ".residual");
    scene::write_gaussians_csv(csv, fit);
    scene::write_residual(residual, scene::residual_of(grid, fit.sum, {s_.threshold, {}, true}));
    frame.residual_bytes = fs::file_size(residual);
    json entry = as_json(frame, of);
    entry["csv"] = content_key(scene::read_whole_file(csv, most_bytes));
    entry["residual"] = content_key(scene::read_whole_file(residual, most_bytes));
    if (!fit.sum.gaussians.empty()) {
      record_["last_filled"] = record_["frames"].size();
      record_["first_ratio"] = fit.first_ratio;
      record_["next_id"] = fit.next_id;
    }
    record_["frames"].push_back(std::move(entry));
    record_["checksum"] = checksum_of(record_);
    scene::write_file_atomically(at("record.json"), record_.dump(1) + "\n");
  }

 private:
  std::vector<FittedFrame> frames_there(GaussianFit& previous) {
    std::vector<FittedFrame> frames;
    const std::string path = at("record.json");
    const json there = read_json(path);
    try {
      if (there.at("key") != key_)
        throw Error(fmt::format(
            "{}: holds a fit with other options or by another program, expected an empty folder or another one",
            s_.folder.string()));
      if (there.at("checksum") != checksum_of(there))
        throw Error(fmt::format("{}: is not what was written there; expected an empty folder or all files", path));
      const json& done = there.at("frames");
      for (std::size_t i = 0; i < done.size(); ++i) {
        if (i >= all_.frames.size() || done[i].at("content") != all_.frames[i].content)
          throw Error(fmt::format(
              "{}: frame {} is of other smoke than {}, expected the same files in the same order, or more of them",
              path, i, i < all_.frames.size() ? all_.frames[i].file : "any that are named"));
        const std::string name = done[i].at("name");
        for (const char* kind : {"csv", "residual"}) {
          const std::string file = at(name + "." + kind);
          const std::string wanted = done[i].at(kind);
          if (!fs::exists(file) || content_key(scene::read_whole_file(file, most_bytes)) != wanted)
            throw Error(fmt::format(
                "{}: is gone or changed since it was written, expected an empty folder or all files", file));
        }
        frames.push_back(frame_from(done[i]));
      }
      const int last = there.at("last_filled");
      if (last >= 0) {
        previous.sum.gaussians =
            scene::load::read_gaussians_csv(at(frames.at(std::size_t(last)).name + ".csv"), &previous.ids);
        previous.sum.cutoff = scene::fit_cutoff;
      }
      previous.first_ratio = there.at("first_ratio");
      previous.next_id = there.at("next_id");
    } catch (const json::exception& error) {
      throw Error(fmt::format("{}: is no record of a fit, expected an empty folder or another one", path));
    }
    record_ = there;
    return frames;
  }
  std::string at(const std::string& name) const { return (s_.folder / name).string(); }
  const FitSequence& s_;
  const Survey& all_;
  std::string key_;
  json record_;
};

}  // namespace

FitReport fit_sequence(const FitSequence& s, const scene::Execution& execution,
                       const std::function<void(const FittedFrame&)>& done) {
  scene::FitOptions options = s.options;
  scene::check_fit_options(options);
  const Survey all = survey(s);
  options.unit = all.unit;
  options.threads = execution.threads;
  Folder folder(s, all);
  std::optional<FolderLock> lock;
  if (!s.locked) lock.emplace(s.folder);
  GaussianFit previous;
  FitReport report;
  report.unit = all.unit;
  report.frames = folder.resume(previous);
  report.resumed = int(report.frames.size());
  const double left = double(all.frames.size() - report.frames.size());
  for (std::size_t i = report.frames.size(); i < all.frames.size(); ++i) {
    const double before = (double(i) - report.resumed) / std::max(left, 1.0);
    options.check = [&] {
      if (execution.progress && !execution.progress(before))
        throw scene::Interrupted(fmt::format("interrupted; the same command goes on after {} frames", i));
    };
    options.check();
    const Frame& frame = all.frames[i];
    const VoxelGrid grid = read_frame(s, frame.file);
    const GaussianFit fit = scene::next_fit(grid, previous, options);
    FittedFrame fitted{frame.name,      fit.sum.gaussians.size(),
                       fit.errors,      0,
                       fit.evaluations, fit.iterations,
                       fit.teleported,  fit.deleted,
                       fit.inserted,    fit.seconds};
    folder.keep(frame, grid, fit, fitted);
    if (!fit.sum.gaussians.empty()) previous = fit;
    report.frames.push_back(fitted);
    if (done) done(fitted);
  }
  return report;
}

}  // namespace airlight::experiments
