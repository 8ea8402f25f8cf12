// Every method that computes on a device, against its twin on the CPU: small scenes, equal settings. `airlight doctor --check`.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "scene/renderer.h"

namespace airlight::experiments {

enum class Computes { pictures, flows };

// What was found for a variant of a method.
struct Parity {
  std::string method;  // on the device: "fogshop_gpu"
  Computes computes = Computes::pictures;
  std::string settings;  // of both: "K = 24, variant = S"
  std::string measured;  // what `error` is of: "airlight (99 % of the values)"
  // The figure that is nearest to its tolerance, or furthest above it; relative.
  double error = 0, tolerance = 0;
  std::string failure;      // there is no figure, since the device or its driver failed with this line
  std::string unavailable;  // nor here, since the method needs more than the device has
  double seconds = 0;

  bool failed() const { return !failure.empty() || !(error <= tolerance); }
};

// "airlight (99 % of the values) differs by 3e-2 from the CPU, tolerance 2.4e-5", or why there is no figure.
std::string finding(const Parity&);

// Compares all variants on the device in use, and calls `done` after each. Throws NoDevice, scene::Interrupted.
std::vector<Parity> check_parity(const scene::Execution&, const std::function<void(const Parity&)>& done);

}  // namespace airlight::experiments
