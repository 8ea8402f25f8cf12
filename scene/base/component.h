// Base of everything that a user chooses by name: renderers, solvers, probes.
#pragma once
#include <string>
#include <vector>

#include "scene/base/settings.h"

namespace airlight::scene {

class Component {
 public:
  virtual ~Component() = default;
  virtual std::string name() const = 0;   // as in --method: "fogshop", "ray_marcher", "path_tracer"
  virtual std::string about() const = 0;  // one line, with the source
  // On what it computes beside the processor, in one line; empty for the processor alone. Where it is missing, the line
  // says so.
  virtual std::string device() const { return ""; }
  virtual std::vector<SettingSpec> settings() const = 0;
};

}  // namespace airlight::scene
