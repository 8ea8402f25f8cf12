#include "experiments/application/simulation.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <sstream>

#include "experiments/application/build_info.h"
#include "experiments/application/folder_lock.h"
#include "experiments/application/frames.h"
#include "scene/base/atomic_file.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"
#include "scene/base/stopwatch.h"
#include "scene/convert/legendre_projection.h"
#include "scene/flow/flow_particles.h"
#include "scene/load/parts.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::experiments {
namespace {

namespace fs = std::filesystem;

std::string history_header() {
  std::string line = "frame";
  for (const auto& [name, value] : history_of(0, {})) line += "," + name;
  return line + "\n";
}

std::string history_row(int frame, double time, const scene::Totals& totals) {
  std::string line = std::to_string(frame);
  for (const auto& [name, value] : history_of(time, totals)) line += fmt::format(",{}", value);
  return line + "\n";
}

std::string key_of(const Simulation& s) {
  return content_key({s.problem->hash, s.solver.name(), s.settings.canonical(), source_id()});
}

constexpr std::size_t most_bytes_of_simulation = std::size_t(1) << 36;
std::string checksum_of(const std::string& file) {
  return content_key(scene::read_whole_file(file, most_bytes_of_simulation));
}

// Head of `state`: key, last frame, and files of coefficients of each frame; then a checksum and a name for each
// complete file. Particles and flow follow, then a checksum of everything.
struct Kept {
  std::string key, bytes, files;  // files: those lines
  int last = -1, coefficients = 0;
  std::size_t end = 0;  // of the beginning
};
Kept read_state(const std::string& path) {
  Kept kept;
  kept.bytes = scene::read_whole_file(path, most_bytes_of_simulation);
  kept.key = kept.bytes.substr(0, kept.bytes.find('\n'));
  const std::size_t sum = content_key(std::string_view()).size();
  const std::string_view all = kept.bytes;
  if (all.size() < sum || content_key(all.substr(0, all.size() - sum)) != all.substr(all.size() - sum))
    throw Error(fmt::format("{}: damaged: its checksum does not match; expected an empty folder or all files", path));
  const std::size_t files = kept.bytes.find('\n', kept.key.size() + 1) + 1, end = kept.bytes.find("\n\n", files - 1);
  std::istringstream in(kept.bytes.substr(0, files));
  if (!(in >> kept.key >> kept.last >> kept.coefficients) || kept.last < 0 || files == 0 || end == std::string::npos)
    throw Error(fmt::format("{}: is no state of a simulation; expected an empty folder or another one", path));
  kept.files = kept.bytes.substr(files, end + 1 - files);
  kept.end = end + 2;
  kept.bytes.resize(kept.bytes.size() - sum);
  return kept;
}

class OfAnother : public Error {
 public:
  using Error::Error;
};

class SimulationFolder {
 public:
  explicit SimulationFolder(const Simulation& s) : s_(s), key_(key_of(s)) {
    std::error_code code;
    fs::create_directories(s.folder, code);
    if (code) throw Error(fmt::format("{}: {}", s.folder.string(), code.message()));
  }

  std::string at(const std::string& name) const { return (s_.folder / name).string(); }
  std::string frame_name(int frame) const { return fmt::format("{}.{:04d}.vdb", s_.problem->name, frame); }
  std::string coefficients_name(int density, int frame) const {
    const std::string of = density == 0 ? "" : "." + scene::density_name(*s_.problem, density);
    return fmt::format("{}{}.{:04d}.csv", s_.problem->name, of, frame);
  }
  std::string particles_name(int frame) const {
    return fmt::format("{}.particles.{:04d}.csv", s_.problem->name, frame);
  }
  std::vector<std::string> names(int frame, int coefficients) const {
    std::vector<std::string> all{frame_name(frame)};
    for (int density = 0; density < coefficients; ++density) all.push_back(coefficients_name(density, frame));
    if (!s_.problem->particles.empty()) all.push_back(particles_name(frame));
    return all;
  }

