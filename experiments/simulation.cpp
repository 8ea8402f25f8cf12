#include "experiments/simulation.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>

#include "experiments/build_info.h"
#include "experiments/frames.h"
#include "scene/atomic_file.h"
#include "scene/content_key.h"
#include "scene/error.h"
#include "scene/read_file.h"

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

// The first two lines of `state`: of what it is, and after which frame.
std::string key_of(const Simulation& s) {
  return content_key({s.problem->hash, s.solver.name(), s.settings.canonical(), source_id()});
}
std::optional<std::pair<std::string, int>> what_is_in(const fs::path& folder) {
  std::ifstream in(folder / "state", std::ios::binary);
  std::string key;
  int last = -1;
  if (std::getline(in, key) && in >> last) return std::pair(key, last);
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

  // The last frame that is complete, -1 where there is none, and into `flow` what followed it.
  int resume(scene::Flow& flow) {
    const std::string path = (s_.folder / "state").string();
    if (!fs::exists(path)) return -1;
    const std::string bytes = scene::read_whole_file(path, std::size_t(1) << 36);
    const std::size_t line = bytes.find('\n'), next = bytes.find('\n', line + 1);
    if (line == std::string::npos || next == std::string::npos || bytes.substr(0, line) != key_)
      throw Error(
          fmt::format("{}: of another problem, solver, settings or program, expected an empty folder or another one",
                      s_.folder.string()));
    const int last = std::stoi(bytes.substr(line + 1, next - line - 1));
    for (int frame = 0; frame <= last; ++frame)
      if (!fs::exists(frame_name(frame)))
        throw Error(fmt::format("{}: is gone, and the simulation is beyond it; expected an empty folder or all frames",
                                frame_name(frame)));
    history_ = rows_up_to(last);
    flow.restore(bytes.substr(next + 1));
    return last;
  }

  void keep(int frame, const scene::Flow& flow, double dt) {
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
    state.insert(0, fmt::format("{}\n{}\n", key_, frame));
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

}  // namespace

int frames_there(const Simulation& s) {
  const auto found = what_is_in(s.folder);
  if (!found || found->first != key_of(s)) return 0;
  const Folder folder(s);
  for (int frame = 0; frame <= found->second; ++frame)
    if (!fs::exists(folder.frame_name(frame))) return 0;
  return found->second + 1;
}

SimulationReport simulate(const Simulation& s, const scene::Execution& execution) {
  const FrameSteps plan = frame_steps(*s.problem, s.solver, s.settings);
  if (plan.frames == 1)
    throw Error(fmt::format("{} s of {} frames a second are less than half a frame, expected one or more",
                            s.problem->duration, s.problem->frame_rate));
  const auto flow = s.solver.start(s.problem, s.settings, execution);
  Folder folder(s);
  SimulationReport report;
  const int last = folder.resume(*flow);
  report.resumed = last + 1;
  for (int frame = last + 1; frame < plan.frames; ++frame) {
    if (frame > 0)
      to_next_frame(*flow, plan, [&](double share) {
        const double done = (frame - 1 - report.resumed + share) / (plan.frames - 1 - report.resumed + 1e-9);
        if (execution.progress && !execution.progress(std::clamp(done, 0.0, 1.0)))
          throw scene::Interrupted(fmt::format("interrupted; the same command goes on after frame {}", frame - 1));
      });
    folder.keep(frame, *flow, plan.dt);
  }
  report.frames = plan.frames;
  report.times = flow->times();
  report.counters = flow->counters();
  report.totals = flow->totals();
  return report;
}

}  // namespace airlight::experiments
