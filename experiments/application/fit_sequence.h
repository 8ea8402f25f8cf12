// Smoke as Gaussians, frame by frame, in a folder that can be gone on with after any end.
//
//   NAME.csv       the Gaussians of a frame, NAME that of its file: a [[medium]] of type "gaussians" with cutoff = 3 reads it
//   NAME.residual  what they leave, in 8 bits: with NAME.csv a [[medium]] of type "fitted"
//   record.json    options, errors and times of every frame that is done, and their contents
//
// Each file is written whole or not at all, the record last: whatever happens in between, the same frames follow, bit for bit.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scene/convert/gaussian_fit.h"
#include "scene/renderer.h"

namespace airlight::experiments {

struct FitSequence {
  std::vector<std::string> files;  // OpenVDB files in the order of time; or scenes, of which a medium that is a grid
  std::string grid = "density";    // of an OpenVDB file
  std::string medium = "0";        // of a scene: its name or number
  scene::FitOptions options;       // unit 0: the cube root of the volume of the box that all frames fill together
  int threshold = 0;               // of the residual: levels of this size or less are dropped
  std::filesystem::path folder;
  bool begin_anew = false;  // where the folder holds another fit; else that is an error
  bool locked = false;      // the caller holds the folder's FolderLock
};

struct FittedFrame {
  std::string name;  // of its files, without extension
  std::size_t gaussians = 0;
  scene::FitErrors errors;
  std::size_t residual_bytes = 0;
  std::size_t evaluations = 0;
  int iterations = 0, teleported = 0, deleted = 0, inserted = 0;
  double seconds = 0;  // of the fit
};

struct FitReport {
  std::vector<FittedFrame> frames;
  int resumed = 0;  // of them were there
  double unit = 0;  // [m]
};

// Every file is read and checked before anything is computed. `done(frame)` after each frame that this run made. Throws Error, one line:
// what cannot be read, a folder that holds another fit or that another process
// writes into, a file of it that was changed; Interrupted where it was asked to stop.
FitReport fit_sequence(const FitSequence&, const scene::Execution&,
                       const std::function<void(const FittedFrame&)>& done = {});

}  // namespace airlight::experiments