  // The content of `state`, if all files are as they were written; nothing if there is no state. Throws Error.
  std::optional<Kept> verified() {
    if (!fs::exists(at("state"))) return std::nullopt;
    Kept kept = read_state(at("state"));
    if (kept.key != key_)
      throw OfAnother(
          fmt::format("{}: of another problem, solver, settings or program, expected an empty folder or another one",
                      s_.folder.string()));
    std::istringstream lines(kept.files);
    const auto check = [&](const std::string& name, const std::string& sum) {
      std::string line;
      if (!std::getline(lines, line) || line != sum + " " + name)
        throw Error(fmt::format("{}: is not what was written there; expected an empty folder or all frames", at(name)));
    };
    for (int frame = 0; frame <= kept.last; ++frame)
      for (const std::string& name : names(frame, kept.coefficients)) {
        if (!fs::exists(at(name)))
          throw Error(fmt::format(
              "{}: is gone, and the simulation is beyond it; expected an empty folder or all frames", at(name)));
        check(name, checksum_of(at(name)));
      }
    history_ = rows_up_to(kept.last);
    check("history.csv", content_key(history_));
    files_ = kept.files.substr(0, kept.files.rfind('\n', kept.files.size() - 2) + 1);
    return kept;
  }

  // The last frame that is complete, -1 where there is none, and into `flow` and its particles what followed it.
  int resume(scene::Flow& flow, scene::FlowParticles& particles) {
    const std::optional<Kept> kept = verified();
    if (!kept) return -1;
    const std::size_t of_particles = particles.state().size();
    try {
      particles.restore(kept->bytes.substr(kept->end, of_particles));
      flow.restore(kept->bytes.substr(std::min(kept->end + of_particles, kept->bytes.size())));
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", at("state"), error.what()));
    }
    coefficients_ = kept->coefficients;
    return kept->last;
  }

  // The density of a frame that is there; `flow` says in which box, where it lies there as coefficients.
  scene::DensityField density(int frame, const scene::Flow& flow) const {
    if (coefficients_ == 0) return std::make_shared<const scene::VoxelGrid>(scene::read_vdb(at(frame_name(frame))));
    const auto now = std::get<scene::LegendrePointer>(flow.medium());  // the flow keeps no box: this one is made for us
    return std::make_shared<const scene::LegendreBox>(
        now->box(), now->shape(), scene::load::read_legendre_csv(at(coefficients_name(0, frame)), now->shape()));
  }

  void keep(int frame, const scene::Flow& flow, const scene::FlowParticles& particles, double dt) {
    int coefficients = 0;
    for (int density = 0; density <= int(s_.problem->densities.size()); ++density) {
      const scene::DensityField medium = flow.medium(density);
      const auto* box = std::get_if<scene::LegendrePointer>(&medium);
      if (!box) break;
      scene::write_legendre_csv(at(coefficients_name(density, frame)), **box);
      ++coefficients;
    }
    if (!particles.empty()) scene::write_file_atomically(at(particles_name(frame)), particles.csv());
    scene::write_frame(at(frame_name(frame)), flow.frame(),
                       {{"frame", std::to_string(frame)},
                        {"time", fmt::format("{}", flow.time())},
                        {"dt", fmt::format("{}", dt)},
                        {"problem", s_.problem->name + " " + s_.problem->hash},
                        {"solver", s_.solver.name() + " " + s_.settings.canonical()},
                        {"commit", commit()}});
    for (const std::string& name : names(frame, coefficients)) files_ += checksum_of(at(name)) + " " + name + "\n";
    if (history_.empty()) history_ = history_header();
    history_ += history_row(frame, flow.time(), flow.totals());
    scene::write_file_atomically(at("history.csv"), history_);
    std::string state = flow.state();  // as long as the flow itself
    state.insert(0, fmt::format("{}\n{} {}\n{}{} history.csv\n\n{}", key_, frame, coefficients, files_,
                                content_key(history_), particles.state()));
    state += content_key(state);
    scene::write_file_atomically(at("state"), state);
  }

