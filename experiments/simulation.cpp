#include "experiments/simulation.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>

#include "experiments/build_info.h"
#include "experiments/frames.h"
#include "scene/atomic_file.h"
#include "scene/content_key.h"
#include "scene/convert/legendre_projection.h"
#include "scene/error.h"
#include "scene/flow_particles.h"
#include "scene/media/legendre_box.h"
#include "scene/read_file.h"
#include "scene/stopwatch.h"

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

// The first two lines of `state`: of what it is; after which frame, and how many files of coefficients each has.
std::string key_of(const Simulation& s) {
  return content_key({s.problem->hash, s.solver.name(), s.settings.canonical(), source_id()});
}
struct Kept {
  std::string key;
  int last = -1, coefficients = 0;
};
std::optional<Kept> what_is_in(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_regular_file(folder / "state", ignored)) return std::nullopt;
  std::ifstream in(folder / "state", std::ios::binary);
  Kept kept;
  if (std::getline(in, kept.key) && in >> kept.last >> kept.coefficients) return kept;
  return std::nullopt;
}

class Folder {
 public:
  explicit Folder(const Simulation& s) : s_(s), key_(key_of(s)) {
    std::error_code code;
    fs::create_directories(s.folder, code);
    if (code) throw Error(fmt::format("{}: {}", s.folder.string(), code.message()));
  }

  std::string frame_name(int frame) const {
    return (s_.folder / fmt::format("{}.{:04d}.vdb", s_.problem->name, frame)).string();
  }
  std::string coefficients_name(int density, int frame) const {
    const std::string of = density == 0 ? "" : "." + scene::density_name(*s_.problem, density);
    return (s_.folder / fmt::format("{}{}.{:04d}.csv", s_.problem->name, of, frame)).string();
  }
  std::string particles_name(int frame) const {
    return (s_.folder / fmt::format("{}.particles.{:04d}.csv", s_.problem->name, frame)).string();
  }
  // The first file that is gone, of the frames up to the last; nothing where all are there.
  std::string missing(const Kept& kept) const {
    for (int frame = 0; frame <= kept.last; ++frame) {
      std::vector<std::string> files{frame_name(frame)};
      for (int density = 0; density < kept.coefficients; ++density) files.push_back(coefficients_name(density, frame));
      if (!s_.problem->particles.empty()) files.push_back(particles_name(frame));
      for (const std::string& file : files)
        if (!fs::exists(file)) return file;
    }
    return "";
  }

  // The last frame that is complete, -1 where there is none, and into `flow` and its particles what followed it.
  int resume(scene::Flow& flow, scene::FlowParticles& particles) {
    const std::string path = (s_.folder / "state").string();
    if (!fs::exists(path)) return -1;
    const std::string bytes = scene::read_whole_file(path, std::size_t(1) << 36);
    const std::size_t line = bytes.find('\n'), next = bytes.find('\n', line + 1);
    if (line == std::string::npos || next == std::string::npos || bytes.substr(0, line) != key_)
      throw Error(
          fmt::format("{}: of another problem, solver, settings or program, expected an empty folder or another one",
                      s_.folder.string()));
    const Kept kept = what_is_in(s_.folder).value();
    const int last = kept.last;
    if (const std::string gone = missing(kept); !gone.empty())
      throw Error(
          fmt::format("{}: is gone, and the simulation is beyond it; expected an empty folder or all frames", gone));
    history_ = rows_up_to(last);
    const std::size_t of_particles = particles.state().size();
    if (bytes.size() - (next + 1) < of_particles) throw Error(path + ": shorter than expected");
    particles.restore(bytes.substr(next + 1, of_particles));
    flow.restore(bytes.substr(next + 1 + of_particles));
    return last;
  }

  void keep(int frame, const scene::Flow& flow, const scene::FlowParticles& particles, double dt) {
    int coefficients = 0;
    for (int density = 0; density <= int(s_.problem->densities.size()); ++density) {
      const scene::DensityField medium = flow.medium(density);
      const auto* box = std::get_if<scene::LegendrePointer>(&medium);
      if (!box) break;
      scene::write_legendre_csv(coefficients_name(density, frame), **box);
      ++coefficients;
    }
    if (!particles.empty()) scene::write_file_atomically(particles_name(frame), particles.csv());
    scene::write_frame(frame_name(frame), flow.frame(),
                       {{"frame", std::to_string(frame)},
                        {"time", fmt::format("{}", flow.time())},
                        {"dt", fmt::format("{}", dt)},
                        {"problem", s_.problem->name + " " + s_.problem->hash},
                        {"solver", s_.solver.name() + " " + s_.settings.canonical()},
                        {"commit", commit()}});
    history_ += history_row(frame, flow.time(), flow.totals());
    scene::write_file_atomically((s_.folder / "history.csv").string(), history_header() + history_);
    std::string state = flow.state();  // as long as the flow itself
    state.insert(0, fmt::format("{}\n{} {}\n{}", key_, frame, coefficients, particles.state()));
    scene::write_file_atomically((s_.folder / "state").string(), state);
  }

 private:
  // A run that ended between two files may have left a row too many.
  std::string rows_up_to(int last) const {
    const std::string path = (s_.folder / "history.csv").string();
    const std::string text = scene::read_whole_file(path, std::size_t(1) << 30);
    std::size_t end = text.find('\n') + 1;
    const std::size_t begin = end;
    for (int frame = 0; frame <= last; ++frame) {
      if (text.compare(end, std::to_string(frame).size() + 1, std::to_string(frame) + ",") != 0 || end == 0)
        throw Error(fmt::format("{}: has no row of frame {}", path, frame));
      end = text.find('\n', end) + 1;
    }
    return text.substr(begin, end - begin);
  }

  const Simulation& s_;
  std::string key_, history_;
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

int frames_there(const Simulation& s) {
  const auto found = what_is_in(s.folder);
  if (!found || found->key != key_of(s) || !Folder(s).missing(*found).empty()) return 0;
  return found->last + 1;
}

SimulationReport simulate(const Simulation& s, const scene::Execution& execution) {
  const FrameSteps plan = frame_steps(*s.problem, s.solver, s.settings);
  if (plan.frames == 1)
    throw Error(fmt::format("{} s of {} frames a second are less than half a frame, expected one or more",
                            s.problem->duration, s.problem->frame_rate));
  const auto flow = s.solver.start(s.problem, s.settings, execution);
  Carried carried(s, *flow, execution);
  Folder folder(s);
  SimulationReport report;
  const int last = folder.resume(*flow, carried.particles);
  report.resumed = last + 1;
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
