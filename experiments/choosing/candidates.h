// Candidates to render a scene: the rows of an experiment, for any of its scenes.
#pragma once
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"
#include "scene/renderer.h"

namespace airlight::experiments {

struct Candidate {
  std::string name;  // of the row, with the value of its sweep: "froxels, fitted (tile 4)"
  const scene::Renderer* renderer = nullptr;
  Pairs given;               // settings that are not as by default
  scene::Settings settings;  // all
  std::optional<scene::MediumConversion> convert;
};

// The rows of an experiment with pictures, each renderer with the same settings and conversion once. Rows that show another layer than the
// picture are left out. Throws Error where the experiment has no pictures.
std::vector<Candidate> candidates_of(const Experiment&);

// The line that renders the scene so: "airlight render SCENE -m NAME --set ... -o picture.exr". Threads: 0 for all.
std::string command_line(const Candidate&, const std::string& scene_file, const Pairs& overrides, int threads = 0);

}  // namespace airlight::experiments