 private:
  // A run that ended between two files may have left a row too many.
  std::string rows_up_to(int last) const {
    const std::string path = at("history.csv");
    const std::string text = scene::read_whole_file(path, std::size_t(1) << 30);
    std::size_t end = text.find('\n') + 1;
    for (int frame = 0; frame <= last; ++frame) {
      if (text.compare(end, std::to_string(frame).size() + 1, std::to_string(frame) + ",") != 0 || end == 0)
        throw Error(fmt::format("{}: has no row of frame {}", path, frame));
      end = text.find('\n', end) + 1;
    }
    return text.substr(0, end);
  }

  const Simulation& s_;
  std::string key_, files_, history_;
  int coefficients_ = 0;
};

// Particles, and unless they lie where the flow does, the flow as it was a step before, between which and now they move.
class Carried {
 public:
  Carried(const Simulation& s, const scene::Flow& flow, const scene::Execution& execution)
      : particles(*s.problem), execution_(execution) {
    rides_ = particles.ride(flow);
    if (!particles.empty() && !rides_) before_ = s.solver.start(s.problem, s.settings, execution);
  }
  void from(const scene::Flow& now) {
    if (before_) before_->restore(now.state());
  }
  void move(const scene::Flow& now, double dt) {
    if (particles.empty()) return;
    scene::Stopwatch watch;
    if (rides_)
      particles.step(dt);
    else
      particles.step(*before_, now, dt, execution_);
    seconds += watch.lap();
    from(now);
  }

  scene::FlowParticles particles;
  double seconds = 0;

 private:
  const scene::Execution& execution_;
  bool rides_ = false;
  std::unique_ptr<scene::Flow> before_;
};

}  // namespace

FramesThere frames_there(const Simulation& s) {
  try {
    const auto kept = SimulationFolder(s).verified();
    return {kept ? kept->last + 1 : 0, ""};
  } catch (const OfAnother&) {
    return {};
  } catch (const Error& error) {
    return {0, error.what()};
  }
}

SimulationReport simulate(const Simulation& s, const scene::Execution& execution) {
  const FrameSteps plan = frame_steps(*s.problem, s.solver, s.settings);
  if (plan.frames == 1)
    throw Error(fmt::format("{} s of {} frames a second are less than half a frame, expected one or more",
                            s.problem->duration, s.problem->frame_rate));
  const auto flow = s.solver.start(s.problem, s.settings, execution);
  Carried carried(s, *flow, execution);
  SimulationFolder folder(s);
  std::optional<FolderLock> lock;
  if (!s.locked) lock.emplace(s.folder);
  SimulationReport report;
  const int last = folder.resume(*flow, carried.particles);
  report.resumed = last + 1;
  for (int frame = 0; s.look_back && frame <= last; ++frame) {
    s.look_back(frame, folder.density(frame, *flow));
    if (execution.progress && !execution.progress(0)) throw scene::Interrupted("interrupted");
  }
  for (int frame = last + 1; frame < plan.frames; ++frame) {
    carried.from(*flow);
    if (frame > 0)
      to_next_frame(*flow, plan, [&](double share) {
        carried.move(*flow, plan.dt);
        const double done = (frame - 1 - report.resumed + share) / (plan.frames - 1 - report.resumed + 1e-9);
        if (execution.progress && !execution.progress(std::clamp(done, 0.0, 1.0)))
          throw scene::Interrupted(fmt::format("interrupted; the same command goes on after frame {}", frame - 1));
      });
    folder.keep(frame, *flow, carried.particles, plan.dt);
    if (s.look) s.look(frame, *flow);
  }
  report.frames = plan.frames;
  report.times = flow->times();
  if (!carried.particles.empty()) report.times.push_back({"particles", carried.seconds});
  report.counters = flow->counters();
  report.totals = flow->totals();
  return report;
}

}  // namespace airlight::experiments
