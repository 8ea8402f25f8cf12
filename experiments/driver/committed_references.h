// References that are committed as films, experiments/data/references/KEY.exr, because they take long. An experiment asks
// for them with `committed_references = true` in a profile (experiments/README.md).
//
// The key is the content of scene, film size, renderer, settings and layer. Unlike the cache (reference_cache.h) it
// leaves out the program's sources, compiler and device: another build reads the same film. A test watches for changes
// of the program that would change a film: it renders a few samples of each film anew and compares.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"
#include "scene/renderer.h"

namespace airlight::experiments {

inline constexpr const char* committed_folder = "experiments/data/references";  // below the project's root
inline constexpr std::size_t most_committed_bytes = 12'000'000;                 // all films together

// A reference that experiments ask for, whether its film is there or not.
struct CommittedReference {
  std::string asked_by;  // "group/name, scene S" of the first experiment that asks for it
  std::shared_ptr<const scene::Scene> scene;
  const scene::Renderer* renderer = nullptr;
  scene::Settings settings;
  std::string layer;
  std::filesystem::path file;
};

std::filesystem::path committed_file(const std::filesystem::path& folder, const scene::Scene&, const scene::Renderer&,
                                     const scene::Settings&, const std::string& layer);

// The references that these experiments ask for, each once. Loads the experiments' scenes.
std::vector<CommittedReference> committed_references(const std::vector<Experiment>&);

bool is_committed(const std::filesystem::path& file);

// The checksum beside the film, which stands for its content. Throws Error if there is none.
std::string committed_checksum(const std::filesystem::path& file);

// Throws Error if the film is damaged: it is not computed in its place, since it belongs to the project, would take long,
// and can be had again (the message says how).
scene::Film read_committed(const std::filesystem::path& file);

// Computes the film anew, without any cache, and puts it and its checksum into place when it is whole. Returns its
// seconds. Throws Interrupted if stopped.
double make_committed(const CommittedReference&, const scene::Execution&);

}  // namespace airlight::experiments
