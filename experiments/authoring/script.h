// A script of authoring operations, one JSON object a line; methods/fogshop/README.md lists them with their keys.
//
// Deterministic: the same script, base scene and files give the same list, on any machine and number of threads.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "methods/fogshop/authoring/gaussian_list.h"
#include "methods/fogshop/authoring/screen.h"
#include "scene/scene.h"

namespace airlight::experiments::authoring {

// Result of a script.
struct Authored {
  fogshop::authoring::GaussianList list;
  std::string base;                              // path of the base scene; empty if there is none
  std::optional<scene::Scene> scene;             // the base scene, read
  std::optional<fogshop::authoring::View> view;  // of the script; else the base scene's camera is meant
  struct Done {
    int line;
    std::string operation;
    std::vector<fogshop::authoring::Id> touched;
  };
  std::vector<Done> done;
};

// Runs the script, every `emit` at `later` [s] after its time. `check` is called often and may throw to stop. Throws Error:
// "SCRIPT:LINE: what was found, what was expected".
Authored run_script(const std::string& path, const std::function<void()>& check, double later = 0);

}  // namespace airlight::experiments::authoring
