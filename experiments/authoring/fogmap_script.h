// A script that draws a fogmap, one JSON object a line; methods/wavelet_fog/README.md lists the operations with their keys.
//
// Deterministic: the same script and files give the same bytes, on any machine.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "methods/wavelet_fog/authoring/canvas.h"

namespace airlight::experiments::authoring {

// Is the script's first operation "fogmap"? Throws Error where it cannot be read.
bool draws_fogmap(const std::string& path);

struct DrawnFogmap {
  wavelet_fog::authoring::Canvas canvas;
  std::string medium;  // keys of the [[medium]] beside its type and file, as TOML
  std::string scene;   // the scene without the medium, as TOML
  struct Done {
    int line;
    std::string operation;
    double sum, greatest;  // of the values after it
  };
  std::vector<Done> done;
};

// Runs the script. Throws Error: "SCRIPT:LINE: what was found, what was expected".
DrawnFogmap run_fogmap_script(const std::string& path, const std::function<void()>& check);

// Writes the map beside the scene (a PNG of 16 bits where all values are at most 1, else an EXR of floats), then the scene `out`;
// each whole or not at all. Returns the map's name.
std::string write(const DrawnFogmap&, const std::string& script, const std::string& out);

}  // namespace airlight::experiments::authoring
