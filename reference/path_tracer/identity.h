// Data that must be equal for two sets of samples to belong to one picture.
#pragma once
#include <cstdint>
#include <string>

#include "reference/path_tracer/options.h"
#include "scene/renderer.h"

namespace airlight::path_tracer {

struct Identity {
  std::string scene;     // hash of the scene's content
  std::string view;      // hash of camera and film size
  std::string settings;  // every setting that changes a sample: not `samples`, `target_error`, seed and stream
  std::uint32_t seed = 0;
  std::uint32_t stream = 0;
  std::string build;  // sources of scene/ and reference/, compiler and build type: bits are promised for one build

  bool operator==(const Identity&) const = default;
};

Identity identity_of(const scene::Scene&, const scene::View&, const Options&);
std::string build_id();

// Empty if equal; else one line that names what differs and both values.
std::string difference(const Identity&, const Identity&);

}  // namespace airlight::path_tracer
