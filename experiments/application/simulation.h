// A flow as a sequence of files, in a folder that can be gone on with after any end.
//
//   NAME.0000.vdb, NAME.0001.vdb, ...   the frames, from the start on
//   NAME.0000.csv, ...                  the density as coefficients, where its medium is a Legendre box; NAME.OTHER.0000.csv further ones
//   NAME.particles.0000.csv, ...        where its particles are, if it carries any: the files of scenes' [[particles]]
//   history.csv                         a row for each: sums over the box
//   state                               what goes on after the last of them, whose files are complete, and checksums of all files
//
// Each file is written whole or not at all, `state` last: whatever happens in between, the same frames follow, bit for
// bit. A file that is not what was written is refused.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>

#include "scene/flow/flow.h"

namespace airlight::experiments {

struct Simulation {
  std::shared_ptr<const scene::FlowProblem> problem;
  const scene::Solver& solver;
  scene::Settings settings;
  std::filesystem::path folder;
  std::function<void(int frame, const scene::Flow&)> look = {};  // at each frame of this run, once its files are there
  std::function<void(int frame, const scene::DensityField&)> look_back = {};  // at each frame of an earlier run
  bool locked = false;  // the caller holds the folder's FolderLock
};

struct SimulationReport {
  int frames = 0;                       // there are now, the start included
  int resumed = 0;                      // of them there were
  std::vector<scene::StageTime> times;  // of this run
  std::map<std::string, double> counters;
  scene::Totals totals;  // at the end
};

// How many frames are in the folder, the start included, after which it can go on; 0 where it is empty, where what is there is of another
// problem, solver, settings or program, and where a file is gone or changed, which `damage` says in a line.
struct FramesThere {
  int frames = 0;
  std::string damage;
};
FramesThere frames_there(const Simulation&);

// frames = duration * frame_rate, rounded, and the start. Throws Error: a folder that holds another simulation or that another process
// writes into, a file that is gone or changed, whatever a step throws; Interrupted after the frame during which it was asked to stop.
SimulationReport simulate(const Simulation&, const scene::Execution&);

}  // namespace airlight::experiments
